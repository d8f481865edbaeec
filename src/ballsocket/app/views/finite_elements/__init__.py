"""Check of a contact by finite elements."""
