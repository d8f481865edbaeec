"""Recomputation of Heß & Forsbach 2021: parameter sets, figures, tables, and checkable statements with verdicts."""
