"""Exact linear-elastic solution of a frictionless ball in a layered socket, mode by mode."""
