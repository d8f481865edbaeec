"""Inputs that change one part of the screen: an entry builds the field and reads its edit."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

from ...core.checks import shown
from ...core.kinds import Kind, Unit
from ...hip.cycle_registry import CYCLES
from ..state.screen import Screen
from ..state.use import CHOICES
from .fields import Field, choice, number, segments, typed, words
from .numbers import BODY_WEIGHT


@dataclass(frozen=True)
class Setting:
    """Input of a view: `field` builds it for a screen, `read` returns the changes of the screen after an edit."""

    key: str
    field: Callable[[Screen], Field]
    read: Callable[[Screen, Any], dict[str, Any]]


def changed(screen: Screen, path: str, value: Any) -> dict[str, Any]:
    """Return the change of the screen that sets a path such as "quantity" or "use.law"."""
    part, _, key = path.rpartition(".")
    return {part: replace(getattr(screen, part), **{key: value})} if part else {key: value}


def chosen(
    path: str,
    label: str,
    names: Iterable[str] | Callable[[Screen], Iterable[str]],
    build: Callable[..., Field] = choice,
    titles: Callable[[str], str] = str,
    key: str = "",
) -> Setting:
    """Return the choice of a name, with its title; `names` may depend on the screen."""
    key = key or path.rpartition(".")[2]

    def field(screen: Screen) -> Field:
        listed = names(screen) if callable(names) else names
        return build(key, label, [(name, titles(name)) for name in listed], attrgetter(path)(screen))

    def read(screen: Screen, value: Any) -> dict[str, Any]:
        if not isinstance(value, str):
            raise ValueError(f"{key} = {shown(value)} is not a choice")
        return changed(screen, path, value)

    return Setting(key, field, read)


def amount(path: str, label: str, ends: tuple[float, float], step: float) -> Setting:
    """Return a number without a unit, with its typical range."""
    key, unit = path.rpartition(".")[2], Unit("")
    return Setting(
        key,
        lambda screen: number(key, label, unit, ends, step, attrgetter(path)(screen)),
        lambda screen, value: changed(screen, path, typed(label, value, unit, Kind.NUMBER)),
    )


def text(path: str, label: str, rows: int = 1) -> Setting:
    """Return text of several rows."""
    key = path.rpartition(".")[2]

    def read(screen: Screen, value: Any) -> dict[str, Any]:
        if not isinstance(value, str):
            raise ValueError(f"{key} = {shown(value)} must be text")
        return changed(screen, path, value.strip())

    return Setting(key, lambda screen: words(key, label, attrgetter(path)(screen), rows), read)


def _body_weight_field(screen: Screen) -> Field:
    field = BODY_WEIGHT.field("body_weight", screen.use.body_weight, screen.reading)
    return {**field, "hidden": not CYCLES[screen.use.cycle].per_body_weight}


_FOUNDATIONS = {"springs": "springs", "shell": "closed shell", "cup": "real cup"}
CYCLE_SETTINGS = (
    chosen("use.cycle", "Cycle", CHOICES["cycle"]),
    Setting(
        "body_weight",
        _body_weight_field,
        lambda screen, value: changed(screen, "use.body_weight", BODY_WEIGHT.meant(value, screen.reading)),
    ),
    chosen("use.contact", "Liner model", _FOUNDATIONS, segments, _FOUNDATIONS.__getitem__),
)
"""Cycle, body weight where the cycle was measured in patients, and the model of the liner: for Gait and Wear."""
