"""The exact linear-elastic answer, mode by mode, for a frictionless ball in a layered socket."""
