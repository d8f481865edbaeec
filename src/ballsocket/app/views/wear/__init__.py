"""Wear of a design over millions of cycles."""
