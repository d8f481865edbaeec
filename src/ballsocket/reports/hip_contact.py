"""Validity and utilisation of a run's contacts, in words and in rows of a table."""

from __future__ import annotations

from collections.abc import Iterator

from ..hip.contact_checks import largest_utilisation
from ..hip.history import History

HEADS = ("cycles", "activity", "at", "F [N]", "pmax [MPa]", "σv/σy", "valid")


def contact_line(history: History) -> str:
    """Describe validity and largest utilisation of the contacts in one line."""
    model = history.use.contact_model.name
    verdict = "valid" if history.contact_valid else "NOT VALID, see the notes"
    return f"contact ({model}): {verdict}; {_utilisation_words(history)}"


def _utilisation_words(history: History) -> str:
    checks = history.use.unworn_checks
    unworn, end = largest_utilisation(checks), largest_utilisation(history.contact_checks[-1])
    if unworn is None or end is None:
        return checks[0].utilisation_note if checks else "nothing is pressed"
    return f"utilisation σv/σy {unworn:.3g} unworn, {end:.3g} after {history.last.cycles:g} cycles"


def contact_rows(history: History) -> Iterator[tuple[str, ...]]:
    """List the checked contacts, unworn and at each report: the cells below `HEADS`."""
    stages = [("unworn", history.use.unworn_checks)]
    stages += [
        (f"{report.cycles:g}", checks) for report, checks in zip(history.reports, history.contact_checks, strict=True)
    ]
    for stage, checks in stages:
        for check in checks:
            utilisation = "not known" if check.utilisation is None else f"{check.utilisation:.3g}"
            numbers = f"{check.force:.4g}", f"{check.max_pressure:.4g}", utilisation
            yield stage, check.activity, check.instant, *numbers, "yes" if check.valid else "no"
