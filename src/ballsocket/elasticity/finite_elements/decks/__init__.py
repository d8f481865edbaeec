"""The finite-element model and its fields as files of other programs."""
