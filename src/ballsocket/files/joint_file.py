"""Joint files: TOML with units that describes a joint, its cup and its load; joints of files of other kinds.

Annotations are objects here, not text, which msgspec would compile at each start.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import degrees, hypot, inf, isinf, pi
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

from msgspec import structs

from ..contact.assembly import select_and_check_load
from ..core.checks import check_text, nearest, normalise_name, require, shown
from ..core.input_files import resolve_input
from ..core.kinds import Kind
from ..problem import Joint, Layer, Material, Support
from ..problem.cup import DEFAULT_CUP, AngleDefinition, Cup, Interface, Side
from ..problem.dimensions import STORED_LENGTHS, canonical, resolve_lengths
from ..problem.hardening import Hardening
from ..problem.presets import MATERIAL_ALIASES, joints, materials, named_material
from .schema import Angle, FileTable, Force, Length, Parsed, PlainNumber, Pressure, Text, Value, choices_schema, meaning
from .tables import quantities_of, read_table, written_in
from .toml import parse_toml, read_toml
from .units import as_given, parse

_MAX_LAYERS = 20  # largest number of layers behind the liner


class LengthsTable(FileTable, frozen=True, kw_only=True):
    """Lengths of a joint: two of radii and clearance, and the thickness of the liner or an outer dimension."""

    ball_radius: Length | None = None
    head_diameter: Length | None = None
    socket_radius: Length | None = None
    clearance: Length | None = None
    diametral_clearance: Length | None = None
    liner_thickness: Length | None = None
    outer_radius: Length | None = None
    outer_diameter: Length | None = None
    interference: Length | None = None
    support: Annotated[Support, meaning("outermost surface behind the liner")] = Support.FIXED


class MaterialName(Text):
    """Name of a preset material."""

    choices = tuple(materials)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        return choices_schema((*materials, *MATERIAL_ALIASES))


class MaterialTable(FileTable, frozen=True, kw_only=True):
    """Material: a preset by name, numbers, or both; numbers win over those of the preset."""

    qualified: ClassVar[bool] = True

    material: Annotated[MaterialName | None, meaning("name of a preset material")] = None
    young: Pressure | None = None
    poisson: PlainNumber | None = None
    proportional_limit: Pressure | None = None
    yield_stress: Pressure | None = None
    fatigue_limit: Pressure | None = None
    allowable_pressure: Pressure | None = None


class HardeningCurve(Parsed):
    """Points 'stress:plastic strain' and Young's modulus of the curve, such as '20 MPa:0, 24 MPa:0.01; E 1.2 GPa'."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "string", "pattern": ":"}

    @classmethod
    def parse(cls, name: str, value: Any) -> Hardening:
        """Convert a text to a curve; stresses and modulus may have units."""
        return Hardening.parse(check_text(name, value), lambda stress: parse(name, stress, Kind.MODULUS))


class LinerTable(MaterialTable, frozen=True, kw_only=True):
    """Material of the liner: a preset by name, numbers, or both; it may yield."""

    hardening: Annotated[
        HardeningCurve | None,
        meaning(
            "yield stress over plastic strain, and the Young's modulus E to which these strains belong if it is not "
            "the liner's",
            example="20:0, 24:0.01; E 1200",
            default="perfectly plastic",
        ),
    ] = None


class LayerTable(MaterialTable, frozen=True, kw_only=True):
    """Layer behind the liner, from the liner outwards."""

    thickness: Annotated[Length, meaning("thickness of the layer; inf is a massive body")]


class ShellTable(MaterialTable, frozen=True, kw_only=True):
    """Shell right behind the liner; its thickness may follow from the outer dimension and the liner."""

    thickness: Annotated[Length | None, meaning("thickness of the shell")] = None


class CupTable(FileTable, frozen=True, kw_only=True):
    """Cup: its rim, its interface with the liner, and its orientation in the body."""

    arc_of_cover: Annotated[Angle | None, meaning(default="180 deg")] = None
    chamfer: Annotated[Length | None, meaning(default="0 mm")] = None
    inclination: Annotated[Angle | None, meaning(default="0 deg")] = None
    anteversion: Annotated[Angle | None, meaning(default="0 deg")] = None
    interface: Annotated[Interface | None, meaning("interface of liner and backing", default="bonded")] = None
    side: Annotated[Side | None, meaning("side of the body", default="right")] = None
    orientation: Annotated[
        AngleDefinition | None, meaning("definition of inclination and anteversion", default="radiographic")
    ] = None
    pelvic_tilt: Annotated[
        Angle | None,
        meaning(
            "tilt of the pelvis in which the angles are measured, positive with its top to the front", default="0 deg"
        ),
    ] = None


class Direction(Value, tuple[float, ...]):
    """Direction of a load: three numbers to the right, to the front and upwards."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["array", "string"], "minItems": 3, "maxItems": 3}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert three numbers: a list, or a text with commas."""
        parts = value.split(",") if isinstance(value, str) else value
        if not isinstance(parts, list | tuple) or len(parts) != 3:
            raise ValueError(f"{name} = {shown(value)} must be three numbers 'x,y,z'")
        numbers = cls(parse(name, part, Kind.NUMBER) for part in parts)
        length = hypot(*numbers)
        require(f"length of {name}", length, 0 < length < inf, "a direction points somewhere")
        return numbers


class LoadTable(FileTable, frozen=True, kw_only=True):
    """Load: one of force, indentation and half angle; a tilt from the cup's axis, or a direction in the body."""

    force: Force | None = None
    indentation: Length | None = None
    half_angle: Angle | None = None
    tilt: Annotated[Angle | None, meaning(default="0 deg")] = None
    direction: Annotated[
        Direction | None, meaning("direction of the load: to the right, to the front, upwards", default="upwards")
    ] = None


class JointTables(FileTable, frozen=True, kw_only=True):
    """Tables that describe a joint in every kind of file."""

    joint: Annotated[LengthsTable | str | None, meaning("name of a preset, or path of a joint file")] = None
    liner: LinerTable | None = None
    ball: MaterialTable | None = None
    shell: ShellTable | None = None
    backing: list[LayerTable] | None = None
    cup: CupTable | None = None


class ReportDetails(FileTable, frozen=True, kw_only=True):
    """Head of the report: names, and a picture beside them."""

    qualified: ClassVar[bool] = True

    customer: Annotated[Text | None, meaning("customer of the report")] = None
    project: Annotated[Text | None, meaning("project or order")] = None
    author: Annotated[Text | None, meaning("author of the report")] = None
    logo: Annotated[Text | None, meaning("path of a picture, .png or .svg, from the folder of the file")] = None


class JointFileTable(JointTables, frozen=True, kw_only=True):
    """Joint file."""

    name: Annotated[Text | None, meaning("name of the joint")] = None
    source: Annotated[Text | None, meaning("source of the numbers")] = None
    joint: LengthsTable | None = None
    load: LoadTable | None = None
    report: ReportDetails | None = None


NO_DETAILS = ReportDetails()  # head of a report without names and logo


@dataclass(frozen=True)
class JointFile:
    """Contents of a joint file: a joint, its load, its cup and the direction of the load.

    Attributes
    ----------
    joint : Joint
    load : dict
        Empty, or one of force (N), indentation (mm) and half_angle (rad).
    cup : Cup
    aim : dict
        Direction of the load as the keyword of `Sphere.press`: empty, or one of tilt (rad) and direction.
    report : ReportDetails
        Head of a report.
    """

    joint: Joint
    load: dict[str, float]
    cup: Cup = DEFAULT_CUP
    aim: dict[str, Any] = field(default_factory=dict)
    report: ReportDetails = NO_DETAILS

    @property
    def tilt(self) -> float:
        """Angle in rad between the load and the axis of the cup."""
        return self.cup.load_tilt(**self.aim)


def read_joint(path: str | Path) -> JointFile:
    """Read a joint file.

    The page "Keys of files" of the reference lists all tables and keys. Values are text with a unit ("16 mm", "3 kN",
    "1 GPa", "40 deg") or bare numbers in mm, N, MPa, degrees.

    Returns
    -------
    JointFile
        All numbers in mm, N, MPa and rad.

    Raises
    ------
    ValueError
        One sentence: the error, and the nearest allowed name.
    OSError
        The file cannot be read.
    """
    file = read_toml(Path(path), "joint", joint_of)
    return replace(file, report=details_in(Path(path).parent, file.report))


def parse_joint(raw: bytes, title: str) -> JointFile:
    """Convert the content of a joint file; see `read_joint`. Messages begin with `title`."""
    return parse_toml(raw, title, "joint", joint_of)


def joint_of(content: Mapping[str, Any]) -> JointFile:
    """Convert the tables of a joint file, or of the command line; see `read_joint`."""
    tables = read_table(content, JointFileTable)
    file = describe_joint(tables, name=tables.name or "", source=tables.source or "")
    load = tables.load or LoadTable()
    return replace(file, load=_load_of(load), aim=_aim_of(load), report=tables.report or NO_DETAILS)


def details_in(folder: Path, details: ReportDetails) -> ReportDetails:
    """Return the head of a report whose logo is in a folder."""
    return structs.replace(details, logo=Text(folder / details.logo)) if details.logo else details


def describe_joint(tables: JointTables, name: str = "", source: str = "") -> JointFile:
    """Create joint and cup from the tables that describe them."""
    lengths = tables.joint if isinstance(tables.joint, LengthsTable) else LengthsTable()
    liner = _material("liner", tables.liner or LinerTable())
    ball = None if tables.ball is None else _material("ball", tables.ball)
    layers = tables.backing or []
    if len(layers) > _MAX_LAYERS:
        raise ValueError(f"{len(layers)} layers are behind the liner; at most {_MAX_LAYERS} are read")
    backing: tuple[Layer, ...] = ()
    for number, layer in enumerate(layers):
        material = _material(f"backing[{number}]", layer)
        with as_given(written_in(layer), f"backing[{number}]."):
            backing += (Layer(thickness=float(layer.thickness), material=material),)
    numbers: Any = quantities_of(lengths)
    if tables.shell is not None:
        shell, numbers = _shell(tables.shell, lengths, numbers, {})
        backing = (shell, *backing)
    with as_given(written_in(lengths)):
        joint = Joint(
            **numbers,
            liner=liner,
            ball=ball,
            backing=backing,
            support=lengths.support,
            name=name,
            source=source,
            given=tuple(quantities_of(lengths)),
        )
    return JointFile(joint, {}, cup_of(tables.cup or CupTable()))


def varied(file: JointFile, content: Mapping[str, Any]) -> JointFile:
    """Replace values of a joint file by those of tables as in a joint file.

    The name of a material replaces all its numbers. A length, a load or a direction replaces the one that excludes it;
    `Joint.replace` holds the other lengths that the file gives, and names those that change.

    Raises ValueError: as of `read_joint`; keys of the tables that exclude each other; a length that would change
    another one.
    """
    tables, joint = read_table(content, JointFileTable), file.joint
    lengths, load = tables.joint or LengthsTable(), tables.load or LoadTable()
    changes: dict[str, Any] = dict(quantities_of(lengths))
    if "support" in content.get("joint", {}):
        changes["support"] = lengths.support
    if tables.shell is not None:
        present = joint.backing[0] if joint.backing else None
        if present is not None and isinf(present.thickness):
            raise ValueError("the layer behind the liner is massive; change it in the joint's file")
        shell, remaining = _shell(tables.shell, lengths, changes, joint.given_lengths, present)
        changes = {**remaining, "backing": (shell, *joint.backing[1:])}
    for part, material in (("liner", tables.liner), ("ball", tables.ball)):
        if material is not None:
            changes[part] = _material(part, material, getattr(joint, part))
    with as_given(written_in(lengths)):
        joint = joint.replace(**changes) if changes else joint
    cup = cup_of(tables.cup or CupTable(), file.cup)
    return replace(file, joint=joint, load=_load_of(load) or file.load, cup=cup, aim=_aim_of(load) or file.aim)


def _load_of(table: LoadTable) -> dict[str, float]:
    """Return at most one of force, indentation and half_angle as the keyword of a press; empty without a load."""
    load = quantities_of(table, "force", "indentation", "half_angle")
    if len(load) > 1:
        raise ValueError(f"one load is needed, got {', '.join(load)}")
    with as_given(written_in(table)):
        return dict([select_and_check_load(**load)]) if load else {}


def _aim_of(table: LoadTable) -> dict[str, Any]:
    """Return the direction of a load as the keyword of `Sphere.press`; empty for a load along the cup's axis."""
    if table.tilt is not None and table.direction is not None:
        raise ValueError("either a tilt or a direction is needed, got both")
    if table.direction is not None:
        return {"direction": tuple(table.direction)}
    if table.tilt is None:
        return {}
    tilt = float(table.tilt)
    require("tilt", degrees(tilt), 0 <= tilt <= pi, "a tilt is 0 to 180 degrees from the cup's axis")
    return {"tilt": tilt}


def cup_of(table: CupTable, base: Cup = DEFAULT_CUP) -> Cup:
    """Create a cup from its table, whose keys replace values of another cup."""
    choices = {"interface": table.interface, "side": table.side}
    changes: dict[str, Any] = {name: choice for name, choice in choices.items() if choice is not None}
    changes |= quantities_of(table, "arc_of_cover", "chamfer")
    angles = quantities_of(table, "inclination", "anteversion")
    with as_given(written_in(table)):
        if table.orientation is not None or table.pelvic_tilt is not None:
            angles = _radiographic_angles(table, angles, base)
        return replace(base, **{**changes, **angles})


def _radiographic_angles(table: CupTable, angles: Mapping[str, float], base: Cup) -> dict[str, float]:
    """Return the radiographic angles in the body of angles of another definition, or in a tilted pelvis."""
    if not angles and table.orientation is not None:
        raise ValueError(f"orientation = {table.orientation.value!r} needs an inclination and an anteversion")
    if not angles and not base.oriented:
        raise ValueError("pelvic_tilt needs the inclination and the anteversion of the cup")
    definition = table.orientation or AngleDefinition.RADIOGRAPHIC
    inclination, anteversion = base.angles(definition)
    stated = {"inclination": inclination, "anteversion": anteversion, **angles}
    tilt = 0.0 if table.pelvic_tilt is None else float(table.pelvic_tilt)
    cup = Cup.from_angles(**stated, definition=definition, pelvic_tilt=tilt)
    return {"inclination": cup.inclination, "anteversion": cup.anteversion}


def _shell(
    table: ShellTable,
    lengths: LengthsTable,
    numbers: Mapping[str, float],
    current: Mapping[str, Any],
    present: Layer | None = None,
) -> tuple[Layer, dict[str, float]]:
    """Create the shell of a joint, and return it with the lengths in mm that remain to define the joint.

    Without a thickness of the shell, an outer dimension and the thickness of the liner determine it, if both are given;
    else it is that of the `present` shell.

    Raises ValueError: a thickness that is missing, or an outer dimension that leaves no shell.
    """
    material = _material("shell", table, None if present is None else present.material)
    remaining = dict(numbers)
    outer = next((key for key in ("outer_diameter", "outer_radius") if key in remaining), "")
    if table.thickness is not None:
        thickness = float(table.thickness)
    elif present is not None and not (outer and "liner_thickness" in remaining):
        thickness = float(present.thickness)
    else:
        share = 2 if outer == "outer_diameter" else 1
        if not outer:
            raise ValueError(
                "the thickness of the shell is missing: state it, or outer_diameter and liner_thickness, which leave it"
            )
        if "liner_thickness" not in remaining and not current:
            raise ValueError(f"liner_thickness is missing: {outer} alone does not tell liner and shell apart")
        radius = remaining.pop(outer) / share
        held = {name: length for name, length in current.items() if canonical(name) != "outer_radius"}
        with as_given(written_in(lengths)):
            stored = resolve_lengths(remaining, held, 0.0)
        inner = stored["ball_radius"] + stored["clearance"] + stored["liner_thickness"]
        thickness = round(radius - inner, 12)
        remaining |= {name: stored[name] for name in STORED_LENGTHS} if current else {}
        if not thickness > 0:
            raise ValueError(
                f"{outer} = {shown(getattr(lengths, outer).written)} is not allowed: ball, clearance and liner take "
                f"{inner * share:g} mm, which leaves no shell"
            )
    with as_given(written_in(table), "shell."):
        return Layer(thickness=thickness, material=material), remaining


def _material(name: str, table: MaterialTable, present: Material | None = None) -> Material:
    """Create a material from a preset, from numbers that win over its own, or from the present material."""
    numbers: Any = quantities_of(table, *(key for key in MaterialTable.__struct_fields__ if key != "material"))
    if isinstance(table, LinerTable) and table.hardening is not None:
        numbers["hardening"] = table.hardening.value
    preset = present if table.material is None else named_material(name, table.material)
    missing = [key for key in ("young", "poisson") if key not in numbers]
    if missing and preset is None:
        raise ValueError(f"the {name} needs a material, or young and poisson; missing: {', '.join(missing)}")
    with as_given(written_in(table), f"{name}."):
        return replace(preset, **numbers) if preset else Material(**numbers)


_PARTS = ("liner", "ball", "shell", "backing", "cup")  # tables that describe a joint together with [joint]


def joint_in(tables: JointTables, folder: Path) -> JointFile:
    """Create the joint of a file from its tables, or read it by its name.

    `joint` is a table, or the name of a preset or of a joint file in the folder; then no other table describes it.

    Raises ValueError: one sentence: the error, and the nearest allowed name.
    Raises OSError: a joint file cannot be read.
    """
    if tables.joint is None:
        raise ValueError("a joint is needed: a joint file, a preset's name, or a table [joint]")
    if not isinstance(tables.joint, str):
        return describe_joint(tables)
    described = [part for part in _PARTS if getattr(tables, part) is not None]
    if described:
        name = shown(tables.joint)
        raise ValueError(f"joint = {name} is a whole joint: [{described[0]}] belongs to a table [joint]")
    return named_joint(check_text("joint", tables.joint), folder)


def named_joint(name: str, folder: Path = Path()) -> JointFile:
    """Return the joint of a file in a folder, or the preset of that name.

    Raises ValueError: no such file or preset.
    """
    if not name:
        raise ValueError("the joint's name is empty")
    path = resolve_input(folder / name)
    if path.exists() and not path.is_dir():
        return read_joint(path)
    if normalise_name(name) in joints:
        return JointFile(joints[normalise_name(name)], {})
    if path.is_dir():
        raise ValueError(f"{shown(name)} is a folder; a joint file is needed")
    if not path.parent.is_dir():
        raise ValueError(f"{shown(name)} does not exist: there is no folder {str(path.parent)!r}")
    raise ValueError(f"{shown(name)} is neither a file nor a preset{nearest(name, joints)}")
