"""Fields that every JSON answer has: validity, estimated errors, notes, sources and next steps."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice
from types import MappingProxyType
from typing import Any

import numpy
import typer

from ..contact.closed_sphere import NOTED_CHANGE
from ..core.quantities import QUANTITIES
from ..core.sources import Source, bibliography, find_cited_keys
from ..model_catalogue import JUDGE, OFF_AXIS, listed_models, reference
from ..problem import Joint, Material
from ..problem.dimensions import DIAMETERS
from ..problem.presets import joints, materials
from ..version import __version__

Answer = Mapping[str, Any]  # JSON answer of a command
Arguments = Sequence[str]  # name of a command, and its arguments


def echo_json(answer: Answer) -> None:
    """Print one JSON object with version, provenance and next steps; a missing number is null.

    Raises ArithmeticError: a number is infinite.
    """
    try:
        full = add_provenance({"version": __version__, **answer}, sys.argv[1:])
        text = json.dumps(full, indent=2, allow_nan=False)
    except ValueError as error:
        raise ArithmeticError("a result is infinite") from error
    typer.echo(text)


def add_provenance(answer: Answer, arguments: Arguments) -> dict[str, Any]:
    """Add `valid`, `error`, `notes`, `sources` and `next` to an answer that lacks them.

    `valid` is true where the requested results are in the range of their models, and null where no result was checked.
    `error` has estimated relative errors, by model where there are several, and null where none are known. `notes` are
    sentences, `sources` publications with `key`, `text`, `doi`, and `next` steps with `command`, `why`.
    """
    if "next" in answer:  # of several joints
        return dict(answer)
    results = [result for result in answer.get("results", []) if "model" in result]
    requested = requested_results(results, arguments)
    notes = [f"{result['model']}: {note}" for result in results for note in result["notes"]]
    full = {
        **answer,
        "valid": answer.get("valid", all(result["valid"] for result in requested) if results else None),
        "error": answer.get("error", _errors(results)),
        "notes": answer.get("notes", notes),
        "sources": [source.summary() for source in dict.fromkeys(_sources(answer))],
    }
    return {**full, "next": next_steps(full, arguments)}


def several_joints(answers: Sequence[Answer], names: Sequence[str], arguments: Arguments) -> dict[str, Any]:
    """Return the answer of `press` for several joints: each with its provenance, and all their notes and next steps."""
    joints: list[dict[str, Any]] = []
    for answer, name in zip(answers, names, strict=True):
        single = [part for part in arguments if part == name or part not in names]
        joints.append(add_provenance(answer, single))
    steps = {step["command"]: step for joint in joints for step in joint["next"]}
    sources = {source["text"]: source for joint in joints for source in joint["sources"]}
    return {
        "joints": joints,
        "valid": all(joint["valid"] for joint in joints),
        "error": None,
        "notes": [f"{name}: {note}" for joint, name in zip(joints, names, strict=True) for note in joint["notes"]],
        "sources": list(sources.values()),
        "next": list(steps.values()),
    }


def _errors(results: Iterable[Answer]) -> dict[str, Any] | None:
    """Return the estimated errors of results by model; None if there are none."""
    return {result["model"]: result["error"] for result in results if result.get("error")} or None


def _sources(part: Any) -> Iterator[Source]:
    """Yield the publications of the models and presets in a part of an answer, and those that it cites."""
    if isinstance(part, dict):
        for key, value in part.items():
            if key == "model" and isinstance(value, str) and value in listed_models:
                yield from listed_models[value].sources
            elif key == "name" and isinstance(value, str):
                presets: Iterable[Joint | Material] = (*joints.values(), *materials.values())
                named = (preset for preset in presets if preset.name == value)
                yield from (Source(cited) for preset in named for cited in find_cited_keys(preset.source))
            elif key == "source" and isinstance(value, str):
                yield from map(Source, find_cited_keys(value))
            elif key == "sources" and isinstance(value, list):
                cited_keys = (source["key"] if isinstance(source, dict) else source for source in value)
                yield from (Source(cited) for cited in cited_keys if cited in bibliography())
            yield from _sources(value)
    elif isinstance(part, list):
        for element in part:
            yield from _sources(element)


Step = tuple[Sequence[str], str]  # words of a command that is useful after an answer, and the reason


def next_steps(answer: Answer, arguments: Arguments) -> list[dict[str, str]]:
    """Return the commands that are useful after a JSON answer with `valid` and `notes`."""
    if not arguments or arguments[0] not in _NEXT_STEPS:
        return []
    steps = _NEXT_STEPS[arguments[0]](answer, [argument for argument in arguments if argument != "--json"])
    return [{"command": shlex.join(["ballsocket", *words]), "why": why} for words, why in steps]


def requested_results(results: Sequence[Answer], arguments: Arguments) -> list[Answer]:
    """Return the results of the requested models, without the exact result that is always added."""
    if "--all" in arguments:
        return list(results)
    names = _selected_options(arguments, "--model")
    return [result for result in results if result["model"] in names] or list(results[:1])


def _after_press(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    results = {result["model"]: result["valid"] for result in answer["results"]}
    requested = [result["model"] for result in requested_results(answer["results"], arguments)]
    valid_models = [name for name, valid in results.items() if valid is True]
    bare = _without_options(arguments, "--model", "--all", *_OUTPUT_OPTIONS)
    invalid = [name for name in requested if name not in valid_models]
    if valid_models and invalid:
        why = f"{invalid[0]} is outside its valid range here, {valid_models[0]} is valid: see the notes"
        yield (*bare, "--model", valid_models[0]), why
    if not valid_models:
        alternatives = [name for name in (reference.name, OFF_AXIS, JUDGE) if name not in results]
        why = "no model of this answer is valid here"
        yield from (((*bare, "--model", name), why) for name in alternatives)
    elif not {JUDGE, OFF_AXIS} & set(results):
        changes = chain(*(result.get("hemisphere", {}).values() for result in answer["results"]))
        if (abs(numpy.hstack([0.0, *changes]).astype(float)) > NOTED_CHANGE).any():
            why = "a hemisphere with a free rim differs from the closed sphere of this result: see the notes"
            yield from (((*bare, "--model", name), why) for name in (JUDGE, OFF_AXIS))
        else:
            yield (*bare, "--model", JUDGE), "check by finite elements, with estimated errors"
    cited = [name for name in valid_models[:1] if name in requested and name in listed_models]
    yield from ((("cite", name), "references of the model") for name in cited)


_OUTPUT_OPTIONS = ("--units", "--figure", "--section", "--view", "--vtk", "--report", "--tolerance")
"""Options of the output, which the next step does not need."""


def _after_curve(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    if answer["valid"] is not True and answer["model"] != reference.name:
        why = f"{answer['model']} is outside its valid range at some points"
        yield (*_without_options(arguments, "--model"), "--model", reference.name), why
    if answer["model"] in listed_models:
        yield ("cite", answer["model"]), "references of the model"


def _after_optimum(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    from ..files.joint_options import PARTS, inputs_in

    if "point" in answer:
        point = answer["point"]
    else:  # of a map, with the smallest peak pressure or the smallest value of the first quantity
        quantities = answer["quantities"]
        point = quantities.get("max_pressure", next(iter(quantities.values())))[0]["at"]
    chosen = [argument for part, name in answer.get("materials", {}).items() for argument in (f"--{part}", name)]
    numbers = [argument for name, value in point.items() for argument in _as_option(name, value)]
    varied = set(map(_dimension_of, point))
    replaced = [
        entry.option
        for entry in inputs_in((*PARTS, "load"))
        if set(map(_dimension_of, (entry.key, f"{entry.part}_{entry.key}", *entry.rivals))) & varied
    ]
    stated = _without_options(arguments, *replaced)
    step = ("press", *_joint_arguments(stated), *chosen, *numbers, *_load_options(stated), "--all")
    yield step, "the best joint by every model"


def _dimension_of(name: str) -> str:
    """Return the dimension that a parameter determines: of a diameter, the radius."""
    dimension = DIAMETERS.get(name, name)
    return "liner_thickness" if dimension == "outer_radius" else dimension


def _as_option(name: str, value: float) -> Iterator[str]:
    """Yield an option of `press` for a parameter, and its value with the unit."""
    name = name.removesuffix("_deg")
    unit = QUANTITIES[name].kind.assumed_unit if name in QUANTITIES else ""
    yield f"--{name.removeprefix('liner_') if name in _LINER_PARAMETERS else name}".replace("_", "-")
    yield f"{value:.6g} {unit}".strip()


_LINER_PARAMETERS = ("liner_young", "liner_poisson")


def _after_sensitivity(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    load = _load_options(arguments)
    yield ("press", *_joint_arguments(arguments), *load, "--all"), "the stated joint, without scatter, by every model"


def _after_study(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    if not _selected_options(arguments, "--out"):
        yield (*arguments, "--out", "study.csv"), "all values, one row per point"


def _after_orient(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    pairs = zip(chain(*answer["edge_distance"]), chain(*answer["tilt_deg"]), strict=True)
    known = [(distance, tilt) for distance, tilt in pairs if distance is not None]
    if known:
        load = _load_options(arguments)
        step = ("press", *_joint_arguments(arguments), *load, "--tilt", f"{max(known)[1]:.4g} deg")
        yield step, "the orientation with the largest distance to the rim"


def _after_identify(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    if not answer["valid"]:
        why = answer["notes"][0] if answer["notes"] else "not every parameter is identifiable"
        yield (*arguments, "--experiment", "next.png"), why
    elif "posterior" in answer and answer["posterior"] is None:
        yield (*arguments, "--samples", "4000"), "samples of the posterior within the ranges"


def _after_hip(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    if not _selected_options(arguments, "--report", "--patients") and "results" not in answer:
        yield (*arguments, "--report", "hip.html"), "a page with figures of load, contact and wear"


def _after_evidence(answer: Answer, arguments: Arguments) -> Iterator[Step]:
    if _selected_options(arguments, "--check"):
        return
    folder = (_selected_options(arguments, "--out") or ["--out", "evidence"])[1]
    yield ("evidence", "--check", folder), "computes everything again and lists the differences"


def _press_first(names: Iterable[str]) -> Iterator[Step]:
    for name in list(names)[:1]:
        yield ("press", name, "--force", "3 kN", "--all"), "every model on that joint"


def _load_options(arguments: Arguments) -> list[str]:
    """Return the options of the load; of its direction only where the next command has the same cup."""
    from ..files.joint_options import LOAD, inputs_in

    inputs = inputs_in(LOAD if arguments[0] == "orient" else ("load",))
    return _selected_options(arguments, *(entry.option for entry in inputs))


def _joint_arguments(arguments: Arguments) -> tuple[str, ...]:
    """Return the file or preset of the joint, and the options that change joint and cup."""
    from ..files.joint_options import PARTS, RIM, inputs_in

    inputs = inputs_in((*PARTS, *RIM) if arguments[0] == "orient" else (*PARTS, "cup"))  # its angles are ranges
    return (*_joint_name(arguments), *_selected_options(arguments, *(entry.option for entry in inputs)))


FLAGS = frozenset(("--all", "--both-signs", "--json", "--plastic", "--pull-out", "--second-order", "--strict"))
"""Options without a value, of the commands that print JSON."""


def _split(arguments: Arguments) -> Iterator[tuple[str, str, list[str]]]:
    """Yield what follows the command: the option or "", its value or the operand, and the words of both."""
    words = iter(arguments[1:])
    for word in words:
        name, equals, value = word.partition("=") if word.startswith("--") else ("", "", word)
        following = [] if equals or not name or name in FLAGS else list(islice(words, 1))
        yield name, "".join(following) or value, [word, *following]


def _joint_name(arguments: Arguments) -> list[str]:
    """Return the first argument that is neither an option nor the value of one."""
    return [value for name, value, _ in _split(arguments) if not name][:1]


def _without_options(arguments: Arguments, *options: str) -> list[str]:
    return [arguments[0], *chain(*(words for name, _, words in _split(arguments) if name not in options))]


def _selected_options(arguments: Arguments, *options: str) -> list[str]:
    return list(chain(*((name, value) for name, value, _ in _split(arguments) if name in options)))


_NEXT_STEPS: Mapping[str, Callable[[Answer, Arguments], Iterator[Step]]] = MappingProxyType(
    {
        "press": _after_press,
        "curve": _after_curve,
        "map": _after_optimum,
        "study": _after_study,
        "optimise": lambda answer, arguments: _after_optimum(answer, arguments) if "value" in answer else iter(()),
        "sensitivity": _after_sensitivity,
        "orient": _after_orient,
        "identify": _after_identify,
        "hip": _after_hip,
        "planning": lambda answer, arguments: _press_first(filter(None, [answer["file"]])),
        "evidence": _after_evidence,
        "calibrate": lambda answer, arguments: _press_first(_joint_name(arguments)),
        "models": lambda answer, arguments: ((("cite", model["name"]), "BibTeX") for model in answer["models"][:1]),
        "presets": lambda answer, arguments: _press_first(answer["joints"]),
    }
)
"""Functions that yield the next steps, by the name of the command."""
