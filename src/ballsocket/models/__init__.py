"""The closed forms, and the plane layer: what answers to `press` without a solver."""
