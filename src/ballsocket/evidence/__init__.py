"""What there is to show that a number may be trusted."""
