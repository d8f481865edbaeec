"""The command with a limit on its memory, for calls of tools: `python -m ballsocket.cli.limited`."""

from __future__ import annotations

from ..app.running import limit_memory
from ..core.executors.processes import exit_with_parent
from .root import main

if __name__ == "__main__":
    exit_with_parent()
    limit_memory()
    main()
