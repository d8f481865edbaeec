"""Exact solution interpolated from small tables."""
