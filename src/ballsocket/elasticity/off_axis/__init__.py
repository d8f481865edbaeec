"""Contact of a ball at any position in a socket, on a grid of rings and meridians about the socket's axis."""
