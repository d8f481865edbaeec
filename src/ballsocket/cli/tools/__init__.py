"""The command's words for other programs: each a tool with a schema, run in a process of its own, with limits."""
