"""How fast, and against whom: `python -m benchmarks NAME` measures this package and its rivals in one run."""
