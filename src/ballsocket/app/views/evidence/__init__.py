"""Evidence pack for a question."""
