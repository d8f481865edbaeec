"""The commands as tools for AI assistants (Model Context Protocol): each call runs in a process with limits."""
