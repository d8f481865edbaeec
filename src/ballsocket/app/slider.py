"""A number that is moved or typed: a slider over what is usual, and a box for everything else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isclose
from typing import Any

import panel as pn

from .style import asset, inputs


@dataclass(frozen=True, kw_only=True)
class Number:
    """A number of the tables of a joint file, and the range that is usual for it."""

    table: str
    key: str
    label: str
    low: float
    high: float
    step: float
    form: str = "0.[000000]"
    factor: float = 1.0  # from the number in the table to the one that is shown


class _Live(pn.widgets.FloatSlider):
    """Panel gathers what a widget sends for 50 ms; a third of that is enough, and seen sooner."""

    _debounce = 15


class Slider:
    """Both inputs of one number.

    Parameters
    ----------
    spec : Number
    name : str
        By which the page's script and tests find it.
    typed : callable
        Told the number and the spec it belongs to, when a user has changed it.
    """

    def __init__(self, spec: Number, name: str, typed: Callable[[Number, float], None]) -> None:
        self._spec, self._typed, self._putting = spec, typed, False
        self._value = spec.low
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self._box = pn.widgets.FloatInput(
            label=spec.label,
            value=spec.low,
            step=spec.step,
            stylesheets=[asset("box.css"), *inputs()],
            margin=(4, 10, 0, 10),
            **wide,
        )
        self._bar = _Live(
            label="",
            start=spec.low,
            end=spec.high,
            step=spec.step,
            value=spec.low,
            show_value=False,
            tooltips=False,
            margin=(0, 10, 4, 10),
            **wide,
        )
        for widget in (self._box, self._bar):
            widget.param.watch(self._changed, "value")
        self.panel = pn.Column(self._box, self._bar, css_classes=["slider", name], **wide)

    def _changed(self, event: Any) -> None:
        if self._putting:
            return
        if event.new is None or event.new != event.new:  # an emptied box: what was there is still true
            self.put(self._spec, self._value)
        else:
            self._typed(self._spec, event.new)

    def put(self, spec: Number, value: float) -> None:
        """Show a number of the tables; what lies outside the usual range widens it, and what is being moved stays."""
        self._value, shown = value, value * spec.factor
        if spec is self._spec and _same(shown, self._box.value) == self._box.value == self._bar.value:
            return
        self._putting, self._spec = True, spec
        self._box.param.update(label=spec.label, format=spec.form, step=spec.step, value=_same(shown, self._box.value))
        self._bar.param.update(
            start=min(spec.low, shown),
            end=max(spec.high, shown),
            step=spec.step,
            value=_same(shown, self._bar.value),
        )
        self._putting = False


def _same(value: float, shown: float | None) -> float:
    return shown if shown is not None and isclose(value, shown, rel_tol=1e-9) else value
