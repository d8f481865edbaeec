"""Contact of one joint under one load."""
