"""Read the text of an input file with any version of the package: numbers of the result, or the refusal.

It wrote `files_of_1_0.json` with version 1.0, and knows names of that version.
"""

import tempfile
from dataclasses import fields, is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path

import numpy

PHASES = numpy.linspace(0.0, 1.0, 21)
TIMES = numpy.linspace(0, 1, 11)
FOLDER = {
    "joint.toml": "[joint]\nball_radius = 16\nclearance = 0.1\nliner_thickness = 6\n"
    '[liner]\nmaterial = "uhmwpe"\n[cup]\ninclination = 45\nanteversion = 15\n',
    "hip.toml": 'joint = "hip-28"\n[cycle]\nname = "iso-14242-1"\n[wear]\nlaw = "archard"\ncoefficient = 1e-6\n',
    "cycle.csv": "time [s],force [N],flexion [deg],adduction [deg],rotation [deg]\n"
    + "\n".join(f"{t:.4g},{2000 + 900 * numpy.cos(6.2832 * t):.4g},{20 * t * (1 - t):.4g},0,0" for t in TIMES),
    "force.csv": "phase [%],force [kN]\n" + "\n".join(f"{10 * i},{1 + i * (10 - i) / 20:.4g}" for i in range(11)),
    "points.csv": "force_N,indentation_um\n500,20\n1000,31\n2000,45\n",
    "rows.csv": "arc_of_cover_deg,ball_poisson\n150,0.3\n160,0.3\n",
}
"""Files that the drawn ones name."""

READERS = {
    "joint": ("ballsocket", "read_joint"),
    "hip": ("ballsocket.hip.file", "read_hip"),
    "study": ("ballsocket.studies.file", "read_study"),
    "identify": ("ballsocket.identify.file", "read_identify"),
    "question": ("ballsocket.evidence.question", "read_question"),
}


def outcome(kind, text):
    """Read a file: its numbers and words, or the refusal."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in FOLDER.items():
            (Path(folder) / name).write_text(content)
        path = Path(folder) / "file.toml"
        path.write_text(text)
        try:
            with numpy.errstate(all="ignore"):
                result = getattr(import_module(READERS[kind][0]), READERS[kind][1])(path)
                return {"result": DIGESTS[kind](result)}
        except (ValueError, OSError) as error:
            return {"refusal": str(error).replace(folder, "FOLDER")}


def numbers(value):
    """List the numbers and words in a value, in the order of its fields."""
    if value is None or isinstance(value, bool):
        return [value]
    if isinstance(value, Enum):
        return [value.value]
    if isinstance(value, str | Path):
        return [value if isinstance(value, str) else value.name]
    if isinstance(value, int | float | numpy.number):
        return [float(value)]
    if isinstance(value, numpy.ndarray):
        weighted = value * numpy.arange(value.size).reshape(value.shape)
        return [list(value.shape), float(numpy.nansum(value)), float(numpy.nansum(weighted))]
    if isinstance(value, dict):
        return [part for key, entry in value.items() for part in (key, *numbers(entry))]
    if isinstance(value, list | tuple):
        return [part for entry in value for part in numbers(entry)]
    if is_dataclass(value):
        return [part for field in fields(value) for part in numbers(getattr(value, field.name))]
    return [] if callable(value) else [repr(type(value).__name__)]


def _joint(joint):
    layers = [list(map(float, (each.thickness, each.material.young, each.material.poisson))) for each in joint.backing]
    return [list(map(float, joint.numbers())), joint.name, joint.support.value, joint.liner.name, layers]


def _creep(law):
    """List the numbers of a creep law by the names that version 1.0 has."""
    names = ("initial", "rate", "compliances", "times", "coefficient", "exponent")
    return numbers([getattr(law, name) for name in names if hasattr(law, name)])


def _wear(law):
    """List the numbers of a wear law, without the source of its coefficient, which version 1.0 does not have."""
    return [number for field in fields(law) if field.name != "source" for number in numbers(getattr(law, field.name))]


def _hip(file):
    use, surface = file.use, file.use.surface
    modulus = float(surface.modulus(use.joint)) if hasattr(surface, "modulus") else type(surface).__name__
    return [
        *(_joint(use.joint), numbers(use.cup), numbers(use.cycle.forces), numbers(use.forces)),
        *(_wear(use.wear), _creep(use.creep), modulus, use.seconds, use.ring_width),
        *(file.cycles, list(file.report_at), numbers(file.lubricant)),
        *([] if file.uncertain is None else [file.uncertain.count, file.uncertain.seed]),
    ]


def _study(file):
    design, engine = file.design, file.engine
    everything = set(import_module("ballsocket.studies.task").QUANTITIES)
    stated = [] if everything <= {*file.quantities} else list(file.quantities)
    return [
        *(file.model.name, _joint(file.joint), list(design.names), design.size, stated),
        *(numbers(file.store), type(engine).__name__, numbers(getattr(engine, "workers", None))),
    ]


def _identify(file):
    data = [
        [each.quantity, *map(numbers, (each.values, each.uncertainty, each.force, each.machine.name))]
        for each in file.data
    ]
    return [file.model.name, _joint(file.joint), numbers(dict(file.free)), data, type(file.scatter).__name__]


def _question(file):
    parts = (file.limits, dict(file.tolerances), dict(file.sources))
    return [
        *(file.text, file.context, file.influence, file.consequence, file.accuracy, _joint(file.file.joint)),
        *(numbers(dict(file.axes)), *map(numbers, parts), file.friction, numbers(file.hip), file.finite_elements),
        sorted(path.name for path in file.files),
    ]


DIGESTS = {
    "joint": lambda file: [_joint(file.joint), numbers(file.load), numbers(file.cup), numbers(file.aim)],
    "hip": _hip,
    "study": _study,
    "identify": _identify,
    "question": _question,
}
