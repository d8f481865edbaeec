"""Results of the public entries for motion, wear and other programs, for `benchmarks.identical`.

A function here records the room that it is named after, as in `entries_of_contact`.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

import ballsocket as bs
from ballsocket import dynamics as motion
from ballsocket import hip as wear
from ballsocket import studies as design
from ballsocket.export import TARGETS, CElement, ExportJob

from .entries_of_contact import HIP, SEED, SPECIAL_JOINTS
from .entries_of_questions import add_command, add_program, add_table

if TYPE_CHECKING:
    from .identical import Results

LOAD = (
    "force moment socket_force socket_moment energy dissipation indentation attached half_angle max_pressure tangent "
    "damping_matrix deflection_rate status notes"
)
JOINT = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
WALK = wear.iso_14242_1(24)
ARCHARD = wear.Archard(coefficient=1.066e-6)
MACHINES = (
    *("iso-14242-1", "iso-14242-1-key-points", "iso-14242-4", "flexion", "biaxial-rocking", "two-axis"),
    "constant-load",
)
IN_VIVO = (
    *("walking", "one-leg-stance", "stand-up", "average-walking", "stairs-up", "stairs-down", "jogging", "stumbling"),
)
CUP = bs.Cup(arc_of_cover=radians(170.0), inclination=radians(40.0), anteversion=radians(15.0))


def elements() -> dict[str, bs.ForceElement]:
    """Make force elements of every kind."""
    damping, friction = motion.Flores(restitution=0.8, impact_speed=100.0), motion.Friction(coefficient=0.05)
    stribeck = motion.Friction(coefficient=0.05, static_coefficient=0.12, stribeck_speed=3.0, viscous=1e-4)
    bristles = motion.Bristles(coefficient=0.06, static_coefficient=0.1, stiffness=80.0, damping=1e-3, viscous=1e-5)
    return {
        "springs": bs.ForceElement(bs.HessForsbach(), HIP),
        "curve": bs.ForceElement(bs.Tabulated(), HIP, damping=damping, friction=friction),
        "exact": bs.ForceElement(bs.Exact(), SPECIAL_JOINTS["shell"], friction=stribeck),
        "retarded": bs.ForceElement(bs.Bartel(), HIP, damping=motion.Damping(hysteresis=2e-3, time=1e-4)),
        "cup": bs.ForceElement(bs.HessForsbach(), HIP, damping=damping, friction=friction, cup=CUP),
        "smooth": bs.ForceElement(bs.Refined(), HIP, friction=friction, smoothing=0.01),
        "bristles": bs.ForceElement(bs.HessForsbach(), HIP, damping=damping, friction=bristles),
        "sticky": bs.ForceElement(bs.AdhesiveSocket(work_of_adhesion=2e-3), HIP, damping=damping),
    }


def dynamics(results: Results, folder: Path) -> None:
    """Record force elements, motions, restitution and relaxing liners."""
    random = numpy.random.default_rng(SEED)
    directions = random.normal(size=(24, 3))
    directions /= numpy.linalg.norm(directions, axis=1)[:, None]
    distance = 0.1 + numpy.concatenate([[-0.05, -0.005, 0.0, 0.005, 2.0, 30.0], random.uniform(0.01, 0.2, 18)])
    state = directions * distance[:, None], random.normal(0.0, 40.0, (24, 3)), random.normal(0.0, 5.0, (24, 3))
    bent = random.normal(0.0, 1e-3, (24, 4))
    for name, element in elements().items():
        with results.attempt(f"load/{name}"):
            results.add_attributes(f"load/{name}", element(*state, deflection=bent, attached=True), LOAD)
        for number in (3, 8, 15):
            with results.attempt(f"load/{name}/{number}"):
                load = element(*(tuple(part[number].tolist()) for part in (*state, bent)))
                results.add_attributes(f"load/{name}/{number}", load, LOAD)
                results.add(f"load/{name}/{number}/summary", load.summary())
        results.add_attributes(f"load/{name}", element, "wall stretch")
        with results.attempt(f"motion/{name}"):
            _motion(results, f"motion/{name}", element, 0.002 if name in ("bristles", "sticky") else 0.006)
    with results.attempt("compiled"):
        from ballsocket.dynamics.compiled import CompiledElement

        for name in ("springs", "curve", "cup"):
            fast = CompiledElement(elements()[name])
            many = (numpy.tile(part, (12, 1)) for part in state)
            results.add(f"compiled/{name}", [part[::7].ravel() for part in fast.loads(*many)])
            if name == "curve":
                _motion(results, f"compiled/{name}/motion", fast, 0.006)
    _losses(results)
    _relaxing(results)


def _motion(results: Results, name: str, element: Any, duration: float) -> None:
    """Add a ball that is thrown into its socket, under its weight."""
    thrown: dict[str, Any] = {"position": (0.02, 0.05, 0.03), "velocity": (30.0, 50.0, 150.0), "spin": (1.0, -2.0, 3.0)}
    moved = motion.simulate(element, mass=1.0, **thrown, pull=(0.0, 100.0, -9.81), duration=duration, step=2e-5)
    results.add(f"{name}/summary", moved.summary())
    for part in (
        "position",
        "velocity",
        "spin",
        "energy",
        "dissipated_energy",
        "work",
        "kinetic_energy",
        "total_energy",
        "indentation",
    ):
        results.add(f"{name}/{part}", getattr(moved, part)[::20])


def _losses(results: Results) -> None:
    """Add coefficients of restitution, and damping from measurements."""
    for relation in motion.relations.relations:
        for kept in (1.0, 0.99999, 0.95, 0.6, 0.2):
            damping = relation.damping(kept)
            name = f"restitution/{relation.name}/{kept}"
            results.add(name, [damping, motion.relations.restitution_of(damping)])
    for name in ("HuntCrossley", "LankaraniNikravesh", "Flores", "Gonthier", "Restitution"):
        damping = getattr(motion, name)(restitution=0.7, impact_speed=80.0)
        results.add(f"damping/{name}", [damping.hysteresis, damping.restitution(40.0)])
    fits = {
        "restitution": motion.from_restitution(speed=[20.0, 40.0, 80.0], restitution=[0.951, 0.902, 0.822]),
        "known": motion.from_restitution(speed=[20.0, 80.0], restitution=[0.95, 0.82], uncertainty=0.01),
        "bounces": motion.from_bounces(times=[0.1, 0.29, 0.46, 0.615]),
    }
    for name, fit in fits.items():
        results.add(f"drop test/{name}/hysteresis", fit.damping.hysteresis)
        results.add_attributes(f"drop test/{name}", fit, "error noise residuals speed restitution")


def _relaxing(results: Results) -> None:
    """Add liners that relax."""
    prony = motion.Prony(terms=((0.3, 0.1), (0.2, 10.0)))
    times = numpy.array([0.0, 0.05, 1.0, 30.0])
    results.add("prony", [prony.relaxation(times), prony.creep_compliance(times), prony.long_term_share + 0 * times])
    results.add("prony/complex", prony.complex_modulus(times))
    time = numpy.linspace(0.0, 1.0, 61)
    depth = 0.05 * numpy.sin(numpy.pi * time)
    for model in (bs.HessForsbach(), bs.Tabulated()):
        liner = motion.Viscoelastic(model, HIP, prony)
        with results.attempt(f"viscoelastic/{model.name}/springs twice"):
            results.add(
                f"viscoelastic/{model.name}/springs twice", liner.spring_force(time, 0.04 * numpy.sin(12.0 * time))
            )
        forces = {
            "springs": liner.spring_force,
            "pressed": liner.cycle_force,
            "grown": liner.hereditary_force,
            "product": liner.separable_force,
        }
        for name, force in forces.items():
            with results.attempt(f"viscoelastic/{model.name}/{name}"):
                results.add(f"viscoelastic/{model.name}/{name}", force(time, depth))
        results.add(f"viscoelastic/{model.name}/at once", liner.instantaneous_force(depth[:20]))
        results.add(f"viscoelastic/{model.name}/relaxing", liner.relaxation_force(0.04, times))
        results.add(f"viscoelastic/{model.name}/creeping", liner.creep_indentation(2000.0, times))
        results.add(f"viscoelastic/{model.name}/stiffness", liner.dynamic_stiffness(0.04, times))


def in_use(**changes: Any) -> wear.HipSimulation:
    """Make a hip in use of wide rings and few instants."""
    usual = wear.HipSimulation(
        joint=JOINT, cup=bs.Cup(inclination=0.5), cycle=WALK, wear=ARCHARD, ring_width=radians(8.0)
    )
    return replace(usual, **changes)


def hips() -> dict[str, wear.HipSimulation]:
    """Make hips in use of every law, contact and kind of cycle."""
    mixed = wear.Mix(
        activities=(
            wear.Activity(cycle=WALK, per_year=1e6),
            wear.Activity(cycle=wear.in_vivo("stairs-up", 800.0, 16), per_year=5e4),
            wear.Activity(cycle=wear.flexion(12), per_year=2e4),
        )
    )

    def lean(phases: numpy.ndarray) -> numpy.ndarray:
        return numpy.stack([60 + 0 * phases, 100 * phases, WALK.force(phases)])

    lifted = replace(WALK, force=lambda phases: 1500.0 * numpy.sin(2 * numpy.pi * phases))
    ladder = wear.KelvinVoigtChain(
        compliances=(1e-3, 2e-3), times=(60.0, 3600.0), confinement=wear.constrained_share(0.4)
    )
    hard = bs.Joint(ball_radius=18.0, clearance=0.05, liner_thickness=5.0, liner=bs.ALUMINA, ball=bs.ALUMINA_COMPOSITE)
    few: dict[str, Any] = {"ring_width": radians(6.0), "cycle": wear.iso_14242_1(12)}
    steep = bs.Cup(arc_of_cover=radians(160.0), inclination=radians(55.0), anteversion=radians(10.0))
    return {
        "archard": in_use(),
        "energy": in_use(wear=wear.FrictionEnergyWear(coefficient=2e-5, friction=0.06)),
        "area": in_use(wear=wear.ContactAreaWear(coefficient=2e-12)),
        "cross-shear": in_use(wear=wear.CrossShear(straight=2e-7, circular=2e-6, exponent=-0.3, reference=2.0)),
        "own": in_use(wear=wear.CustomWearLaw(function=lambda cycle: 1e-9 * (1.0 + cycle.cross_shear) * cycle.work)),
        "creep": in_use(creep=wear.logarithmic()),
        "ladder": in_use(creep=ladder, seconds_per_cycle=2.0),
        "both wear": in_use(joint=hard, ball_wear=wear.Archard(coefficient=3e-8), wear=wear.Archard(coefficient=5e-8)),
        "mix": in_use(cycle=mixed),
        "left": in_use(cycle=replace(WALK, force=lean), cup=replace(CUP, side=bs.Side.LEFT)),
        "standard tilt": in_use(cup=bs.Cup()),
        "steep": in_use(cup=steep, cycle=wear.in_vivo("walking", 900.0, 20)),
        "lifted": in_use(cycle=lifted),
        "separated": in_use(cycle=wear.iso_14242_4(40), cup=steep),
        "bonded layer": in_use(surface=bs.Springs(modulus=bs.bonded_layer)),
        "shell": in_use(surface=bs.ClosedShell(), **few),
        "cup": in_use(surface=bs.RealCup(), **few),
        "chamfered cup": in_use(surface=bs.RealCup(), cup=replace(steep, chamfer=1.0, inclination=0.4), **few),
        "separated in cup": in_use(surface=bs.RealCup(), cup=steep, **(few | {"cycle": wear.iso_14242_4(20)})),
        "leaning in cup": in_use(surface=bs.RealCup(), **(few | {"cycle": replace(wear.iso_14242_1(10), force=lean)})),
    }


def hip(results: Results, folder: Path) -> None:
    """Record cycles, first cycles, and short runs of every law and contact."""
    phases = numpy.linspace(0.0, 0.95, 20)
    for name, order in product((*MACHINES, *IN_VIVO), ("xyz", "zxy")):
        cycle = wear.named_cycle(name, 20, order, **({"body_weight": 800.0} if name in IN_VIVO else {}))
        results.add(f"cycle/{name}/{order}", [cycle.largest_force, cycle.duration, len(cycle.forces)])
        results.add_attributes(
            f"cycle/{name}/{order}", cycle, "forces rotations rotation_increments midpoint_rotations notes"
        )
        if order == "xyz":
            results.add(f"cycle/{name}/courses", {"force": cycle.force(phases), "angles": cycle.angles(phases)})
            for change, changed in {"mirrored": cycle.mirrored(), "finer": cycle.finer()}.items():
                results.add_attributes(f"cycle/{name}/{change}", changed, "forces rotation_increments")
            results.add(f"cycle/{name}/scaled", cycle.scaled(1.5).forces)
    for name, use in hips().items():
        with results.attempt(f"first/{name}"):
            _first(results, f"first/{name}", use)
        with results.attempt(f"run/{name}"):
            _history(results, f"run/{name}", use.after(1e6, report_at=[1e5, 4e5]))
    store = folder / "run"
    in_use(creep=wear.logarithmic()).after(4e5, store=store)
    _history(results, "resumed", in_use(creep=wear.logarithmic()).after(1e6, report_at=[4e5], store=store))
    ladder = wear.logarithmic(wear.constrained_share(0.45))
    results.add("creep/response", ladder.response(numpy.array([1.0, 1e3, 1e6, 1e9])))
    results.add("creep", list(ladder.elements))


def _first(results: Results, name: str, use: wear.HipSimulation) -> None:
    """Add the first cycle of a hip in use."""
    results.add_attributes(name, use.first, "slide work cross_shear volume depth max_pressure max_force")
    contacts = use.solve_equilibrium()
    results.add(f"{name}/displacement", contacts.displacement)
    results.add(f"{name}/pressure", [contacts.pressure.sum(axis=1), contacts.pressure.max(axis=1)])
    results.add(f"{name}/edge distance", use.edge_distance(contacts))
    exposure = use.exposure(contacts)
    results.add(f"{name}/exposure/work", exposure.work[::3])
    results.add(f"{name}/exposure/cross_shear", exposure.cross_shear[::3])
    results.add(f"{name}/notes", use.notes)
    film = use.film(wear.Lubricant(viscosity=1e-3, friction=0.08))
    results.add_attributes(f"{name}/film", film, "phases least central ratio moment power heat regime")


def _history(results: Results, name: str, history: wear.History) -> None:
    """Add a run, and the maps of its reports."""
    results.add(f"{name}/summary", history.summary())
    results.add(f"{name}/blocks", history.steps)
    for number, report in enumerate(history.reports):
        results.add(f"{name}/{number}/wear", report.wear.ravel()[::3])
        results.add(f"{name}/{number}/crept", report.crept.ravel()[::3])
        attributes = (
            "work displacement wear_displacement creep_displacement edge_distance edge_place edge_pressure converged"
        )
        results.add_attributes(f"{name}/{number}", report, attributes)
        results.add(f"{name}/{number}/ball wear", report.ball_wear[::3])


def patients(results: Results, folder: Path) -> None:
    """Record patients who differ, and files about hips in use."""
    use = in_use(ring_width=radians(10.0), cycle=wear.iso_14242_1(12))
    scatters: dict[str, dict[str, Any]] = {
        "coefficient": {"coefficient": design.LogNormal(median=1e-6, factor=1.5)},
        "clearance": {"clearance": design.Rectangular(low=0.05, high=0.2)},
        "tilt": {"tilt": design.Normal(mean=0.5, deviation=0.1, low=0.0, high=1.0)},
        "weight": {"body_weight": design.Normal(mean=780.0, deviation=130.0, low=400.0, high=1400.0)},
        "pace": {"cycles_per_year": design.LogNormal(median=1.5e6, factor=1.5)},
    }
    everything = {key: value for scatter in scatters.values() for key, value in scatter.items()}
    for name, distributions in {**scatters, "everything": everything}.items():
        with results.attempt(name):
            scatter = wear.PatientVariability(use=use, distributions=distributions)
            bands = wear.uncertainty(scatter, use.after(3e5, report_at=[1e5]), count=4, seed=3)
            results.add(name, bands.summary())
            results.add(f"{name}/notes", bands.notes)
            results.add(f"{name}/volume", [bands.quantile("volume", share) for share in (0.1, 0.5, 0.9)])
    with results.attempt("cross-shear"):
        law = wear.CrossShear(straight=2e-7, circular=2e-6)
        scatter = wear.PatientVariability(
            use=replace(use, wear=law, creep=wear.logarithmic()), distributions=everything
        )
        _, bands = wear.population(scatter, [1e5, 3e5], patients=40, seed=1)
        results.add("cross-shear", bands.summary())
    with results.attempt("series"):
        scatter = wear.PatientVariability(use=use, distributions=scatters["coefficient"])
        _, bands = wear.population(scatter, [1e5, 3e5], patients=40, seed=1, method="series")
        results.add("series", bands.summary())
    for name, text in _hip_files(folder).items():
        path = folder / f"{name}.toml"
        path.write_text(text, encoding="utf-8")
        add_command(results, f"file/{name}", "hip", str(path))
    store = str(folder / "store")
    add_command(results, "many", "hip", str(folder / "uncertain.toml"), "--patients", "20", "--store", store)
    add_table(results, "many/table", folder / "store" / "patients.csv")


_JOINT = """
cycles = 3e5
report_at = [1e5]
[joint]
head_diameter = "28 mm"
clearance = "0.1 mm"
liner_thickness = "8 mm"
[liner]
material = "uhmwpe"
[cup]
tilt = "35 deg"
"""
_CYCLE = """
[cycle]
name = "iso-14242-1"
instants = 16
rotation_order = "adduction, flexion, rotation"
"""
_WEAR = """
[wear]
coefficient = "1e-6 mm^3/(N m)"
ring_width = "8 deg"
"""
_SCATTER = """
[uncertainty]
count = 4
coefficient = { median = "1e-6 mm^3/(N m)", factor = 1.5 }
clearance = { low = "0.05 mm", high = "0.2 mm" }
cycles_per_year = { median = 1.5e6, factor = 1.4 }
"""
_LAWS = {
    "energy": 'law = "energy"\ncoefficient = "2e-5 mm^3/J"\nfriction = 0.05\nball_coefficient = "1e-6 mm^3/J"',
    "area": 'law = "area"\ncoefficient = "2e-9 mm/m"',
    "cross-shear": (
        'law = "cross-shear"\ncoefficient = "2e-7 mm^3/(N m)"\ncircular = "2e-6 mm^3/(N m)"\nexponent = -0.3\n'
        'reference = "2 MPa"\nmodel = "bartel"'
    ),
}


def _hip_files(folder: Path) -> dict[str, str]:
    """Write measured cycles, and return files about hips in use by name."""
    phases = numpy.linspace(0.0, 1.0, 41)
    force, angles = WALK.force(phases), numpy.degrees(WALK.angles(phases))
    rows = numpy.column_stack([1.2 * phases, 0.05 * force, -0.1 * force, force, *angles])
    heads = [f"force_{axis} [N]" for axis in "xyz"] + [f"{name} [deg]" for name in ("flexion", "adduction", "rotation")]
    _write_rows(folder / "walk.csv", ",".join(["time [s]", *heads]), rows, ",")
    joint = [f"hip_r_on_femur_r_in_pelvis_f{axis}" for axis in "xyz"]
    names = ["time", *joint, *(f"hip_{name}_r" for name in ("flexion", "adduction", "rotation"))]
    loads = numpy.column_stack([1.2 * phases, 0.1 * force, -force, 0.02 * force, *angles])
    head = "walk\nversion=1\nnRows=41\nnColumns=7\ninDegrees=yes\nendheader\n"
    _write_rows(folder / "walk.sto", head + "\t".join(names), loads, "\t")
    orthoload = numpy.column_stack([phases, -0.05 * force, 0.1 * force, -force])
    _write_rows(folder / "h1l.csv", "Time;Fx;Fy;Fz\n[s];[N];[N];[N]", orthoload, ";")
    laws = {name: f"{_JOINT}{_CYCLE}\n[wear]\n{law}\nring_width = '8 deg'\n" for name, law in _LAWS.items()}
    cycles = {
        "text": '[cycle]\nfile = "walk.csv"\ninstants = 16\nbody_weight = "800 N"\ntimes_body_weight = 3',
        "opensim": '[cycle]\nfile = "walk.sto"\ninstants = 16',
        "orthoload": '[cycle]\nfile = "h1l.csv"\ninstants = 16\nmotion = "iso-14242-1"\nclosing = 0.05',
        "rocking": '[cycle]\nname = "biaxial-rocking"\nforce = "1.5 kN"\namplitude = "20 deg"\ninstants = 16',
    }
    mixed = "".join(
        f'\n[[activity]]\nname = "{name}"\nper_year = {count}\ninstants = 12\n'
        for name, count in {"walking": 1.2e6, "stairs-up": 3e4, "jogging": 1e4}.items()
    )
    years = _JOINT.replace(
        "cycles = 3e5\nreport_at = [1e5]", 'body_weight = "800 N"\nyears = 0.5\nreport_years = [0.2]'
    )
    film = "[film]\nviscosity = 1e-3\nball_roughness = '10 nm'\ncup_roughness = '0.5 um'\nfriction = 0.07\n"
    creep = '[creep]\nconfinement = "constrained"\nseconds_per_cycle = 1.5\n'
    return {
        **laws,
        **{name: f"{_JOINT}\n{cycle}\n{_WEAR}" for name, cycle in cycles.items()},
        "mix": f"{years}{mixed}{_WEAR}",
        "usual reports": f"{_JOINT}{_CYCLE}{_WEAR}".replace("report_at = [1e5]", ""),
        "creep": f"{_JOINT}{_CYCLE}{_WEAR}{creep}{film}",
        "uncertain": f"{_JOINT}{_CYCLE}{_WEAR}{_SCATTER}",
    }


def _write_rows(path: Path, head: str, rows: numpy.ndarray, separator: str) -> None:
    lines = [separator.join(f"{number:.9g}" for number in row) for row in rows.tolist()]
    path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


def export(results: Results, folder: Path) -> None:
    """Record the programs that force elements are exported to."""
    for name, element in elements().items():
        with results.attempt(f"c/{name}"):
            program = CElement(element=element, name="hip")
            add_program(results, f"c/{name}/header", program.header)
            add_program(results, f"c/{name}/source", program.source)
    for (name, target), kind in product(TARGETS.items(), ("springs", "curve")):
        with results.attempt(f"{name}/{kind}"):
            job = ExportJob(element=elements()[kind], name="hip", depth=0.08)
            for path, text in target.texts(job).items():
                add_program(results, f"{name}/{kind}/{path}", text)
            results.add(f"{name}/{kind}/note", target.note(job) or "none")
    for kind in ("springs", "curve", "exact"):
        power = ExportJob(element=elements()[kind], name="hip", depth=0.08).fitted_power_law
        results.add_attributes(f"power/{kind}", power, "stiffness exponent depth error")
