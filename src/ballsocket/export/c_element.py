"""A force element in C: a source and a header that need nothing but a compiler of C99."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from string import Template

from ..contact.law import CurveLaw
from ..core.arrays import Numbers
from ..core.storage.atomic_files import write_text
from ..dynamics import ForceElement, Touch
from ..version import __version__
from .c_text import c_number, c_statements
from .recording import Recording
from .tunable import TUNABLES

BAD_PARAMETER = 6
"""Beside the codes of `Touch`: a parameter that is not allowed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CElement:
    """A force element as a program in C.

    Parameters
    ----------
    element : ForceElement
    name : str
        With which all names in the program begin, so that two joints can live in one program: letters, digits and _.

    Raises
    ------
    ValueError
        A name that C does not allow; bristles, or what sticks, which have a state.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.export import CElement
    >>> element = CElement(element=bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"]), name="hip")
    >>> "int hip_load(" in element.header
    True
    """

    element: ForceElement
    name: str = "ballsocket"

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,40}", self.name):
            raise ValueError(f"name must be letters, digits and _ that C can begin a name with, got {self.name!r:.60}")
        if self.element.remembers:
            raise ValueError(f"{self.element.remembers}, and what is exported has none")

    @cached_property
    def recording(self) -> Recording:
        """The formulas."""
        return Recording(element=self.element)

    @property
    def header(self) -> str:
        """What other programs include."""
        fields = "\n".join(f"    double {each.name}; /* {each.unit}: {each.meaning} */" for each in TUNABLES)
        codes = "\n".join(f"    {self.name.upper()}_{touch.name} = {touch.value}," for touch in Touch)
        words = {"name": self.name, "NAME": self.name.upper(), **self.about}
        return filled("element.h", fields=fields, codes=codes, **words)

    @property
    def source(self) -> str:
        """The program."""
        recording, given = self.recording, self.element.constants
        return filled(
            "element.c",
            name=self.name,
            NAME=self.name.upper(),
            along=_text("curve.c"),
            curves="\n".join(_curve(name, curve) for name, curve in sorted(recording.curves.items())),
            defaults=", ".join(c_number(getattr(given, each.constant)) for each in TUNABLES),
            checks="\n".join(_check(each.name, each.above) for each in TUNABLES),
            first_touch=c_number(given.clearance - given.smoothing),
            load=c_statements({**recording.status, **recording.load}),
            pressed=c_statements({**recording.status, **recording.pressed}),
            tangent=c_statements({**recording.status, **recording.tangent}),
            slope=c_statements({**recording.status, **recording.slope}),
            sentences="\n".join(f'    case {touch.value}: return "{touch.sentence}";' for touch in Touch),
            **self.about,
        )

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Write header and source into a folder.

        Raises
        ------
        OSError
            A folder that cannot be written to.
        """
        folder = Path(folder)
        header = write_text(folder / f"{self.name}.h", self.header)
        return header, write_text(folder / f"{self.name}.c", self.source)

    @property
    def about(self) -> dict[str, str]:
        joint = re.sub(r"[^\x20-\x7e]|\*/|/\*|--|\\", "?", repr(self.element.joint.with_floats()))
        return {"version": __version__, "model": self.element.model.name, "joint": joint}


def _check(name: str, above: bool) -> str:
    least, allowed = (">", "above 0") if above else (">=", "0 or more")
    good = f"p->{name} {least} 0.0 && p->{name} < INFINITY"
    return f'    if (!({good})) return "{name} must be finite and {allowed}";'


def _curve(name: str, curve: CurveLaw) -> str:
    """The numbers of a curve."""
    pieces: Numbers = curve.pieces
    rows = ",\n".join("    " + ", ".join(map(c_number, row)) for row in pieces.tolist())
    ends = ", ".join(map(c_number, (curve.shallowest, curve.deepest, curve.first, curve.density)))
    return (
        f"static const double {name}_rows[] = {{\n{rows}\n}};\n"
        f"static const curve {name}_data = {{{ends}, {pieces.shape[0]}, {pieces.shape[1]}, {name}_rows}};\n"
        f"static void {name}(double d, double out[4]) {{ along_curve(&{name}_data, d, out); }}\n"
    )


def _text(name: str) -> str:
    return (files(__package__) / "templates" / name).read_text(encoding="utf-8")


def filled(template: str, **words: str) -> str:
    """A text of this package with words put into it."""
    return Template(_text(template)).substitute(words)
