"""The exact answer from small tables."""
