"""Force element as C99 source and header without other dependencies."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from string import Template

import numpy

from ..contact.octave_curve import OctaveCurve
from ..core.checks import known_name
from ..core.display import ascii_text
from ..core.storage.atomic_files import write_text
from ..dynamics import ContactState, ForceElement, PreloadedElement
from ..version import __version__
from .c_text import C, c_number
from .recording import Recording, recording_of
from .tunable import Tunable, tunables_of

BEYOND = {
    "extend": "the indentation exceeds the wall thickness or the range of the model; the force has its last stiffness",
    "stop": ContactState.THROUGH_WALL.sentence,
}
"""What an exported element says of an indentation beyond the range of its law, by what it does there."""


_STATES = {
    "deflection": "Deflections of bristles are in mm, their rates in mm/s.",
    "relaxed_force": "Relaxed forces are in N, their rates in N/s. The energy is that of the long-time modulus.",
}
"""Comments on the internal states of an element."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CElement:
    """Force element as C99 source and header.

    Parameters
    ----------
    element : ForceElement or PreloadedElement
    name : str
        Prefix of all names in the program, so that one program can hold two joints: letters, digits and _.
    beyond : str
        What follows an indentation beyond the wall thickness or the range of the model: "extend" continues the force
        with its last stiffness, "stop" gives NaN. The status is THROUGH_WALL in both.

    Raises
    ------
    ValueError
        A name that C does not allow; an unknown `beyond`; an adhesive element, whose state has no rate.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.export import CElement
    >>> element = CElement(element=bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"]), name="hip")
    >>> "int hip_load(" in element.header
    True
    """

    element: ForceElement | PreloadedElement
    name: str = "ballsocket"
    beyond: str = "extend"

    def __post_init__(self) -> None:
        object.__setattr__(self, "beyond", known_name("beyond", self.beyond, BEYOND))
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,40}", self.name):
            raise ValueError(
                f"name must start with a letter or _ and hold letters, digits and _, got {self.name!r:.60}"
            )
        if self.element.internal_state and not self.element.internal_states:
            raise ValueError(f"{self.element.internal_state}; exported elements do not have it")

    @cached_property
    def recording(self) -> Recording:
        """Recorded formulas of the force element."""
        return recording_of(self.element, self.beyond)

    @cached_property
    def tunables(self) -> tuple[Tunable, ...]:
        """Adjustable parameters in the order of the C structure."""
        return tunables_of(self.element)

    @property
    def header(self) -> str:
        """Text of the C header that other programs include."""
        fields = "\n".join(
            f"    double {parameter.name}; /* {parameter.unit}: {parameter.meaning} */" for parameter in self.tunables
        )
        codes = "\n".join(f"    {self.name.upper()}_{state.name} = {state.value}," for state in ContactState)
        names = {"name": self.name, "NAME": self.name.upper()}
        return fill_template(
            "element.h",
            fields=fields,
            codes=codes,
            failed=str(self.first_failure.value),
            through_wall=f"{ContactState.THROUGH_WALL.value}: {BEYOND[self.beyond]}",
            **names,
            **self._arguments,
            **self.about,
        )

    @property
    def source(self) -> str:
        """Text of the C source file of the force element."""
        recording, constants = self.recording, self.element.constants
        # distance in mm; a lubricated ball has a force at all distances, and an internal state a rate
        always = constants.film_damping > 0.0 or self.element.internal_states
        unloaded = -1.0 if always else recording.constants.clearance - constants.smoothing
        domain = {f"allowed[{index}]": holds for index, holds in enumerate(recording.domain.values())}
        checks = [_range_check_statement(parameter.name, parameter.above) for parameter in self.tunables]
        if domain:
            checks += ["    {", f"    int allowed[{len(domain)}];", C.statements(domain)]
            checks += [
                f'    if (!{name}) return "{text}";' for name, text in zip(domain, recording.domain, strict=True)
            ]
            checks.append("    }")
        sentences = {state: state.sentence for state in ContactState}
        sentences[ContactState.THROUGH_WALL] = BEYOND[self.beyond]
        return fill_template(
            "element.c",
            name=self.name,
            NAME=self.name.upper(),
            along=_read_template("curve.c") if recording.curves else "",
            curves="\n".join(_curve_function_code(name, curve) for name, curve in sorted(recording.curves.items())),
            defaults=", ".join(c_number(parameter.value(self.element)) for parameter in self.tunables),
            checks="\n".join(checks),
            unloaded=C.statements({"unloaded": unloaded}),
            valid=C.statements(recording.validity),
            load=C.statements({**recording.status, **recording.load}),
            pressed=C.statements({**recording.status, **recording.contact_size}),
            tangent=C.statements({**recording.status, **recording.tangent}),
            slope=C.statements({**recording.status, **recording.slope}),
            **self._arguments,
            sentences="\n".join(f'    case {state.value}: return "{text}";' for state, text in sentences.items()),
            **self.about,
        )

    @property
    def _arguments(self) -> dict[str, str]:
        """Arguments of the functions in C for the internal states, comments on them, and sizes of arrays."""
        states = self.element.internal_states
        liner = {name: count for name, count in states.items() if name == "relaxed_force"}
        return {
            "internal": _state_arguments(states),
            "liner": _state_arguments(liner),
            "not_finite": _not_finite_tests(states),
            "liner_not_finite": _not_finite_tests(liner),
            "no_rate": "".join(f"\n        fill({name}_rate, {count}, NAN, 0);" for name, count in states.items()),
            "rate": "".join(f", double {name}_rate[{count}]" for name, count in states.items()),
            "state_units": "".join(f"\n   {_STATES[name]}" for name in states),
            "state_slopes": "\n   Rates of internal states, and these in the direction, come last." if states else "",
            "count": str(9 + sum(states.values())),
        }

    @property
    def first_failure(self) -> ContactState:
        """First status without a load; the statuses after it have none either."""
        return ContactState.NO_NUMBER if self.beyond == "extend" else ContactState.THROUGH_WALL

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Write the header and source files into a folder, and return their paths.

        Raises OSError: a folder that cannot be written to.
        """
        folder = Path(folder)
        header = write_text(folder / f"{self.name}.h", self.header)
        return header, write_text(folder / f"{self.name}.c", self.source)

    @property
    def about(self) -> dict[str, str]:
        """Version, model and joint as texts for the comments in generated files."""
        joint = self.element.joint
        description = f"{joint}; {joint.source}" if joint.source else str(joint)
        comment = re.sub(r"\*/|/\*|--|\\", "?", ascii_text(description))
        return {"version": __version__, "model": self.element.model.name, "joint": comment}


def _state_arguments(states: Mapping[str, int]) -> str:
    return "".join(f", const double {name}[{count}]" for name, count in states.items())


def _not_finite_tests(states: Mapping[str, int]) -> str:
    """Return alternatives of a condition in C: an internal state is not finite, or too large to square."""
    squares = {name: " + ".join(f"{name}[{i}] * {name}[{i}]" for i in range(count)) for name, count in states.items()}
    return "".join(f" || !(1e8 * ({sum_of_squares}) < INFINITY)" for sum_of_squares in squares.values())


def _range_check_statement(name: str, is_positive: bool) -> str:
    operator, allowed = (">", "above 0") if is_positive else (">=", "0 or more")
    condition = f"p->{name} {operator} 0.0 && p->{name} < INFINITY"
    return f'    if (!({condition})) return "{name} must be finite and {allowed}";'


def _curve_function_code(name: str, curve: OctaveCurve) -> str:
    """Return the C code of a fitted curve: its coefficients and the function that evaluates it."""
    rows = numpy.column_stack([curve.origins, curve.coefficients[0].T])
    row_lines = ",\n".join("    " + ", ".join(map(c_number, row)) for row in rows.tolist())
    ends = f"{c_number(curve.low)}, {c_number(curve.high)}, {curve.first}, {curve.density}"
    return (
        f"static const double {name}_rows[] = {{\n{row_lines}\n}};\n"
        f"static const curve {name}_data = {{{ends}, {rows.shape[0]}, {rows.shape[1]}, {name}_rows}};\n"
        f"static void {name}(double d, double out[4]) {{ along_curve(&{name}_data, d, out); }}\n"
    )


def _read_template(name: str) -> str:
    return (files(__package__) / "templates" / name).read_text(encoding="utf-8")


def fill_template(template_name: str, **values: str) -> str:
    """Fill a template file of this package with values, and return the resulting text."""
    return Template(_read_template(template_name)).substitute(values)
