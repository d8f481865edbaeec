"""Inputs of the page, and text and units of its numbers."""
