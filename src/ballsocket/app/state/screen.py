"""State of the screen as plain data, to and from a link."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import inf, isfinite
from typing import Any
from urllib.parse import parse_qs, urlencode

from ...core.checks import check_names, check_text, shown
from ...core.kinds import Kind
from ...core.quantities import FIT, QUANTITIES
from ...core.unit_systems import Units
from ...evidence.question import LEVELS
from ...files.joint_file import JointFile, joint_of
from ...files.joint_toml import Tables, tables_of
from ...model_catalogue import catalogue, reference
from ...problem.presets import joints
from ...question import complete
from ...studies.expressions import parse_limit, parse_range
from ...studies.limits import Limit
from ...studies.parameters import PARAMETERS
from ..views.registry import VIEW_CLASSES
from ..widgets.reading import Reading
from . import use as in_use
from .use import DEFAULT_USE, Use

VIEWS = tuple(VIEW_CLASSES)
THEMES = ("light", "dark")
ANGLES, SIZES = ("degrees", "radians"), ("radius", "diameter")
LINER_LAWS = ("elastic", "yielding")  # of the finite elements
PAINTED = ("pressure", "stress")  # fields on the drawing of the joint

QUICK = tuple(name for name, model in catalogue.items() if model.seconds_a_press < 1e-4)
"""Models that press a map's points at once."""

MAX_COMPARED = 6
BASES = tuple(map(str, range(MAX_COMPARED + 1)))  # indices of the compared joints: that on the screen first
STANDINGS = ("edge_distance", "max_pressure")  # quantities of the map over orientations of the cup

MAP_MODELS = (*QUICK, *(name for name, model in catalogue.items() if 1e-4 <= model.seconds_a_press < 1e-2))
"""Models that press a map's points at once, and those that press fewer of them in a second or two."""

PICKED = ("any", "catalogue")  # sizes that a click on a map takes
MAPPED = ("max_pressure", "area", "half_angle", "indentation", "stiffness")  # quantities of the design map
AXES = tuple(name for name in PARAMETERS if PARAMETERS[name].kind is not Kind.ANGLE and name not in FIT)
"""Parameters of the design map, whose models solve no preloaded joints."""

MAX_LINK_LENGTH = 8000
MAX_LIMITS = 20
_TABLES = ("preset", "name", "source", "joint", "liner", "ball", "backing", "cup", "load")
_VIEWS = ("use", "ask")
_PREFIXES = tuple(f"beside{number}" for number in range(1, MAX_COMPARED + 1))
_CHOICES = {"influence": LEVELS, "consequence": LEVELS, "elements": ("no", "yes"), "wear": ("no", "yes")}


@dataclass(frozen=True, kw_only=True)
class EvidenceQuestion:
    """Inputs of the evidence view, as typed; `write_question` checks their meaning."""

    question: str = "Does this joint keep its limits?"
    context: str = "A design review before tests. Not for loosening, impingement or fracture."
    influence: str = "medium"
    consequence: str = "medium"
    accuracy: str = "10 %"
    limits: str = "utilisation <= 1"  # phrases separated by ;, also in matrix and tolerances
    matrix: str = ""  # cases; their load is that of the screen unless they state one
    tolerances: str = ""
    friction: str = ""
    elements: str = "no"
    wear: str = "no"

    def __post_init__(self) -> None:
        for entry in fields(self):
            check_text(entry.name, getattr(self, entry.name))
        for name, known in _CHOICES.items():
            check_names([getattr(self, name)], known, f"as {name}")


DEFAULT_QUESTION = EvidenceQuestion()  # question of a page without a link


def check_compared(count: int) -> None:
    """Raise ValueError for more designs than are compared with the one on the screen."""
    if count > MAX_COMPARED:
        raise ValueError(f"at most {MAX_COMPARED} designs are compared with this one, got {count}")


@dataclass(frozen=True, kw_only=True)
class MapAxis:
    """Axis of the map: a parameter of a study from `low` to `high`, in mm, N, MPa, rad."""

    name: str
    low: float
    high: float

    def __post_init__(self) -> None:
        check_names([self.name], AXES, "among the axes of a map")
        if not -inf < self.low < self.high < inf:
            raise ValueError(
                f"{self.name} from {self.low:g} to {self.high:g} is not a range: it must increase to a finite end"
            )

    def __str__(self) -> str:
        return f"{self.name}={_bare(self.name, self.low)}..{_bare(self.name, self.high)}"


@dataclass(frozen=True, kw_only=True)
class Screen:
    """State that a link carries."""

    view: str = "press"
    file: JointFile
    beside: tuple[JointFile, ...] = ()  # at most MAX_COMPARED joints for comparison
    answered_by: str = reference.name  # model of the numbers on top
    shown: tuple[str, ...] = (reference.name, "hess-forsbach", "bartel", "hertz")  # drawn models
    across: MapAxis = MapAxis(name="head_diameter", low=22.0, high=46.0)
    up: MapAxis = MapAxis(name="liner_thickness", low=3.0, high=15.0)
    map_model: str = "tabulated"
    quantity: str = "max_pressure"
    limits: tuple[Limit, ...] = ()
    standing: str = "edge_distance"  # quantity of the map over orientations
    base: str = "1"  # joint with which others are compared
    sizes: str = "any"  # sizes that a click on the map takes
    picked: tuple[float, float] | None = None  # values of `across` and `up` at the chosen point of the map
    use: Use = DEFAULT_USE
    painted: str = "pressure"
    liner_law: str = "elastic"
    asked: EvidenceQuestion = DEFAULT_QUESTION
    angle: str = "degrees"
    size: str = "diameter"
    units: str = Units.SI.value
    theme: str = "light"

    def __post_init__(self) -> None:
        for name, known in _KNOWN.items():
            chosen = getattr(self, name)
            check_names(chosen if isinstance(chosen, tuple) else (chosen,), known, f"as {name}")
        check_compared(len(self.beside))
        if len(self.limits) > MAX_LIMITS:
            raise ValueError(f"a map has at most {MAX_LIMITS} limits, got {len(self.limits)}")
        if not self.file.load:
            raise ValueError("a load is needed: force, indentation or half_angle")
        if self.picked is not None and not all(map(isfinite, self.picked)):
            raise ValueError(f"picked = {self.picked} is not a point of a map, which has two finite numbers")
        if self.across.name == self.up.name:
            raise ValueError(f"a map has two axes, and both are {self.up.name}")

    @cached_property
    def reading(self) -> Reading:
        """Units in which numbers are shown."""
        return Reading(angle=self.angle, units=Units(self.units))

    @cached_property
    def link(self) -> str:
        return link_of(self)


_KNOWN: Mapping[str, Sequence[str]] = {
    "view": VIEWS,
    "answered_by": tuple(catalogue),
    "map_model": MAP_MODELS,
    "quantity": MAPPED,
    "standing": STANDINGS,
    "base": BASES,
    "sizes": PICKED,
    "painted": PAINTED,
    "liner_law": LINER_LAWS,
    "angle": ANGLES,
    "size": SIZES,
    "units": tuple(system.value for system in Units),
    "shown": tuple(catalogue),
    "theme": THEMES,
}
"""Names of each choice, in the order of a link."""

START = Screen(file=JointFile(joints["hip-28"], {"force": 3000.0}))  # screen of a page without a link


def link_of_file(file: JointFile) -> str:
    """Return the query of the link to the start page with the joint of a file, "?..."."""
    return f"?{replace(START, file=with_load(file, START.file.load)).link}"


def with_load(file: JointFile, load: dict[str, float]) -> JointFile:
    """Return a joint file with this load, unless it states one or a preloaded ball is at rest."""
    return replace(file, load=complete(file)[0].load or load)


def link_of(screen: Screen) -> str:
    """Return the query of a link: the differences from the start, and the joint."""
    pairs = []
    for name in (*_KNOWN, "across", "up"):
        value = getattr(screen, name)
        if value != getattr(START, name) and name != "theme":
            pairs.append((name, ",".join(value) if name == "shown" else str(value)))
    if screen.picked is not None:
        pairs.append(("picked", ",".join(map(repr, screen.picked))))
    pairs += [("limit", phrase) for limit in screen.limits for phrase in phrases_of(limit)]
    pairs += in_use.use_pairs(screen.use)
    asked = vars(screen.asked).items()
    pairs += [(f"ask.{name}", value) for name, value in asked if value != getattr(DEFAULT_QUESTION, name)]
    pairs += flat(_tables(screen.file))
    for prefix, file in zip(_PREFIXES, screen.beside, strict=False):
        pairs += flat(_tables(file), f"{prefix}.")
    return urlencode([*pairs, ("theme", screen.theme)])


def read_query(query: str) -> Screen:
    """Read the query of a link."""
    return read_link(parse_qs(query, keep_blank_values=True))


def read_link(pairs: Mapping[str, Sequence[str]]) -> Screen:
    """Read a link with the same strict reader as joint files and the command line."""
    if sum(len(name) + len(value) for name, values in pairs.items() for value in values) > MAX_LINK_LENGTH:
        raise ValueError(f"the link is longer than {MAX_LINK_LENGTH} characters")
    plain = {
        name: values for name, values in pairs.items() if name.split(".")[0] not in (*_TABLES, *_PREFIXES, *_VIEWS)
    }
    check_names(plain, (*_KNOWN, "across", "up", "picked", "limit"), "in the link")
    for name, values in pairs.items():
        if len(values) != 1 and name != "limit":
            raise ValueError(f"{shown(name)} is given {len(values)} times in the link; one is needed")
    words: dict[str, Any] = {name: pairs[name][0] for name in _KNOWN if name in pairs}
    if "shown" in words:
        words["shown"] = tuple(dict.fromkeys(name for name in words["shown"].split(",") if name))
    for name in ("across", "up"):
        if name in pairs:
            axis, low, high = parse_range(pairs[name][0])
            words[name] = MapAxis(name=axis, low=low, high=high)
    if "picked" in pairs:
        text = pairs["picked"][0]
        try:
            x, y = map(float, text.split(","))
        except ValueError as error:
            raise ValueError(
                f"picked = {shown(text)} is not a point of a map: two numbers with a comma between"
            ) from error
        words["picked"] = x, y
    words["use"] = in_use.use_of(_part(pairs, "use"))
    question = _part(pairs, "ask")
    check_names(question, [entry.name for entry in fields(EvidenceQuestion)], "of a question in the link")
    words["asked"] = EvidenceQuestion(**question)
    words["limits"] = tuple(map(parse_limit, pairs.get("limit", ())))
    joint = {name: values[0] for name, values in pairs.items() if name.split(".")[0] in _TABLES}
    further = [_part(pairs, prefix) for prefix in _PREFIXES]
    words["file"] = _joint(joint) if joint else START.file
    words["beside"] = tuple(_joint(part) for part in further if part)
    return Screen(**words)


def _part(pairs: Mapping[str, Sequence[str]], prefix: str) -> dict[str, str]:
    return {name[len(prefix) + 1 :]: values[0] for name, values in pairs.items() if name.startswith(f"{prefix}.")}


def _joint(flat: Mapping[str, str]) -> JointFile:
    """Read a joint from dotted names, with the load of the start if it has none."""
    tables = _nested({name: value for name, value in flat.items() if name != "preset"})
    if "preset" in flat:
        check_names([flat["preset"]], joints, "as preset")
        check_names(tables, ("cup", "load"), "beside a preset")
        tables |= tables_of(JointFile(joints[flat["preset"]], {}))
    elif not set(tables) - {"cup", "load"}:
        tables |= tables_of(JointFile(START.file.joint, {}))
    return with_load(joint_of(tables), START.file.load)


def _tables(file: JointFile) -> Tables:
    """Return the tables of a joint file; short for a preset."""
    tables = tables_of(file)
    for name, joint in joints.items():
        if file.joint == joint:
            return {"preset": name, **{key: tables[key] for key in ("cup", "load") if key in tables}}
    return tables


def flat(part: Any, prefix: str = "") -> list[tuple[str, str]]:
    """Flatten tables to pairs of dotted names: layers by number, and a list of words as one pair for each."""
    pairs = []
    for name, value in enumerate(part) if isinstance(part, list) else part.items():
        words = isinstance(value, list) and not any(isinstance(item, dict) for item in value)
        for item in value if words else [value]:
            if isinstance(item, dict | list):
                pairs += flat(item, f"{prefix}{name}.")
            else:
                pairs.append((f"{prefix}{name}", str(item)))
    return pairs


def _nested(flat: Mapping[str, str]) -> Tables:
    tables: Tables = {}
    layers: dict[int, dict[str, str]] = {}
    for name, value in flat.items():
        table, _, key_path = name.partition(".")
        number, _, key = key_path.partition(".")
        if table == "backing":
            if not (number.isdecimal() and len(number) < 4 and key):
                raise ValueError(f"{shown(name)} in the link is not known; a layer is 'backing.0.thickness' and so on")
            layers.setdefault(int(number), {})[key] = value
        elif key_path:
            part = tables.setdefault(table, {})
            if not isinstance(part, dict):
                raise ValueError(f"{shown(table)} is given as text and as a table in the link")
            part[key_path] = value
        else:
            tables[table] = value
    if layers:
        tables["backing"] = [layers[number] for number in sorted(layers)]
    return tables


def _bare(name: str, value: float) -> str:
    """Write a number to the last digit for `units.parse`; a bare angle would be degrees."""
    return f"{value!r} {Kind.ANGLE.unit}" if QUANTITIES[name].kind is Kind.ANGLE else repr(value)


def phrases_in(text: str) -> Iterator[str]:
    """Yield the phrases of a text, which semicolons or line ends separate."""
    return (phrase.strip() for phrase in text.replace("\n", ";").split(";") if phrase.strip())


def phrases_of(limit: Limit, written: Callable[[str, float], str] = _bare) -> list[str]:
    """Write each end of a limit as text that `parse_limit` reads."""
    ends = ((">=", limit.low), ("<=", limit.high))
    return [f"{limit.name}{sign}{written(limit.name, end)}" for sign, end in ends if isfinite(end)]
