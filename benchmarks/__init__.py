"""Speed beside rivals: `python -m benchmarks` lists the benchmarks, `RESULTS.md` has the results."""
