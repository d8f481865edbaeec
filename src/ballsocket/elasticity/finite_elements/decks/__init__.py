"""Input decks of finite element programs, and files of displacements and stresses."""
