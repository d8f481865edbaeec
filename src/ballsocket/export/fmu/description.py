"""The description of the unit, `modelDescription.xml`, in both versions of the standard."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from .variables import UNITS, Variable

_ABILITIES = {
    "2.0": ("canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"),
    "3.0": (
        "canGetAndSetFMUState",
        "canSerializeFMUState",
        "providesDirectionalDerivatives",
        "providesAdjointDerivatives",
    ),
}
LOG_CATEGORIES = {
    "logStatusWarning": "an indentation at which the law does not trust itself, told once",
    "logStatusDiscard": "a ball deeper than the socket's wall: a shorter step is needed",
    "logStatusError": "states that are no numbers, parameters that are not allowed",
}
STOP, STEP = 0.1, 1e-3  # s, what a host may begin with


@dataclass(frozen=True, kw_only=True)
class About:
    """What a description says of its unit beside the variables."""

    name: str
    guid: str
    text: str
    tool: str
    sources: Sequence[str]


def fmi2_description(about: About, variables: Sequence[Variable]) -> bytes:
    """The description of version 2.0."""
    root = _root("2.0", about, {"guid": about.guid, "numberOfEventIndicators": "0"})
    files = SubElement(root[1], "SourceFiles")
    for parent in (SubElement(root[0], "SourceFiles"), files):
        for source in about.sources:
            SubElement(parent, "File", name=source)
    _units(root)
    _categories(SubElement(root, "LogCategories"))
    SubElement(root, "DefaultExperiment", startTime="0", stopTime=str(STOP), stepSize=str(STEP))
    listed = SubElement(root, "ModelVariables")
    for variable in variables:
        kind = SubElement(listed, "ScalarVariable", _attributes(variable))
        SubElement(kind, "Real", _start(variable))
    structure = SubElement(root, "ModelStructure")
    outputs = [variable for variable in variables if variable.causality == "output"]
    for parent in (SubElement(structure, "Outputs"), SubElement(structure, "InitialUnknowns")):
        for variable in outputs:
            SubElement(parent, "Unknown", {"index": str(variable.reference), **_needs(variable.needs, parent.tag)})
    return _written(root)


def fmi3_description(about: About, variables: Sequence[Variable]) -> bytes:
    """The description of version 3.0."""
    root = _root("3.0", about, {"instantiationToken": about.guid})
    _units(root)
    _categories(SubElement(root, "LogCategories"))
    SubElement(root, "DefaultExperiment", startTime="0", stopTime=str(STOP), stepSize=str(STEP))
    listed = SubElement(root, "ModelVariables")
    time = {"name": "time", "valueReference": "0", "causality": "independent", "variability": "continuous"}
    SubElement(listed, "Float64", time, unit="s")
    for variable in variables:
        SubElement(listed, "Float64", {**_attributes(variable), **_start(variable)})
    structure = SubElement(root, "ModelStructure")
    outputs = [variable for variable in variables if variable.causality == "output"]
    for tag in ("Output", "InitialUnknown"):
        for variable in outputs:
            SubElement(structure, tag, {"valueReference": str(variable.reference), **_needs(variable.needs, tag)})
    return _written(root)


def build_description(about: About) -> bytes:
    """How version 3.0 is told what to compile: `buildDescription.xml`."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    one = SubElement(root, "BuildConfiguration", modelIdentifier=about.name)
    files = SubElement(one, "SourceFileSet", language="C99")
    for source in about.sources:
        SubElement(files, "SourceFile", name=source)
    return _written(root)


def _root(version: str, about: About, words: dict[str, str]) -> Element:
    said = {"description": about.text, "generationTool": about.tool, "variableNamingConvention": "structured"}
    named = {"fmiVersion": version, "modelName": about.name, **words, **said}
    root = Element("fmiModelDescription", named)
    abilities = dict.fromkeys(_ABILITIES[version], "true")
    identified = {"modelIdentifier": about.name, **abilities}
    not_needed = (
        {"completedIntegratorStepNotNeeded": "true"} if version == "2.0" else {"needsCompletedIntegratorStep": "false"}
    )
    SubElement(root, "ModelExchange", {**identified, **not_needed})
    SubElement(root, "CoSimulation", {**identified, "canHandleVariableCommunicationStepSize": "true"})
    return root


def _units(root: Element) -> None:
    units = SubElement(root, "UnitDefinitions")
    for name, powers in UNITS.items():
        SubElement(
            SubElement(units, "Unit", name=name), "BaseUnit", {base: str(power) for base, power in powers.items()}
        )


def _categories(parent: Element) -> None:
    for name, about in LOG_CATEGORIES.items():
        SubElement(parent, "Category", name=name, description=about)


def _attributes(variable: Variable) -> dict[str, str]:
    parameter = variable.causality == "parameter"
    attributes = {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": variable.description,
        "causality": variable.causality,
        "variability": "tunable" if parameter else "continuous",
    }
    return attributes | ({"initial": "exact"} if parameter else {})


def _start(variable: Variable) -> dict[str, str]:
    return {"unit": variable.unit} | ({} if variable.start is None else {"start": repr(variable.start)})


def _needs(inputs: Iterable[int], tag: str) -> dict[str, str]:
    # at the beginning outputs depend on parameters too; without a word that is on all there is
    return {} if tag.startswith("Initial") else {"dependencies": " ".join(map(str, inputs))}


def _written(root: Element) -> bytes:
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"
