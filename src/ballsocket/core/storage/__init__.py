"""Files written and read safely: atomic replacement, named arrays, fingerprints of the code."""
