"""A file about a hip in use: TOML with units in; joint, cup, cycle and law out. Strict, as joint files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees, pi
from pathlib import Path
from typing import Any

from ..core.checks import require, shown
from ..core.kinds import Kind
from ..io.joint_file import KEYS, JointFile, check_keys, read_cup
from ..io.named_joint import PARTS, joint_in
from ..io.toml import read_toml, table_of
from ..io.units import parse
from ..problem.cup import Cup
from .cycle_file import KEYS as CYCLE_KEYS
from .cycle_file import parse_cycle
from .film import Lubricant
from .given_laws import KEYS as WEAR_KEYS
from .given_laws import given_ball_law, given_creep, given_law, given_lubricant, given_seconds, given_surface
from .looks import check_cycles
from .mix import Mix
from .scatter_file import KEYS as SCATTER_KEYS
from .scatter_file import Uncertain, uncertain
from .use import InUse

_TABLES: Mapping[str, tuple[str, ...]] = {
    "": (
        *("name", "source", *PARTS, "cycle", "activity", "wear", "creep", "film", "uncertainty"),
        *("body_weight", "cycles_per_year", "cycles", "report_at", "years", "report_years"),
    ),
    "cup": (*KEYS["cup"], "tilt"),
    "cycle": CYCLE_KEYS,
    "creep": ("law", "compliances", "times", "confinement", "seconds_per_cycle"),
    "film": ("viscosity", "ball_roughness", "cup_roughness", "friction"),
    "wear": WEAR_KEYS,
    "uncertainty": SCATTER_KEYS,
}
FILE_KEYS = {**{name: KEYS[name] for name in PARTS}, **_TABLES}
_MILLION = 1e6


@dataclass(frozen=True, kw_only=True, eq=False)
class HipFile:
    """What a file about a hip in use says: the hip, how many cycles it goes through, and when it is looked at.

    `uncertain` is what differs between patients, where it says so.
    """

    use: InUse
    cycles: float
    report_at: tuple[float, ...]
    lubricant: Lubricant
    uncertain: Uncertain | None = None


def read_hip(path: str | Path) -> HipFile:
    """Read a file about a hip in use.

    Tables: `joint`, `liner`, `ball`, `backing` and `cup` as in joint files (`joint` may be the name of a preset or of a
    joint file); in `cup` a `tilt` from the load may take the place of inclination and anteversion. `cycle` has a `name`
    (see `named_cycle`), with what its machine takes (`force`, `amplitude`, `mismatch`, `stiffness`, `swing_load`), or a
    `file` or several (see `read_cycle`), with `side`, `frame`, `force_on`, `from`, `to`, `closing` and the name of a
    `motion`; and `instants`, `rotation_order`, `body_weight`, `times_body_weight`. In its place an array of tables
    `activity` takes the same, each with how often it is done: `per_year`, or its `share` of `cycles_per_year`. `wear`
    has a `law` ("archard", "energy", "area", "cross-shear"), its `coefficient` in mm³/(N m), the `ball_coefficient` of
    a ball that wears too, `contact` ("springs", "shell", "cup"), the `model` whose springs they are, `ring_width`.
    `creep`, which may be empty, has a `law` ("logarithmic", unverified, or "kelvin-voigt" with `compliances` in 1/MPa
    and `times` in s), a `confinement` ("unconfined" or "constrained") and `seconds_per_cycle`. `film` has `viscosity`
    in Pa s, `ball_roughness`, `cup_roughness`, `friction`. `uncertainty` lists the quantities that differ between
    patients (`coefficient`, `clearance`, `inclination`, `anteversion` or `tilt`, `body_weight`, `cycles_per_year`),
    each by a distribution as in study files, with `count` (of samples, a power of two) and `seed`. At the top:
    `cycles`, `report_at` (a list), or of activities `years` and `report_years`; `body_weight`.

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
    check_keys(content, "", "at the top", FILE_KEYS)
    for name in ("cup", "cycle", "wear", "creep", "film", "uncertainty"):
        check_keys(table_of(content, name), name, f"in [{name}]", FILE_KEYS)
    given = _joint(content, folder)
    cycle, wear = parse_cycle(content, folder), table_of(content, "wear")
    width = {name: parse(name, wear[name], Kind.ANGLE) for name in ("ring_width",) if name in wear}
    use = InUse(
        joint=given.joint,
        cup=given.cup,
        cycle=cycle,
        wear=given_law(wear),
        ball_wear=given_ball_law(wear),
        surface=given_surface(wear),
        creep=given_creep(content, float(given.joint.liner.poisson)),
        seconds_per_cycle=given_seconds(table_of(content, "creep")),
        **width,
    )
    cycles, at = _years(content, cycle) if isinstance(cycle, Mix) and "years" in content else _counts(content)
    check_cycles(cycles, at)
    return HipFile(
        use=use,
        cycles=cycles,
        report_at=at,
        lubricant=given_lubricant(table_of(content, "film")),
        uncertain=uncertain(content, use) if "uncertainty" in content else None,
    )


def _counts(content: Mapping[str, Any]) -> tuple[float, tuple[float, ...]]:
    """How many cycles, and when it is looked at."""
    for name in ("years", "report_years"):
        if name in content:
            raise ValueError(f"{name} needs activities with counts a year, and years: [[activity]]")
    cycles = _count("cycles", content.get("cycles", 5 * _MILLION))
    return cycles, _looks(content, "report_at", cycles)


def _years(content: Mapping[str, Any], mix: Mix) -> tuple[float, tuple[float, ...]]:
    """How many cycles, and when it is looked at, by the years of a mix."""
    for name in ("cycles", "report_at"):
        if name in content:
            raise ValueError(f"{name} and years are one too many: either says how long the hip is in use")
    years = _count("years", content["years"])
    return years * mix.per_year, tuple(each * mix.per_year for each in _looks(content, "report_years", years))


def _looks(content: Mapping[str, Any], name: str, whole: float) -> tuple[float, ...]:
    looks = content.get(name, [share * whole / 10 for share in range(1, 11)])
    if not isinstance(looks, list):
        raise ValueError(f"{name} = {shown(looks)} must be a list of numbers of {_UNITS[name]}")
    return tuple(_count(name, look) for look in looks)


_UNITS = {"cycles": "cycles", "report_at": "cycles", "years": "years", "report_years": "years"}
_LIKE = {"cycles": "5e6", "report_at": "5e6", "years": "20", "report_years": "20"}


def _count(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{name} = {shown(value)} must be a number of {_UNITS[name]}, such as {_LIKE[name]}")
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
