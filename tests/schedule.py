"""Distribution of the tests on several workers: a file goes to one worker, and those that take longest start first."""

from xdist.scheduler import LoadScopeScheduling

_GROUPS = {
    "browser": tuple(
        f"tests/app/test_{name}.py"
        for name in (
            *("accessibility", "agreement", "app", "app_views", "connection"),
            *("history", "hostile", "slow_lines", "views"),
        )
    ),
    "evidence": ("tests/evidence/",),
    "sources": tuple(f"tests/test_{name}.py" for name in ("doors", "imports", "patterns", "words")),
}
"""Files that share a server and a browser, a computed pack or parsed sources: one worker takes all of them."""

_FIRST = (
    *_GROUPS["browser"],
    "tests/hip/test_wear.py",
    "tests/evidence/",
    "tests/test_docs.py",
    "tests/elasticity/",
    "tests/lubrication/",
    "tests/hip/",
    "tests/app/",
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
        """Return the group of a test, or its file."""
        path = nodeid.partition("::")[0]
        return next((name for name, paths in _GROUPS.items() if path.startswith(paths)), path)
