"""Load in a real cup with its orientation."""
