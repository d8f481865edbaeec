"""Evidence for computed numbers: verification, comparison with publications, uncertainty, and credibility."""
