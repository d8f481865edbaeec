"""What every answer in JSON says beside its own numbers: may it be trusted, how exact is it, whence, what next."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from ..catalogue import listed_models
from ..core.sources import Source, bibliography, find_cited_keys
from ..problem import Joint, Material
from ..problem.presets import joints, materials
from ..reports.catalogue_lists import source_summary
from .next_steps import asked_of, next_steps

Answer = dict[str, Any]


def whole(answer: Answer, words: Sequence[str]) -> Answer:
    """An answer with `valid`, `error`, `notes`, `sources` and `next`, as far as it does not say them itself.

    Parameters
    ----------
    answer : dict
        What a command tells in JSON.
    words : sequence of str
        The command and what was said to it.

    Returns
    -------
    dict
        `valid` is true where what was asked may be trusted, and null where nothing was judged; `error` has estimated
        relative errors, by model where there are several, null where none are known; `notes` are sentences; `sources`
        publications with `key`, `text`, `doi`; `next` steps with `command` and `why`.
    """
    results = answer.get("results", [])
    told = {
        **answer,
        "valid": answer.get("valid", all(each["valid"] for each in asked_of(results, words)) if results else None),
        "error": answer.get("error", _errors(results)),
        "notes": answer.get("notes", [f"{each['model']}: {note}" for each in results for note in each["notes"]]),
        "sources": [source_summary(source) for source in dict.fromkeys(_sources(answer))],
    }
    return {**told, "next": [step.summary() for step in next_steps(told, words)]}


def _errors(results: Iterable[Answer]) -> Answer | None:
    return {each["model"]: each["error"] for each in results if each.get("error")} or None


def _sources(part: Any) -> Iterator[Source]:
    """The publications behind an answer: of its models, its presets, and those that it names."""
    if isinstance(part, dict):
        for name, value in part.items():
            yield from _said(name, value)
            yield from _sources(value)
    elif isinstance(part, list):
        for each in part:
            yield from _sources(each)


def _said(name: str, value: Any) -> Iterator[Source]:
    if name == "model" and isinstance(value, str) and value in listed_models:
        yield from listed_models[value].sources
    elif name == "name" and isinstance(value, str):
        yield from (Source(key) for preset in _presets(value) for key in find_cited_keys(preset.source))
    elif name == "source" and isinstance(value, str):
        yield from map(Source, find_cited_keys(value))
    elif name == "sources" and isinstance(value, list):
        keys = (each["key"] if isinstance(each, dict) else each for each in value)
        yield from (Source(key) for key in keys if key in bibliography())


def _presets(name: str) -> Iterator[Joint | Material]:
    yield from (joint for joint in joints.values() if joint.name == name)
    yield from (material for material in materials.values() if material.name == name)
