"""Foundations of all rooms: arrays, checks, quantities, sources, validity, plots, storage and executors."""
