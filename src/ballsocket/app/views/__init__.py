"""The views of the explorer: one small file over one question."""
