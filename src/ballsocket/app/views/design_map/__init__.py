"""Map of one quantity over two numbers of a joint."""
