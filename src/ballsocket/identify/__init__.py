"""From results and measurements back to the numbers of a joint."""
