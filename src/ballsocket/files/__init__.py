"""Joints, loads and units at the door: text and files in, numbers out, and back."""
