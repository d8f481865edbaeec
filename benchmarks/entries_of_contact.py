"""Results of the public entries that press a joint, for `benchmarks.identical`.

A function here records the room that it is named after. It calls only public names: `ballsocket` and its doors, and the
command line with `--json`. So modules can move, and private names can change. Random numbers have fixed seeds. Meshes
and rings are as coarse as they can be.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from math import inf, pi, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

import ballsocket as bs

if TYPE_CHECKING:
    from .identical import Results

EXAMPLES = Path(__file__).parents[1] / "examples"
SEED = 25

CONTACT = (
    "force indentation half_angle max_pressure max_pressure_angle pole_pressure area stiffness energy "
    "foundation_modulus pressure_integral von_mises utilisation conformity valid status notes"
)
RATIOS = "indentation_ratio depth_ratio width_ratio utilisation_note"
ANGLES = numpy.radians([0.0, 5.0, 20.0, 35.0, 50.0, 80.0])
HIP = bs.joints["hip-28"]
SHELL = bs.Layer(thickness=3.0, material=bs.TITANIUM)
BONE = bs.Layer(thickness=inf, material=bs.CANCELLOUS_BONE)

SPECIAL_JOINTS: Mapping[str, bs.Joint] = {
    "rigid ball": bs.Joint(ball_radius=16.0, clearance=0.05, liner_thickness=7.0, liner=bs.CROSSLINKED_PE),
    "shell": HIP.replace(backing=(SHELL,)),
    "shell in bone": HIP.replace(backing=(SHELL, BONE)),
    "cement in bone": HIP.replace(backing=(bs.Layer(thickness=2.0, material=bs.BONE_CEMENT), BONE)),
    "free support": HIP.replace(support=bs.Support.FREE, liner_thickness=9.0),
    "infinite liner": HIP.replace(liner_thickness=inf),
    "no clearance": HIP.replace(clearance=0.0),
    "soft ball": HIP.replace(ball=bs.POM),
    "wide": HIP.replace(clearance=0.6),
    "incompressible": HIP.replace(liner=bs.Material(young=12.0, poisson=0.499, yield_stress=3.0)),
}
"""Joints unlike those of the presets."""


def random_joints(count: int) -> dict[str, bs.Joint]:
    """Draw joints over decades of their numbers."""
    random = numpy.random.default_rng(SEED)
    joints = {}
    for number in range(count):
        radius = float(10 ** random.uniform(0.5, 2.0))
        ball = bs.Material(young=float(10 ** random.uniform(3.5, 5.5)), poisson=float(random.uniform(0.1, 0.45)))
        joints[f"random {number}"] = bs.Joint(
            ball_radius=radius,
            clearance=radius * float(10 ** random.uniform(-3.5, -1.7)),
            liner_thickness=radius * float(10 ** random.uniform(-1.0, 0.5)),
            liner=bs.Material(young=float(10 ** random.uniform(1.0, 4.0)), poisson=float(random.uniform(0.05, 0.48))),
            ball=ball if number % 3 else None,
        )
    return joints


def array_joint(count: int = 12) -> bs.Joint:
    """Draw joints of usual sizes, as one joint of arrays."""
    random = numpy.random.default_rng(SEED + 1)
    return bs.Joint(
        ball_radius=random.uniform(11.0, 23.0, count),
        clearance=random.uniform(0.02, 0.3, count),
        liner_thickness=random.uniform(3.0, 15.0, count),
        liner=bs.Material(young=random.uniform(400.0, 3000.0, count), poisson=random.uniform(0.3, 0.47, count)),
        ball=bs.COCR,
    )


def loads_of(joint: bs.Joint) -> dict[str, dict[str, Any]]:
    """Choose loads of each kind for a joint: plain numbers, and arrays of them."""
    stiffness = float(joint.liner.young * joint.ball_radius**2)
    depth = float(joint.clearance) or 0.05
    return {
        "force": {"force": 1e-2 * stiffness},
        "forces": {"force": stiffness * numpy.array([0.0, 1e-5, 1e-3, 0.1])},
        "indentation": {"indentation": 0.4 * depth},
        "indentations": {"indentation": depth * numpy.array([0.02, 1.0, 20.0])},
        "half angle": {"half_angle": 0.7},
        "half angles": {"half_angle": numpy.array([0.1, 1.2, 1.5])},
    }


def add_contact(results: Results, name: str, model: Any, joint: bs.Joint, **load: Any) -> Any:
    """Press a joint and add what the contact answers; return the contact, None after an exception."""
    with results.attempt(name):
        contact = model.press(joint, **load)
        results.add_attributes(name, contact, CONTACT)
        with results.attempt(f"{name}/pressure"):
            angles = ANGLES.reshape(-1, *(1 for _ in numpy.shape(contact.indentation)))
            results.add(f"{name}/pressure", contact.pressure(angles))
        return contact
    return None


class PowerLaw(bs.ClosedForm):
    """A custom closed form: F ~ d^1.5."""

    name = "power-law"
    title = "a power of the indentation"
    sources = ()
    validity = ()

    def force(self, joint: bs.Joint, indentation: Any) -> Any:
        return joint.liner.young * joint.ball_radius**0.5 * indentation**1.5

    def stiffness(self, joint: bs.Joint, indentation: Any) -> Any:
        return 1.5 * joint.liner.young * (joint.ball_radius * indentation) ** 0.5

    def energy(self, joint: bs.Joint, indentation: Any) -> Any:
        return 0.4 * self.force(joint, indentation) * indentation

    def half_angle(self, joint: bs.Joint, indentation: Any) -> Any:
        return (indentation / joint.ball_radius) ** 0.5

    def indentation_of_half_angle(self, joint: bs.Joint, half_angle: Any) -> Any:
        return joint.ball_radius * half_angle**2

    def pole_pressure(self, joint: bs.Joint, indentation: Any) -> Any:
        return joint.liner.young * self.half_angle(joint, indentation)

    def pressure(self, joint: bs.Joint, indentation: Any, angle: Any) -> Any:
        squares = (indentation / joint.ball_radius - angle * angle) * joint.liner.young**2
        return numpy.maximum(squares, 0.0) ** 0.5


def contact(results: Results, folder: Path) -> None:
    """Record joints, cups, files, and the derived quantities of contacts."""
    for name, material in bs.materials.items():
        results.add(f"material/{name}", material.summary())
    joints = {**bs.joints, **SPECIAL_JOINTS}
    for name, joint in joints.items():
        results.add(f"joint/{name}", joint.summary())
        lengths = "outer_radius head_diameter diametral_clearance"
        ratios = "thickness_ratio clearance_ratio modulus_ratio backing_ratio effective_modulus"
        results.add_attributes(f"joint/{name}", joint, f"{lengths} {ratios}")
    for name, joint in joints.items():
        pressed = add_contact(results, f"press/{name}", bs.HessForsbach(), joint, force=2500.0)
        if pressed is not None:
            _derived(results, f"press/{name}", pressed)
    _derived(results, "press/arrays", bs.Refined().press(array_joint(), force=numpy.array([[1e3], [4e3]])))
    for name in ("hess-forsbach", "hip-36", "tilting-pad-pivot"):
        with results.attempt(f"compare/{name}"):
            comparison = bs.compare(bs.joints[name], force=3000.0)
            results.add(f"compare/{name}", comparison.summary())
            results.add(f"compare/{name}/sources", bs.cite(*(bs.catalogue[model] for model in comparison)))
    for path in sorted(EXAMPLES.glob("*hip.toml")):
        with results.attempt(f"file/{path.name}"):
            file = bs.read_joint(path)
            results.add(f"file/{path.name}", {"joint": file.joint.summary(), "load": file.load, "dome": file.cup.dome})
    for inclination, anteversion, side in product((0.0, 0.7, 1.2), (-0.3, 0.0, 0.4), bs.Side):
        cup = bs.Cup(arc_of_cover=2.8, inclination=inclination, anteversion=anteversion, side=side)
        name = f"cup/{inclination} {anteversion} {side.value}"
        results.add_attributes(name, cup, "rim opening dome frame oriented")
        for direction in ((0.0, 0.0, 1.0), (-0.2, 0.1, 1.0)):
            aimed = f"{name}/{direction}"
            results.add(f"{aimed}/tilt", cup.tilt(direction))
            results.add(f"{aimed}/edge", cup.edge_distance(14.1, 0.6, direction))
    for gap in (bs.LinearGap, bs.CircularGap):
        shape = gap(clearance=0.1, socket_radius=14.1)
        for name in ("displacement", "transform", "slope", "indentation_derivative"):
            results.add(f"gap/{gap.__name__}/{name}", getattr(shape, name)(ANGLES, numpy.full(ANGLES.shape, 0.05)))


def _derived(results: Results, name: str, pressed: Any) -> None:
    """Add what is computed from a contact."""
    results.add_attributes(name, pressed, RATIOS)
    results.add(f"{name}/summary", pressed.summary())
    results.add(f"{name}/text", repr(pressed))
    for axis in (0.0, 0.5, pi / 2):
        with results.attempt(f"{name}/torque {axis}"):
            results.add(f"{name}/torque {axis}", pressed.friction_torque(0.06, axis))
    with results.attempt(f"{name}/pressure at"):
        results.add(f"{name}/pressure at", pressed.pressure_at(numpy.array([0.6, 0.0, 0.8])))


def models(results: Results, folder: Path) -> None:
    """Record every model of the catalogue on many joints, by every kind of load."""
    joints = {**bs.joints, **SPECIAL_JOINTS, **random_joints(8)}
    for name, model in bs.catalogue.items():
        for title, joint in joints.items():
            for load, values in loads_of(joint).items():
                add_contact(results, f"{name}/{title}/{load}", model, joint, **values)
        add_contact(results, f"{name}/arrays", model, array_joint(), force=3000.0)
        with results.attempt(f"{name}/vector"):
            places = numpy.array([[0.0, 0.0, 0.15], [0.1, -0.05, 0.1], [0.02, 0.0, 0.0]])
            results.add(f"{name}/vector", model.force_vector(HIP, places))
        with results.attempt(f"{name}/law"):
            law = model.law(HIP)
            results.add(f"{name}/law", [law(depth) for depth in (-0.1, 0.0, 1e-6, 1e-3, 0.03, 0.1, 0.5, 20.0)])
    for modulus, kinematics in product(_MODULI, (bs.linear_kinematics, bs.exact_kinematics, bs.cosine_kinematics)):
        springs = bs.RadialFoundation(modulus=modulus, kinematics=kinematics)
        for load, values in loads_of(HIP).items():
            add_contact(results, f"springs/{springs.name}/{load}", springs, HIP, **values)
    for modulus in _MODULI:
        results.add(f"modulus/{modulus.name}", [modulus(bs.joints[name]) for name in ("hip-22", "hip-28", "hip-36")])
    for load, values in loads_of(HIP).items():
        add_contact(results, f"custom/{load}", PowerLaw(), HIP, **values)
        covered = bs.Tabulated().in_cup(bs.Cup(arc_of_cover=2.4, inclination=0.5))
        add_contact(results, f"covered/{load}", covered, HIP, **values)
    for work in (0.0, 1e-4, 2e-3):
        sticky = bs.AdhesiveSocket(work_of_adhesion=work)
        for name in ("critical_stretch", "adhesion_number", "pull_off"):
            results.add(f"adhesion/{work}/{name}", getattr(sticky, name)(HIP))
        add_contact(results, f"adhesion/{work}", sticky, HIP, force=numpy.array([0.0, 10.0, 1000.0]))
    for kind, size in (("line_load", 30.0), ("line_load", 900.0), ("half_angle", 0.1), ("half_angle", 1.2)):
        with results.attempt(f"pin/{kind} {size}"):
            pressed = bs.PinInHole().press(bs.joints["tilting-pad-pivot"], **{kind: size})
            attributes = "line_load half_angle max_pressure valid status notes"
            results.add_attributes(f"pin/{kind} {size}", pressed, attributes)
            results.add(f"pin/{kind} {size}/pressure", pressed.pressure(ANGLES))
    with results.attempt("compiled"):
        from ballsocket.compiled import Compiled

        forces = numpy.linspace(100.0, 4000.0, 12)
        for model in (bs.HessForsbach(), bs.Bartel(), bs.Tabulated()):
            fast = Compiled(model=model)
            add_contact(results, f"compiled/{model.name}/force", fast, array_joint(), force=forces)
            add_contact(results, f"compiled/{model.name}/indentation", fast, array_joint(), indentation=1e-5 * forces)


_MODULI = (
    *(bs.hess_forsbach, bs.spherical_vessel, bs.bonded_layer, bs.constant(250.0), bs.polynomial(0.8, 1.4, 0.06)),
    bs.corrected_vessel(1.0, -0.5, 0.2),
)


def exact(results: Results, folder: Path) -> None:
    """Record the exact solution: its stresses, displacements, errors and curves."""
    joints = {**bs.joints, **SPECIAL_JOINTS, **random_joints(6)}
    settings = {"linear": bs.Exact(), "circular": bs.Exact(gap=bs.CircularGap), "coarse": bs.Exact(tolerance=1e-3)}
    for (setting, model), (title, joint) in product(settings.items(), joints.items()):
        name = f"{setting}/{title}"
        pressed = add_contact(results, name, model, joint, half_angle=0.6)
        if pressed is not None and setting == "linear":
            results.add_attributes(name, pressed, "error hemisphere")
            _inside(results, name, pressed)
    for title in ("hip-28", "shell", "free support", "random 1"):
        joint = joints[title]
        for load, values in loads_of(joint).items():
            add_contact(results, f"curve/{title}/{load}", bs.ExactCurve(), joint, **values)
    add_contact(results, "tabulated", bs.Tabulated(), array_joint(40), force=numpy.linspace(100.0, 5000.0, 40))


def _inside(results: Results, name: str, pressed: Any) -> None:
    """Add displacements and stresses of a contact."""
    with results.attempt(f"{name}/displacement"):
        results.add(f"{name}/displacement", pressed.displacement(ANGLES))
    with results.attempt(f"{name}/stress"):
        stress = pressed.stress(ANGLES[:, None], numpy.array([0.0, 0.4, 2.0]))
        results.add_attributes(f"{name}/stress", stress, "radial meridional hoop shear von_mises principal")
    with results.attempt(f"{name}/peak"):
        results.add_attributes(f"{name}/peak", pressed.peak_stress, "von_mises depth angle")


def finite_elements(results: Results, folder: Path) -> None:
    """Record finite elements on coarse meshes."""
    coarse: dict[str, Any] = {"spacing": bs.Adapted(elements=24), "meshes": 1}
    cups = {
        "hemisphere": bs.Cup(),
        "open": bs.Cup(arc_of_cover=radians(150.0), chamfer=1.0),
        "sliding": bs.Cup(arc_of_cover=radians(160.0), interface=bs.Interface.SLIDING),
    }
    joints = {name: SPECIAL_JOINTS[name] for name in ("rigid ball", "shell", "soft ball")}
    for (title, cup), (name, joint) in product(cups.items(), {"hip": HIP, **joints}.items()):
        model = bs.FiniteElement(cup=cup, **coarse)
        _meshed(results, f"{title}/{name}", add_contact(results, f"{title}/{name}", model, joint, force=2500.0))
    variants = {
        "bilinear": bs.FiniteElement(element=bs.Element.BILINEAR, **coarse),
        "circular": bs.FiniteElement(gap=bs.CircularGap, **coarse),
        "uniform": bs.FiniteElement(spacing=bs.Uniform(size=0.7), meshes=1),
        "two meshes": bs.FiniteElement(spacing=bs.Adapted(elements=24)),
        "narrow": bs.FiniteElement(cup=bs.Cup(arc_of_cover=radians(60.0)), **coarse),
    }
    for name, model in variants.items():
        _meshed(results, name, add_contact(results, name, model, HIP, force=3000.0))
    add_contact(results, "default", bs.FiniteElement(), bs.joints["hip-32"], force=2500.0)
    for load, values in {"indentation": {"indentation": 0.03}, "half angle": {"half_angle": 0.5}}.items():
        add_contact(results, load, variants["circular"], HIP, **values)
    add_contact(results, "forces", bs.FiniteElement(**coarse), HIP, force=numpy.array([0.0, 500.0, 1500.0, 4000.0]))


def _meshed(results: Results, name: str, pressed: Any) -> None:
    """Add what finite elements know of both bodies."""
    with results.attempt(f"{name}/mesh"):
        results.add_attributes(name, pressed, "error rim_displacement")
        results.add_attributes(f"{name}/peak", pressed.peak_stress, "von_mises depth angle")
        results.add(f"{name}/mesh", pressed.mesh.summary())
        liner = pressed.section["liner"]
        results.add(f"{name}/liner/von_mises", liner.stress.von_mises.ravel()[::97])
        results.add(f"{name}/liner/angle", numpy.ravel(liner.angle)[::97])


def off_axis(results: Results, folder: Path) -> None:
    """Record contacts on the sphere, in wide rings."""
    wide = radians(6.0)
    cup = bs.Cup(arc_of_cover=radians(165.0), inclination=radians(45.0), anteversion=radians(12.0))
    table = bs.DepthTable(
        polar=numpy.array([0.0, 0.8, 1.6]),
        azimuth=numpy.linspace(0.0, 5.0, 6),
        values=0.02 * numpy.random.default_rng(SEED).random((3, 6)),
    )
    settings = {
        "cup": bs.Sphere(cup=cup, ring_width=wide),
        "chamfer": bs.Sphere(cup=replace(cup, chamfer=1.5), ring_width=wide),
        "closed": bs.Sphere(cup=cup, surface=bs.ClosedShell(), ring_width=wide),
        "springs": bs.Sphere(cup=cup, surface=bs.Springs(), ring_width=wide),
        "circular": bs.Sphere(cup=cup, gap=bs.CircularGap, ring_width=wide),
        "worn": bs.Sphere(
            cup=cup, worn=bs.BoreDeviation(of=lambda n: 0.03 * n[0] ** 2 + 0.01 * n[1] * n[2]), ring_width=wide
        ),
        "pinched": bs.Sphere(cup=cup, worn=bs.OvalBore(squeeze=0.06, direction=0.4), ring_width=wide),
        "table": bs.Sphere(cup=cup, worn=table, ring_width=wide),
        "left": bs.Sphere(cup=replace(cup, side=bs.Side.LEFT), ring_width=wide),
    }
    joint = bs.joints["hip-36"]
    for name, model in settings.items():
        _tilted(results, f"{name}/upright", add_contact(results, f"{name}/upright", model, joint, force=2500.0))
        aims: dict[str, dict[str, Any]] = {
            "direction": {"force": 3000.0, "direction": (-0.3, 0.1, 0.95)},
            "tilt": {"force": 3000.0, "tilt": radians(62.0), "azimuth": 0.5},
            "indentation": {"indentation": 0.05, "tilt": radians(30.0)},
            "half angle": {"half_angle": 0.5, "tilt": 0.2},
            "displacement": {"displacement": numpy.array([[0.1, 0.0, 0.1], [0.3, 0.1, -0.2], [0.02, 0.0, 0.01]])},
            "tilts": {"force": 2000.0, "tilt": numpy.radians([0.0, 35.0, 70.0, 100.0])},
        }
        for title, aim in aims.items():
            _tilted(results, f"{name}/{title}", add_contact(results, f"{name}/{title}", model, joint, **aim))
    for title in ("shell in bone", "soft ball", "rigid ball"):
        name = f"joints/{title}"
        _tilted(results, name, add_contact(results, name, settings["cup"], SPECIAL_JOINTS[title], force=2e3, tilt=0.6))
    tight = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    fitted = bs.Preload(model=bs.Sphere(cup=bs.Cup(arc_of_cover=radians(300.0)), ring_width=wide), joint=tight)
    with results.attempt("preload"):
        _tilted(results, "preload/rest", fitted.equilibrium)
        results.add_attributes("preload/rest", fitted.equilibrium, CONTACT)
        _tilted(results, "preload/displaced", fitted.displace(numpy.array([[0.01, 0.0, 0.0], [0.0, 0.02, 0.01]])))
        results.add(
            "preload/lost", [fitted.separation_displacement(way) for way in ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0))]
        )
        results.add("preload/worn out", fitted.wear_depth_to_loosen())
    with results.attempt("orient"):
        angles: dict[str, Any] = {
            "inclination": numpy.radians([35.0, 50.0, 65.0]),
            "anteversion": numpy.radians([0.0, 20.0]),
        }
        stood = bs.orient(joint, model=replace(settings["cup"], direction=(-0.2, 0.0, 1.0)), force=3000.0, **angles)
        results.add("orient", stood.summary())
    scan = bs.read_scan(_scan(folder / "bore.stl"))
    results.add_attributes("scan", scan, "radius centre axis reach roughness")
    settings["scan"] = replace(settings["cup"], worn=scan)
    _tilted(results, "scan/press", add_contact(results, "scan/press", settings["scan"], joint, force=2e3, tilt=0.4))
    finer = replace(settings["cup"], ring_width=radians(2.5))
    _tilted(results, "finer", add_contact(results, "finer", finer, joint, force=3000.0, tilt=0.8))
    directions = numpy.random.default_rng(SEED).normal(size=(3, 20))
    for name in ("worn", "pinched", "table", "scan"):
        shape: Any = settings[name].worn
        results.add(f"{name}/depth", shape.depth(directions / numpy.linalg.norm(directions, axis=0)))


def _scan(path: Path) -> Path:
    """Write a bore with a pit as a mesh of triangles."""
    polar, azimuth = numpy.meshgrid(numpy.radians(numpy.linspace(0.5, 85.0, 30)), numpy.linspace(0.0, 2 * pi, 49))
    points = numpy.stack(
        [numpy.sin(polar) * numpy.cos(azimuth), numpy.sin(polar) * numpy.sin(azimuth), numpy.cos(polar)]
    )
    points = numpy.moveaxis((18.1 + 0.04 * numpy.exp(-10.0 * polar**2)) * points, 0, -1)
    here, right, below, across = points[:-1, :-1], points[1:, :-1], points[:-1, 1:], points[1:, 1:]
    corners = numpy.concatenate(
        [numpy.stack([here, right, below], axis=2), numpy.stack([right, across, below], axis=2)]
    )
    facets = (
        "facet normal 0 0 1\nouter loop\n"
        + "".join("vertex {:.9g} {:.9g} {:.9g}\n".format(*corner) for corner in triangle)
        + "endloop\nendfacet\n"
        for triangle in corners.reshape(-1, 3, 3).tolist()
    )
    path.write_text(f"solid bore\n{''.join(facets)}endsolid bore\n", encoding="utf-8")
    return path


def _tilted(results: Results, name: str, pressed: Any) -> None:
    """Add what a contact on the sphere knows besides."""
    vectors = "force_vector displacement moment stiffness_matrix max_pressure_at"
    if pressed is not None:
        results.add_attributes(f"{name}/cup", pressed, f"{vectors} edge_loaded edge_margin edge_distance rim_distance")
        results.add_attributes(f"{name}/cup", pressed, "tilt error")
        results.add(f"{name}/summary", pressed.summary())
        if numpy.ndim(pressed.indentation) == 0 and not pressed.status.failed:
            polar, azimuth, pressure = pressed.pressure_map
            results.add(f"{name}/cup/map", pressure[:: max(1, len(polar) // 8), :: max(1, len(azimuth) // 8)])
            results.add(f"{name}/cup/at", pressed.pressure_at((0.3, 0.2, 0.8)))
