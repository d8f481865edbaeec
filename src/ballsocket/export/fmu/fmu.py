"""FMU archive with description, sources, and a binary for the machine that writes it."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from html import escape
from itertools import accumulate
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import UUID
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ...core.checks import require
from ...core.storage.atomic_files import write_atomically
from ...dynamics import ForceElement, PreloadedElement
from ...version import __version__
from ..c_element import CElement, fill_template
from ..c_text import c_number
from ..compiler import LIBRARY_ENDING, THIS_PLATFORM, NoCompiler, Platform, compile_library, cross_compilers
from ..targets import ExportJob
from ..time_steps import TimeStepAdvice
from .reference_results import reference_tables, suggested_times
from .variables import UNITS, Variable, variables

_ARCHIVE_DATE = (1980, 1, 1, 0, 0, 0)  # fixed date of all files, so that equal elements give equal archives


_CAPABILITIES = {
    "2.0": ("canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"),
    "3.0": (
        "canGetAndSetFMUState",
        "canSerializeFMUState",
        "providesDirectionalDerivatives",
        "providesAdjointDerivatives",
    ),
}
LOG_CATEGORIES = {
    "logStatusWarning": "an indentation beyond the validity of the model, reported once",
    "logStatusDiscard": "an indentation larger than the wall thickness: reduce the step",
    "logStatusError": "states that are not finite, parameters out of range",
}


def fmi2_description(fmu: Fmu) -> bytes:
    """Return the XML file `modelDescription.xml` of an FMU for FMI 2.0, as bytes."""
    root = _description_root(fmu, {"guid": fmu.guid, "numberOfEventIndicators": "0"})
    files = SubElement(root[1], "SourceFiles")
    for parent in (SubElement(root[0], "SourceFiles"), files):
        for source in fmu.c_sources:
            SubElement(parent, "File", name=source)
    variables_element = _add_units_and_logs(root, fmu)
    for variable in fmu.variables:
        scalar_variable = SubElement(variables_element, "ScalarVariable", _variable_attributes(variable))
        SubElement(scalar_variable, "Real", _number_attributes(variable))
    structure = SubElement(root, "ModelStructure")
    for tag, unknowns in _unknowns(fmu, ("Outputs", "Derivatives", "InitialUnknowns")):
        parent = SubElement(structure, tag)
        for variable in unknowns:
            dependencies = _dependency_attributes(variable.needs, tag)
            SubElement(parent, "Unknown", {"index": str(variable.reference), **dependencies})
    return _xml_bytes(root)


def fmi3_description(fmu: Fmu) -> bytes:
    """Return the XML file `modelDescription.xml` of an FMU for FMI 3.0, as bytes."""
    root = _description_root(fmu, {"instantiationToken": fmu.guid})
    variables_element = _add_units_and_logs(root, fmu)
    time = {"name": "time", "valueReference": "0", "causality": "independent", "variability": "continuous"}
    SubElement(variables_element, "Float64", time, unit="s")
    for variable in fmu.variables:
        SubElement(variables_element, "Float64", {**_variable_attributes(variable), **_number_attributes(variable)})
    structure = SubElement(root, "ModelStructure")
    for tag, unknowns in _unknowns(fmu, ("Output", "ContinuousStateDerivative", "InitialUnknown")):
        for variable in unknowns:
            dependencies = _dependency_attributes(variable.needs, tag)
            SubElement(structure, tag, {"valueReference": str(variable.reference), **dependencies})
    return _xml_bytes(root)


def _unknowns(fmu: Fmu, tags: tuple[str, str, str]) -> Iterator[tuple[str, list[Variable]]]:
    """Yield the outputs, the rates of the states, and what is computed at the start, after their names in XML."""
    outputs = [variable for variable in fmu.variables if variable.causality == "output"]
    rates = [variable for variable in fmu.variables if variable.state]
    computed = [variable for variable in (*outputs, *rates) if not variable.is_exact]
    yield from ((tag, unknowns) for tag, unknowns in zip(tags, (outputs, rates, computed), strict=True) if unknowns)


def build_description(fmu: Fmu) -> bytes:
    """Return the XML file `buildDescription.xml` of FMI 3.0, a list of the source files, as bytes."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=fmu.name)
    files = SubElement(configuration, "SourceFileSet", language="C99")
    for source in fmu.c_sources:
        SubElement(files, "SourceFile", name=source)
    return _xml_bytes(root)


def terminals_description(fmu: Fmu) -> bytes:
    """Return the XML file `terminalsAndIcons.xml` of FMI 3.0 as bytes: one terminal with all inputs and outputs."""
    root = Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    terminal = SubElement(SubElement(root, "Terminals"), "Terminal", name="ball", matchingRule="bus")
    for variable in fmu.variables:
        if variable.causality in ("input", "output"):
            name = {"variableName": variable.name, "memberName": variable.name}
            SubElement(terminal, "TerminalMemberVariable", {**name, "variableKind": "signal"})
    return _xml_bytes(root)


def layered_standard_files(fmu: Fmu) -> dict[str, bytes]:
    """Return the files of FMI-LS-REF by their paths in an archive: a manifest, an experiment, and its two tables."""
    name, (given, reference) = fmu.name, reference_tables(fmu.element, fmu.ball_mass)
    manifest_names = {
        "xmlns:fmi-ls": "http://fmi-standard.org/fmi-ls-manifest",
        "fmi-ls:fmi-ls-name": "org.fmi-standard.fmi-ls-ref",
        "fmi-ls:fmi-ls-version": "1.0.0-alpha.1",
        "fmi-ls:fmi-ls-description": "Layered Standard providing information on related files included in an FMU.",
    }
    manifest, experiments = Element("fmiReferences", manifest_names), Element("Experiments", name=name)
    about = "inputs, and the outputs of the element in Python"
    related = {"type": "application/x-ma-hs-experiments", "source": f"{name}.exp", "role": "experiment/smoke-test"}
    SubElement(manifest, "Related", related, description=about)
    experiment = SubElement(experiments, "Experiment", name=name)
    SubElement(experiment, "TransientSimulation", _times(fmu))
    SubElement(experiment, "Stimuli", source=f"{name}_in.csv")
    SubElement(experiment, "References", source=f"{name}_ref.csv")
    return {
        f"{_LS_REF}/fmi-ls-manifest.xml": _xml_bytes(manifest),
        f"{_LS_REF}/{name}.exp": _xml_bytes(experiments),
        f"{_LS_REF}/{name}_in.csv": given.encode(),
        f"{_LS_REF}/{name}_ref.csv": reference.encode(),
    }


def _times(fmu: Fmu) -> dict[str, str]:
    stop, step = suggested_times(fmu.ball_mass)
    return {"startTime": "0", "stopTime": repr(stop), "stepSize": repr(step)}


_LS_REF = "extra/org.fmi-standard.fmi-ls-ref"


def _description_root(fmu: Fmu, identifiers: dict[str, str]) -> Element:
    """Make the root element of a model description in XML, with the capabilities of the FMU."""
    description = f"ball in a socket, {fmu.element.model.title}"
    if isinstance(fmu.element, PreloadedElement):
        description += "; the start values of the position are those of the ball at rest, without a force"
    tool = {"generationTool": f"ballsocket {__version__}", "variableNamingConvention": "structured"}
    version = fmu.standard.version
    names = {"fmiVersion": version, "modelName": fmu.name, **identifiers}
    attributes = {**names, "description": description, **tool}
    root = Element("fmiModelDescription", attributes)
    capabilities = dict.fromkeys(_CAPABILITIES[version], "true")
    identifier = {"modelIdentifier": fmu.name, **capabilities}
    not_needed = (
        {"completedIntegratorStepNotNeeded": "true"} if version == "2.0" else {"needsCompletedIntegratorStep": "false"}
    )
    SubElement(root, "ModelExchange", {**identifier, **not_needed})
    SubElement(root, "CoSimulation", {**identifier, "canHandleVariableCommunicationStepSize": "true"})
    return root


def _add_units_and_logs(root: Element, fmu: Fmu) -> Element:
    """Add units, log categories and the default experiment to a model description, and return its variables."""
    units = SubElement(root, "UnitDefinitions")
    for name, powers in UNITS.items():
        bases = {base: str(power) for base, power in powers.items()}
        SubElement(SubElement(units, "Unit", name=name), "BaseUnit", bases)
    categories = SubElement(root, "LogCategories")
    for name, meaning in LOG_CATEGORIES.items():
        SubElement(categories, "Category", name=name, description=meaning)
    SubElement(root, "DefaultExperiment", _times(fmu))
    return SubElement(root, "ModelVariables")


def _variable_attributes(variable: Variable) -> dict[str, str]:
    attributes = {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": variable.description,
        "causality": variable.causality,
        "variability": variable.variability,
    }
    return attributes | ({"initial": "exact"} if variable.is_exact else {})


def _number_attributes(variable: Variable) -> dict[str, str]:
    start = {} if variable.start is None else {"start": repr(variable.start)}
    return {"unit": variable.unit, **start, **({"derivative": str(variable.state)} if variable.state else {})}


def _dependency_attributes(inputs: Iterable[int], tag: str) -> dict[str, str]:
    # initial outputs depend on parameters too; without this attribute they depend on every variable
    """Return the XML attribute that lists the inputs of an output; empty for initial values."""
    return {} if tag.startswith("Initial") else {"dependencies": " ".join(map(str, inputs))}


def _xml_bytes(root: Element) -> bytes:
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


@dataclass(frozen=True, kw_only=True)
class Standard:
    """Version of the FMI standard: its description file, folder names of binaries, and words of the C template."""

    version: str
    folder: Callable[[Platform], str]  # returns the folder name of the binaries of a platform
    describe: Callable[[Fmu], bytes]  # returns the file `modelDescription.xml`
    words: Mapping[str, str]  # words in which the C functions of the versions differ, by their placeholders

    @property
    def number(self) -> str:
        """Main number of the version, 2 or 3."""
        return self.version[0]


STANDARDS: Mapping[int, Standard] = {
    2: Standard(
        version="2.0",
        folder=lambda platform: f"{ {'windows': 'win'}.get(platform.system, platform.system) }{platform.bits}",
        describe=fmi2_description,
        words={
            "handle": "Component",
            "token": "GUIDs",
            "state": "state",
            "deserialize": "DeSerializeFMUstate",
            "derivatives": "Derivatives",
        },
    ),
    3: Standard(
        version="3.0",
        folder=str,
        describe=fmi3_description,
        words={
            "handle": "Instance",
            "token": "instantiation tokens",
            "state": "State",
            "deserialize": "DeserializeFMUState",
            "derivatives": "ContinuousStateDerivatives",
        },
    ),
}


@dataclass(frozen=True, kw_only=True)
class FmuFile:
    """Written FMU archive: its path, and a note on missing binaries; empty if the archive is complete."""

    path: Path
    missing: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class Fmu:
    """Force element as an FMU (functional mock-up unit) for model exchange and co-simulation, in SI units.

    Inputs are position, velocity and spin; outputs are force, moment, energy, half angle and largest pressure. The unit
    has no states but deflections of bristles, relaxed forces of a liner, and the motion of a ball inside. Damping and
    friction are tunable parameters, and the joint if its law is a formula. The start position of a preloaded ball is
    that at rest.

    Parameters
    ----------
    element : ForceElement or PreloadedElement
    name : str
        Identifier of the model: letters, digits and _.
    version : int
        Version of FMI, 2 or 3.
    beyond : str
        What follows an indentation beyond the range of the law, as in `CElement`.
    mass : float
        Mass of the ball in kg, for the advice on time steps.
    ball_mass : float, optional
        Mass in kg, at least 1e-100, of a ball inside, whose motion the unit integrates in a socket at rest. Its inputs
        are then a force and a torque on the ball. None, the default, has no ball.

    Raises
    ------
    ValueError
        An invalid name, version or mass.
    """

    element: ForceElement | PreloadedElement
    name: str = "ballsocket"
    version: int = 3
    beyond: str = "extend"
    mass: float = 1.0
    ball_mass: float | None = None

    def __post_init__(self) -> None:
        if self.ball_mass is not None:
            valid = 1e-100 <= self.ball_mass < inf  # lighter balls take steps of 0 s
            require("ball_mass", self.ball_mass, valid, "a mass (kg) must be at least 1e-100 and finite")
        require("FMI version", self.version, self.version in STANDARDS, "2 or 3")
        CElement(element=self.element, name=self.name, beyond=self.beyond)

    @property
    def standard(self) -> Standard:
        """Version of the FMI standard of the FMU."""
        return STANDARDS[self.version]

    @cached_property
    def sources(self) -> Mapping[str, str]:
        """Texts of the C source files of the FMU, by file name."""
        standard, numbers = self.standard, {"standard": self.standard.version, "fmi": self.standard.number}
        values = {**self._job.template_context, **standard.words, **numbers, **self._numbers, "guid": self.guid}
        return {**self._job.program_texts(), f"fmi{standard.number}.c": fill_template("fmi.c", **values)}

    @cached_property
    def guid(self) -> str:
        """Unique identifier that links description and binary; it changes with every number of the FMU."""
        context = self._job.template_context
        numbers = (context["parameters"], context["units"], *self._numbers.values())
        parts = (*self._job.program_texts().values(), *numbers, self.standard.version, self.name)
        return f"{{{UUID(bytes=sha256(''.join(parts).encode()).digest()[:16])}}}"

    @property
    def time_steps(self) -> TimeStepAdvice:
        """Time steps for a host program, up to the largest valid indentation."""
        return self._job.time_steps

    @cached_property
    def _job(self) -> ExportJob:
        """Export of the element to C, up to its largest valid indentation."""
        return ExportJob(
            element=self.element,
            name=self.name,
            depth=self.element.valid_depth,
            beyond=self.beyond,
            mass=self.mass,
        )

    @cached_property
    def _numbers(self) -> dict[str, str]:
        """Numbers of variables, start values, and the message on validity, for placeholders of the C template."""
        element, inside, counts = self.element, self.ball_mass is not None, self.element.internal_states.values()
        *firsts, count = 0, *accumulate(counts)
        sizes = ["1e-3" if variable.unit in ("m", "m/s") else "1.0" for variable in self.variables[: 9 + count]]
        sizes += ["1.0"] * 6 * inside
        fixed = [variable for variable in self.variables if variable.variability != "continuous"]
        values = self.variables[: len(sizes)]
        return {
            "ball": str(int(inside)),
            "internal": str(count),
            "fixed": str(sum(variable.variability == "constant" for variable in fixed)),
            "at_internal": "".join(f", s + {9 + first}" for first in firsts),
            "into_rates": "".join(f", inner + {first}" for first in firsts),
            "value_units": ", ".join(sizes),
            "values": ", ".join(c_number(variable.start) for variable in values if variable.start is not None),
            "starts": ", ".join(c_number(variable.start) for variable in fixed if variable.start is not None),
            "beyond": f"{element.model.name} is not valid beyond {self._job.depth:.4g} mm in the exported joint",
        }

    @property
    def c_sources(self) -> list[str]:
        """Names of the C files, which a tool compiles."""
        return [name for name in self.sources if name.endswith(".c")]

    @cached_property
    def variables(self) -> tuple[Variable, ...]:
        """Inputs, outputs, states, rates, parameters and constants."""
        return variables(self.element, self.ball_mass)

    def write(self, path: Path) -> FmuFile:
        """Write the FMU archive, and return its path with a note on each binary that could not be made.

        Raises OSError: a folder that cannot be written to.
        """
        files: dict[str, bytes] = {"modelDescription.xml": self.standard.describe(self)}
        files |= {f"sources/{name}": text.encode() for name, text in self.sources.items()}
        page = escape(self._job.readme(f"functional mock-up unit of FMI {self.standard.version}"))
        files["documentation/index.html"] = f'<!doctype html><meta charset="utf-8"><pre>{page}</pre>\n'.encode()
        files["documentation/licenses/license.txt"] = fill_template("license.txt").encode()
        files |= layered_standard_files(self)
        if self.version == 3:
            files["sources/buildDescription.xml"] = build_description(self)
            files["terminalsAndIcons/terminalsAndIcons.xml"] = terminals_description(self)
        binaries, failures = self._compile_binaries()
        for platform, binary in binaries.items():
            files[f"binaries/{self.standard.folder(platform)}/{self.name}{platform.library_ending}"] = binary
        if not binaries:
            failures.append("the archive contains the sources without a binary")
        elif THIS_PLATFORM not in binaries:
            failures.append(
                f"the binary is for {', '.join(map(str, binaries))}, the platform of its compiler; "
                f"the binary for {THIS_PLATFORM} is missing"
            )
        with write_atomically(Path(path)) as draft, zipfile.ZipFile(draft, "w") as archive:
            for name in sorted(files):
                entry = zipfile.ZipInfo(name, _ARCHIVE_DATE)
                entry.external_attr, entry.create_system = 0o644 << 16, 3
                archive.writestr(entry, files[name], zipfile.ZIP_DEFLATED, 9)
        return FmuFile(path=Path(path), missing="; ".join(failures))

    def _compile_binaries(self) -> tuple[dict[Platform, bytes], list[str]]:
        """Compile the C sources for this machine and by each cross-compiler; return the libraries, and errors."""
        binaries, errors = {}, []
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            for name, text in self.sources.items():
                (folder / name).write_text(text, encoding="utf-8")
            library = folder / f"{self.name}{LIBRARY_ENDING}"
            for program in ((), *cross_compilers()):
                try:
                    platform = compile_library(self.c_sources, library, folder, program=program)
                    binaries[platform] = library.read_bytes()
                except NoCompiler as error:
                    errors.append(f"no binary by {program[0]}: {error}" if program else str(error))
        return binaries, errors
