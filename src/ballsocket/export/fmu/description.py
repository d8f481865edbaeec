"""`modelDescription.xml` of the unit, for FMI 2 and 3."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from .variables import UNITS, Variable

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
STOP, STEP = 0.1, 1e-3
"""Suggested end and step of a simulation in s."""


@dataclass(frozen=True, kw_only=True)
class UnitInformation:
    """Name, identifier and texts of an FMU for its description."""

    name: str
    guid: str
    text: str
    tool: str
    sources: Sequence[str]


def fmi2_description(information: UnitInformation, variables: Sequence[Variable]) -> bytes:
    """Write `modelDescription.xml` for FMI 2.0, as bytes."""
    root = _root("2.0", information, {"guid": information.guid, "numberOfEventIndicators": "0"})
    files = SubElement(root[1], "SourceFiles")
    for parent in (SubElement(root[0], "SourceFiles"), files):
        for source in information.sources:
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
            SubElement(
                parent, "Unknown", {"index": str(variable.reference), **_dependencies(variable.needs, parent.tag)}
            )
    return _xml(root)


def fmi3_description(information: UnitInformation, variables: Sequence[Variable]) -> bytes:
    """Write `modelDescription.xml` for FMI 3.0, as bytes."""
    root = _root("3.0", information, {"instantiationToken": information.guid})
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
            SubElement(
                structure, tag, {"valueReference": str(variable.reference), **_dependencies(variable.needs, tag)}
            )
    return _xml(root)


def build_description(information: UnitInformation) -> bytes:
    """Write `buildDescription.xml`, the list of source files for FMI 3.0, as bytes."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=information.name)
    files = SubElement(configuration, "SourceFileSet", language="C99")
    for source in information.sources:
        SubElement(files, "SourceFile", name=source)
    return _xml(root)


def _root(version: str, information: UnitInformation, identifiers: dict[str, str]) -> Element:
    """Make the root element of a description, with the capabilities of the unit."""
    texts = {
        "description": information.text,
        "generationTool": information.tool,
        "variableNamingConvention": "structured",
    }
    named = {"fmiVersion": version, "modelName": information.name, **identifiers, **texts}
    root = Element("fmiModelDescription", named)
    capabilities = dict.fromkeys(_CAPABILITIES[version], "true")
    identified = {"modelIdentifier": information.name, **capabilities}
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
    for name, meaning in LOG_CATEGORIES.items():
        SubElement(parent, "Category", name=name, description=meaning)


def _attributes(variable: Variable) -> dict[str, str]:
    """Return the XML attributes of a variable."""
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


def _dependencies(inputs: Iterable[int], tag: str) -> dict[str, str]:
    # initial outputs depend on parameters too; without this attribute they depend on every variable
    return {} if tag.startswith("Initial") else {"dependencies": " ".join(map(str, inputs))}


def _xml(root: Element) -> bytes:
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"
