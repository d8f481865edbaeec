"""Inputs: every key of the tables of a file, as documentation, options of commands and explorer show it.

A new key of a table is an input without another line. `_TYPICAL` adds a range, a step and an example to a number,
and `_REMARKS` a remark to its help.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache, cached_property
from math import inf
from types import MappingProxyType
from typing import Any, NamedTuple

from msgspec import inspect

from ..core.kinds import Kind
from ..core.quantities import LOADS, QUANTITIES, Quantity
from ..problem.dimensions import LENGTHS, canonical
from .schema import FileTable, QuantityValue, Text, Value


class Typical(NamedTuple):
    """Typical range and step of a number in the unit of metric pages, an example, and the bounds of a typed number.

    Bounds and sizes are in mm, N, MPa and degrees.
    """

    ends: tuple[float, float]
    step: float
    example: str
    bounds: tuple[float, float] = (-inf, inf)
    reason: str = ""  # of the bounds
    sizes: tuple[float, ...] = ()  # of manufacturers


# fmt: off
_TYPICAL: Mapping[str, Typical] = MappingProxyType({
    "ball_radius": Typical((5, 30), 0.1, "16 mm", (1e-3, 1e4), "from a grain to the sphere of a bridge bearing",
                           (11.1125, 13, 14, 16, 18, 20, 22)),
    "head_diameter": Typical((10, 60), 0.2, "32 mm", (2e-3, 2e4), "from a grain to the sphere of a bridge bearing",
                             (22.225, 26, 28, 32, 36, 40, 44)),
    "socket_radius": Typical((5, 30), 0.1, "16.1 mm", (1e-3, 1e4), "from a grain to a bridge bearing"),
    "clearance": Typical((0, 0.5), 0.005, "0.1 mm", (0, 1e3), "a ball with a larger clearance is not conformal"),
    "diametral_clearance": Typical((0, 1), 0.01, "0.2 mm", (0, 2e3), "a ball with a larger clearance is not conformal"),
    "interference": Typical((0, 0.1), 0.005, "0.02 mm", (0, 1e3), "a tenth of the radius of a bridge bearing"),
    "liner_thickness": Typical((0.5, 20), 0.1, "6 mm", (1e-4, 1e4),
                               "from a coating to a block; tick the solid socket for more", (3, 4, 5, 6, 7, 8, 10)),
    "outer_radius": Typical((10, 40), 0.1, "24 mm", (1e-3, 3e4), "a ball, its liner and its backing",
                            tuple(range(22, 35))),
    "outer_diameter": Typical((20, 80), 0.2, "52 mm", (2e-3, 6e4), "a ball, its liner and its backing",
                              tuple(range(44, 70, 2))),
    "thickness": Typical((0.5, 10), 0.1, "2 mm", (1e-4, 1e4), "from a coating to a block"),
    "young": Typical((100, 5000), 10, "1 GPa", (1e-3, 1.3e6), "from a gel to diamond"),
    "ball_young": Typical((1e3, 4e5), 1e3, "230 GPa", (1e-3, 1.3e6), "from a gel to diamond"),
    "poisson": Typical((0, 0.4995), 0.005, "0.4", (-0.999, 0.5), "the limits of an isotropic solid"),
    "yield_stress": Typical((1, 100), 0.5, "20 MPa", (1e-3, 1e5), "from a gel to diamond"),
    "allowable_pressure": Typical((1, 100), 0.5, "20 MPa", (1e-3, 1e5), "from a gel to diamond"),
    "force": Typical((50, 5000), 50, "3 kN", (0, 1e9), "a bridge bearing carries 1e8 N"),
    "indentation": Typical((1, 200), 1, "40 um", (0, 1e3), "thicker than any liner"),
    "half_angle": Typical((1, 80), 0.5, "40 deg", (0, 180), "from the pole to its opposite"),
    "tilt": Typical((0, 90), 1, "45 deg", (0, 180), "an angle to the cup's axis"),
    "direction": Typical((-45, 45), 1, "0.2,0.1,1", (-80, 80), "the load must press into the body"),
    "arc_of_cover": Typical((120, 220), 1, "170 deg", (40, 340), "the ball must stay in its socket"),
    "chamfer": Typical((0, 3), 0.1, "1 mm", (0, 1e3), "wider than any rim"),
    "inclination": Typical((0, 90), 1, "45 deg", (0, 90), "from an upright axis to a level one"),
    "anteversion": Typical((-30, 60), 1, "15 deg", (-90, 90), "from the back to the front"),
    "pelvic_tilt": Typical((-30, 30), 1, "10 deg"),
    "body_weight": Typical((300, 1500), 10, "750 N", (1, 1e4), "at most ten times that of a heavy patient"),
})
"""Typical numbers by the name of the input, or by its key."""

_REMARKS = {
    "material": "See `ballsocket presets`; single numbers replace its values.",
    "ball": "See `ballsocket presets`; single numbers replace its values. Without a material the ball is rigid.",
    "shell": "Its thickness follows from --outer-diameter and --liner-thickness, or is --shell-thickness.",
    **dict.fromkeys(("interference", "tilt", "direction"), "Contacts with it are solved by the model sphere."),
    "orientation": "See Murray 1993.",
}
"""Remarks in the help of options, by the name of the input or by its key."""

# fmt: on
_NOT_IN_FILES = ("orientation", "pelvic_tilt")
"""Inputs whose default is not that of the file, which is read to radiographic angles in the body."""

_PREFIXES = {"ball": "ball_", "shell": "shell_"}  # beginnings of the names of options by table

_LENGTHS = {name: canonical(name) for name in LENGTHS}
_RIVALS = (
    *([name for name in LENGTHS if _LENGTHS[name] == length] for length in dict.fromkeys(_LENGTHS.values())),
    tuple(LOADS),
    ("tilt", "direction"),
)
"""Keys of which a joint or a load has one."""


@dataclass(frozen=True)
class Input:
    """Key of a table of files.

    `table` is the head of its table, such as "[joint]" or "[[backing]]", and empty at the top of the file.
    """

    table: str
    field: inspect.Field

    @property
    def key(self) -> str:
        """Name of the key in its table."""
        return self.field.encode_name

    @property
    def type(self) -> inspect.Type:
        """Type of the values, for `msgspec`."""
        return self.field.type

    @property
    def shown(self) -> Mapping[str, str]:
        """Example and default that the declaration of the key states."""
        return (self.type.extra if isinstance(self.type, inspect.Metadata) else None) or {}

    @property
    def default(self) -> str:
        """Default, "required", or empty without a default."""
        value = plain_default(self.field)
        if value is None:
            return "required" if self.field.required else self.shown.get("default", "")
        return str(value).lower() if isinstance(value, bool) else str(value)

    @property
    def part(self) -> str:
        """Name of the table."""
        return self.table.strip("[]")

    @cached_property
    def name(self) -> str:
        """Name of the option: "liner" and "ball" are materials, and keys of the liner have no prefix."""
        return self.part if self.key == "material" else f"{_PREFIXES.get(self.part, '')}{self.key}"

    @property
    def option(self) -> str:
        """Option of a command."""
        return f"--{self.name}".replace("_", "-")

    @property
    def quantity(self) -> Quantity | None:
        """Quantity of the number; None for a key that is not among the quantities."""
        return QUANTITIES.get(f"{self.part}_{self.key}") or QUANTITIES.get(self.key)

    @property
    def typical(self) -> Typical | None:
        """Typical range and example; None for a key without them."""
        return _TYPICAL.get(self.name) or _TYPICAL.get(self.key)

    @property
    def example(self) -> str:
        """Example of a value; empty for a key without one."""
        return self.shown.get("example") or (self.typical.example if self.typical else "")

    @cached_property
    def choices(self) -> list[str]:
        """Words that the key allows, or the names that it knows; empty for other keys."""
        return choices_in(self.type)

    @cached_property
    def meaning(self) -> str:
        """Meaning of the key."""
        return meaning_of(self.key, self.type)

    @property
    def titled(self) -> Quantity | None:
        """Quantity of the number; None for a key with a meaning of its own."""
        return self.quantity if self.quantity and self.meaning == QUANTITIES[self.key].title else None

    @property
    def label(self) -> str:
        """Name of the input with a capital letter, and the part that it belongs to."""
        own = self.titled.title if self.titled else self.meaning
        text = own if self.part not in ("liner", "ball", "shell") or self.part in own else f"{own} of the {self.part}"
        return f"{text[:1].upper()}{text[1:]}"

    @property
    def rivals(self) -> list[str]:
        """Keys of a joint file that exclude this one."""
        groups = [group for group in _RIVALS if self.part and self.key in group]
        return [rival for group in groups for rival in group if rival != self.key]

    @cached_property
    def help(self) -> str:
        """Help of the option: label, symbol, unit, example or choices, definition, remark, rivals and default."""
        symbol, definition = (self.titled.symbol, self.titled.meaning) if self.titled else ("", "")
        name, _, condition = self.label.partition("; ")
        start = f"{name} {symbol}".strip() + unit_words(name, self.type)
        start += f", such as {self.example!r}" if self.example else ""
        if self.choices and self.key != "material":
            *first, last = map(repr, self.choices)
            start += f": {', '.join(first)} or {last}"
        default = self.default if self.part or plain_default(self.field) is None else ""
        follows = bool(self.part) and self.key not in _NOT_IN_FILES
        rivals = " or ".join(f"--{rival}".replace("_", "-") for rival in self.rivals)
        sentences = (
            f"{start}; {condition}" if condition else start,
            definition.partition(". ")[0].rstrip(".").replace("`", ""),
            _REMARKS.get(self.name) or _REMARKS.get(self.key, ""),
            f"Not with {rivals}" if rivals else "",
            f"Default: {'as in the file, or ' * follows}{default}" if default else "",
        )
        return " ".join(f"{sentence.rstrip('.')}." for sentence in sentences if sentence)


def unit_words(name: str, kind: inspect.Type) -> str:
    """Write the unit of a bare number behind its name; empty for other values."""
    kinds = [custom.kind for custom in customs_in(kind) if issubclass(custom, QuantityValue)]
    unit = "degrees" if kinds == [Kind.ANGLE] else "".join(kind.assumed_unit for kind in kinds)
    return f"{',' * (',' in name)} in {unit}" if unit else ""


@cache
def inputs_of(table: type[FileTable]) -> tuple[Input, ...]:
    """List the keys of a file, table by table, those at the top first."""
    root = inspect.type_info(table)
    tables: list[tuple[str, Any]] = [("", root), *tables_of(root)]
    heads = {head.strip("[]") for head, _ in tables}
    return tuple(
        Input(head, field)
        for head, struct in tables
        for field in struct.fields
        if f"{head.strip('[]')}.{field.encode_name}".lstrip(".") not in heads
        or any(isinstance(part, inspect.StrType) for part in parts_of(field.type))  # a text in place of a table
    )


def plain_default(field: inspect.Field) -> Any:
    """Return the default of a key as JSON has it; None without a default, or for a table."""
    value = getattr(field.default, "written", field.default)
    value = value.value if isinstance(value, Enum) else value
    plain = next((kind for kind in (bool, int, float, str) if isinstance(value, kind)), None)
    return None if plain is None else plain(value)


def parts_of(kind: inspect.Type) -> Iterator[inspect.Type]:
    """List the members of a union without their annotations, or the type itself."""
    if isinstance(kind, inspect.Metadata):
        yield from parts_of(kind.type)
    elif isinstance(kind, inspect.UnionType):
        for member in kind.types:
            yield from parts_of(member)
    else:
        yield kind


def struct_in(kind: inspect.Type) -> inspect.StructType | None:
    """Return the table among the types of a value; None without one."""
    return next((part for part in parts_of(kind) if isinstance(part, inspect.StructType)), None)


def customs_in(kind: inspect.Type) -> list[type[Value]]:
    """List the types of values of this package among the types of a value."""
    return [part.cls for part in parts_of(kind) if isinstance(part, inspect.CustomType)]


def choices_in(kind: inspect.Type) -> list[str]:
    """List the words that a key allows; empty for other keys."""
    for part in parts_of(kind):
        if isinstance(part, inspect.EnumType):
            return [item.value for item in part.cls]
    return [word for custom in customs_in(kind) if issubclass(custom, Text) for word in custom.choices]


def tables_of(kind: inspect.Type) -> Iterator[tuple[str, inspect.StructType]]:
    """List the tables of a file with their heads: "[liner]", "[[backing]]", "[machine.NAME]", "[free.liner]"."""
    struct = struct_in(kind)
    for field in struct.fields if struct else ():
        for part in parts_of(field.type):
            head, inner = field.encode_name, None
            if isinstance(part, inspect.StructType):
                inner = part
            elif isinstance(part, inspect.DictType):
                head, inner = f"{head}.NAME", struct_in(part.value_type)
            elif isinstance(part, inspect.ListType):
                head, inner = f"[{head}]", struct_in(part.item_type)
            if inner is not None:
                yield f"[{head}]", inner
                yield from ((f"[{head}.{name.strip('[]')}]", table) for name, table in tables_of(inner))


def meaning_of(key: str, kind: inspect.Type) -> str:
    """Return the meaning of a key: its own, or that of the quantity of this name."""
    text = (kind.extra_json_schema or {}).get("description") if isinstance(kind, inspect.Metadata) else None
    return str(text or (QUANTITIES[key].title if key in QUANTITIES else ""))
