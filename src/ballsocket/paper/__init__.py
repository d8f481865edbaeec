"""Heß & Forsbach 2021 recomputed: its parameter sets and its checkable sentences, each with a verdict."""
