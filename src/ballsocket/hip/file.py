"""A file about a hip in use: TOML with units in; joint, cup, cycle and law out. Strict, as joint files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import degrees, pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..catalogue import catalogue
from ..checks import check_names, check_text, known_name, require, shown
from ..cup import Cup
from ..io.joint_file import KEYS, JointFile, check_keys, read_cup
from ..io.named_joint import PARTS, joint_in
from ..io.toml import read_toml, table_of
from ..io.units import parse
from ..kinds import Kind
from ..models.foundation import RadialFoundation
from ..sphere.surfaces import ClosedShell, RealCup, Springs
from .coefficients import share_of_slide, wear_factor
from .creep import Ladder, logarithmic
from .cycle import INSTANTS, Cycle, order_of
from .cycle_file import read_cycle
from .film import Lubricant
from .gait import constant_load, rocking
from .laws import Archard, AreaLaw, CrossShear, Law
from .named_cycles import CYCLES, named_cycle
from .use import InUse, check_cycles

_TABLES: Mapping[str, tuple[str, ...]] = {
    "": ("name", "source", *PARTS, "cycle", "wear", "creep", "film", "cycles", "report_at"),
    "cup": (*KEYS["cup"], "tilt"),
    "cycle": ("name", "file", "instants", "rotation_order", "body_weight", "force", "amplitude"),
    "creep": ("law", "compliances", "times", "seconds_per_cycle"),
    "film": ("viscosity", "ball_roughness", "cup_roughness", "friction"),
    "wear": ("law", "coefficient", "circular", "exponent", "reference", "contact", "model", "ring_width"),
}
_KEYS = {**{name: KEYS[name] for name in PARTS}, **_TABLES}
_MILLION = 1e6


@dataclass(frozen=True, kw_only=True, eq=False)
class HipFile:
    """What a file about a hip in use says: the hip, how many cycles it goes through, and when it is looked at."""

    use: InUse
    cycles: float
    report_at: tuple[float, ...]
    lubricant: Lubricant


def read_hip(path: str | Path) -> HipFile:
    """Read a file about a hip in use.

    Tables: `joint`, `liner`, `ball`, `backing` and `cup` as in joint files (`joint` may be the name of a preset or of
    a joint file); in `cup` a `tilt` from the load may take the place of inclination and anteversion. `cycle` has a
    `name` ("iso-14242-1", "iso-14242-1-key-points", "flexion", "biaxial-rocking", "constant-load"; the last two with
    `force` and `amplitude`) or a `file` (a table of text), `instants`, `rotation_order`, `body_weight`. `wear` has a
    `law` ("archard", "area", "cross-shear"), its `coefficient` in mm³/(N m), `contact` ("springs", "shell", "cup"), the
    `model` whose springs they are, `ring_width`. `creep`, which may be empty, has a `law` ("logarithmic", unverified,
    or "kelvin-voigt" with `compliances` in 1/MPa and `times` in s) and `seconds_per_cycle`. `film` has `viscosity` in
    Pa s, `ball_roughness`, `cup_roughness`, `friction`. At the top: `cycles`, `report_at` (a list).

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "hip", lambda content: _hip(content, path.parent))


def _hip(content: Mapping[str, Any], folder: Path) -> HipFile:
    check_keys(content, "", "at the top", _KEYS)
    for name in ("cup", "cycle", "wear", "creep", "film"):
        check_keys(table_of(content, name), name, f"in [{name}]", _KEYS)
    given = _joint(content, folder)
    cycle, wear = _cycle(table_of(content, "cycle"), folder), table_of(content, "wear")
    use = InUse(
        joint=given.joint,
        cup=given.cup,
        cycle=cycle,
        wear=_law(wear),
        surface=_surface(wear),
        creep=_creep(content),
        seconds_per_cycle=_seconds(table_of(content, "creep")),
        **({"ring_width": parse("ring_width", wear["ring_width"], Kind.ANGLE)} if "ring_width" in wear else {}),
    )
    cycles = _count("cycles", content.get("cycles", 5 * _MILLION))
    looks = content.get("report_at", [share * cycles / 10 for share in range(1, 11)])
    if not isinstance(looks, list):
        raise ValueError(f"report_at = {shown(looks)} must be a list of numbers of cycles")
    at = tuple(_count("report_at", look) for look in looks)
    check_cycles(cycles, at)
    return HipFile(use=use, cycles=cycles, report_at=at, lubricant=_lubricant(table_of(content, "film")))


def _count(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{name} = {shown(value)} must be a number of cycles, such as 5e6")
    return float(value)


def _joint(content: Mapping[str, Any], folder: Path) -> JointFile:
    """Joint and cup, which may have a tilt in place of where it faces, and stands beside a joint's name too."""
    around = dict(table_of(content, "cup"))
    tilt = around.pop("tilt", None)
    file = joint_in({name: each for name, each in content.items() if name != "cup"}, folder)
    if around:
        file = replace(file, cup=read_cup(around))
    return file if tilt is None else replace(file, cup=_tilted(file.cup, tilt, around))


def _tilted(cup: Cup, tilt: Any, given: Mapping[str, Any]) -> Cup:
    for name in ("inclination", "anteversion"):
        if name in given:
            raise ValueError(f"tilt and {name} are one too many: either says where the cup faces")
    angle = parse("tilt", tilt, Kind.ANGLE)
    require("tilt", degrees(angle), 0 <= angle <= pi / 2, "a cup's tilt from the load is 0 to 90 degrees")
    return cup.tilted(angle)


_AMPLE: Mapping[str, tuple[Callable[..., Cycle], str]] = MappingProxyType(
    {"biaxial-rocking": (rocking, "peak"), "constant-load": (constant_load, "force")}
)


def _cycle(table: Mapping[str, Any], folder: Path) -> Cycle:
    if ("name" in table) == ("file" in table):
        raise ValueError(f"[cycle] needs a name or a file, and not both; names: {', '.join(CYCLES)}")
    instants = table.get("instants", INSTANTS)
    order = order_of(table.get("rotation_order", "flexion, adduction, rotation"))
    if "file" in table:
        check_names(table, ("file", "instants", "rotation_order", "body_weight"), "beside a file in [cycle]")
        weight = parse("body_weight", table["body_weight"], Kind.FORCE) if "body_weight" in table else None
        return read_cycle(folder / check_text("file", table["file"]), instants, order, weight)
    name = known_name("cycle", table["name"], CYCLES)
    if name not in _AMPLE:
        check_names(table, ("name", "instants", "rotation_order"), f"beside the name {name!r} in [cycle]")
        return named_cycle(name, instants, order)
    make, force = _AMPLE[name]
    words = {force: parse("force", table["force"], Kind.FORCE)} if "force" in table else {}
    words |= {"amplitude": parse("amplitude", table["amplitude"], Kind.ANGLE)} if "amplitude" in table else {}
    return make(instants, order, **words)


_LAWS = ("archard", "area", "cross-shear")
_OF_CROSS_SHEAR = ("circular", "exponent", "reference")


def _law(table: Mapping[str, Any]) -> Law:
    name = known_name("law", table.get("law", "archard"), _LAWS)
    if "coefficient" not in table:
        raise ValueError("[wear] needs a coefficient, such as '1.066e-6 mm^3/(N m)'")
    if name != "cross-shear":
        for each in _OF_CROSS_SHEAR:
            if each in table:
                raise ValueError(f"{each} belongs to the law 'cross-shear', and the law is {name!r}")
    if name == "area":
        return AreaLaw(coefficient=share_of_slide("coefficient", table["coefficient"]))
    straight = wear_factor("coefficient", table["coefficient"])
    if name == "archard":
        return Archard(coefficient=straight)
    if "circular" not in table:
        raise ValueError("the law 'cross-shear' needs circular, its coefficient on a circle, beside that on a line")
    return CrossShear(
        straight=straight,
        circular=wear_factor("circular", table["circular"]),
        exponent=parse("exponent", table.get("exponent", 0.0), Kind.NUMBER),
        reference=parse("reference", table.get("reference", 1.0), Kind.MODULUS),
    )


_CREEPS = ("logarithmic", "kelvin-voigt")
_ELEMENTS = ("compliances", "times")


def _creep(content: Mapping[str, Any]) -> Ladder | None:
    """Without a table there is no creep."""
    if "creep" not in content:
        return None
    table = table_of(content, "creep")
    given = [name for name in _ELEMENTS if name in table]
    name = known_name("creep law", table.get("law", "kelvin-voigt" if given else "logarithmic"), _CREEPS)
    if name == "logarithmic":
        if given:
            raise ValueError(f"{given[0]} belongs to the law 'kelvin-voigt', and the law is {name!r}")
        return logarithmic()
    compliances, times = (_numbers(each, table.get(each)) for each in _ELEMENTS)
    return Ladder(compliances=compliances, times=times)


def _numbers(name: str, value: Any) -> tuple[float, ...]:
    if not isinstance(value, list) or not value:
        raise ValueError(f"{name} = {shown(value)} must be a list of numbers, in 1/MPa and in s")
    return tuple(parse(name, each, Kind.NUMBER) for each in value)


def _seconds(table: Mapping[str, Any]) -> float | None:
    value = table.get("seconds_per_cycle")
    return None if value is None else parse("seconds_per_cycle", value, Kind.NUMBER)


def _lubricant(table: Mapping[str, Any]) -> Lubricant:
    words = {name: parse(name, table[name], Kind.NUMBER) for name in ("viscosity", "friction") if name in table}
    words |= {
        name: parse(name, table[name], Kind.LENGTH) for name in ("ball_roughness", "cup_roughness") if name in table
    }
    return Lubricant(**words)


_CONTACTS: Mapping[str, ClosedShell | RealCup | None] = MappingProxyType(
    {"springs": None, "shell": ClosedShell(), "cup": RealCup()}
)


def _surface(table: Mapping[str, Any]) -> Springs | ClosedShell | RealCup:
    contact = known_name("contact", table.get("contact", "springs"), _CONTACTS)
    elastic = _CONTACTS[contact]
    if elastic is not None:
        if "model" in table:
            raise ValueError(f"a model has springs, and the contact is {contact!r}: leave one of them out")
        return elastic
    model = catalogue[known_name("model", table.get("model", "hess-forsbach"), catalogue)]
    if not isinstance(model, RadialFoundation):
        names = ", ".join(name for name, each in catalogue.items() if isinstance(each, RadialFoundation))
        raise ValueError(f"the model {model.name!r} has no radial springs; those that have: {names}")
    return Springs(modulus=model.modulus)
