"""What a press ends with: numbers, how they went, where they can be trusted, and how they are told.

`contact` itself; `outcome`, status, validity and notes; `strength`, how near the materials are to what they bear;
`describe`, a contact in words and numbers.
"""

from .contact import Contact, Laws, Pressed

__all__ = ["Contact", "Laws", "Pressed"]
