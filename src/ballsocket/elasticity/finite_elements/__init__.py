"""Contact by finite elements: reference for rims, arcs of cover, sliding liners and compliant shells."""
