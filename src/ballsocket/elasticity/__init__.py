"""Linear-elastic solutions: closed sphere, tables of it, finite elements, and the tilted cup."""
