"""The explorer: a joint in a browser. Sliders lead to the same calls and figures as the command line."""
