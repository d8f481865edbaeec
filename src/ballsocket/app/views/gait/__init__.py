"""Gait cycle of a hip."""
