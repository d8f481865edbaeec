"""Contact models in closed form, and the numerical plane layer."""
