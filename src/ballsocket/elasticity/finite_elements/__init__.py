"""Finite elements: the judge for rims, arcs of cover, liners that slide and shells that give way."""
