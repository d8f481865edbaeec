"""Distribution of the tests on several workers: a file goes to one worker, and those that take longest start first."""

from xdist.scheduler import LoadScopeScheduling

_FIRST = (
    "tests/evidence/",
    "tests/app/",
    "tests/hip/",
    "tests/elasticity/",
    "tests/lubrication/",
    "tests/test_docs.py",
    "tests/test_contributed.py",
    "tests/compiled/",
    "tests/cli/",
    "tests/studies/",
    "tests/fuzz/",
    "tests/export/",
)
"""Beginnings of the paths that take longest; they start first, so that no worker waits at the end for a long file."""


def start_rank(nodeid):
    """Return the position of a test in the order of the run; tests of equal position keep their order."""
    return next((rank for rank, path in enumerate(_FIRST) if nodeid.startswith(path)), len(_FIRST))


class FileScheduling(LoadScopeScheduling):
    """Scheduling by files: what the tests of a file share is computed once, not once for each worker."""

    def _split_scope(self, nodeid):
        """Return the file of a test; the files of evidence share a computed pack."""
        path = nodeid.partition("::")[0]
        return "evidence" if path.startswith("tests/evidence/") else path
