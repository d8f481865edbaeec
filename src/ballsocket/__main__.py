"""Entry point of `python -m ballsocket`."""

from .cli import main

if __name__ == "__main__":
    main()
