"""State of the screen as plain data, to and from a link."""
