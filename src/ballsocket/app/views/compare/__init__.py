"""Joints side by side."""
