"""What a caller may sensibly do after an answer, as commands: whom to ask instead, what tells more, what checks it."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from types import MappingProxyType
from typing import Any

import numpy

from ..catalogue import judge, off_axis, reference
from ..contact.closed_sphere import NOTED_CHANGE
from ..core.quantities import QUANTITIES
from ..problem.dimensions import DIAMETERS, LENGTHS

Answer = Mapping[str, Any]
Words = Sequence[str]


@dataclass(frozen=True)
class NextStep:
    """A command, and why."""

    words: tuple[str, ...]
    why: str

    def summary(self) -> dict[str, str]:
        """One dictionary for JSON."""
        return {"command": shlex.join(["ballsocket", *self.words]), "why": self.why}


def next_steps(answer: Answer, words: Words) -> list[NextStep]:
    """What may follow an answer in JSON.

    Parameters
    ----------
    answer : mapping
        It has `valid` and `notes`.
    words : sequence of str
        The command and what was said to it.
    """
    steps = _AFTER.get(words[0], _nothing) if words else _nothing
    return list(steps(answer, [word for word in words if word != "--json"]))


def asked_of(results: Sequence[Answer], words: Words) -> list[Answer]:
    """The results of a press that were asked for; the exact answer stands beside them anyway."""
    if "--all" in words:
        return list(results)
    return [each for each in results if each["model"] in words] or list(results[:1])


def _nothing(answer: Answer, words: Words) -> Iterator[NextStep]:
    return iter(())


def _after_press(answer: Answer, words: Words) -> Iterator[NextStep]:
    """Whom else to ask: those that can be trusted where those asked cannot, and then the judge."""
    results = {each["model"]: each["valid"] for each in answer["results"]}
    asked = [each["model"] for each in asked_of(answer["results"], words)]
    trusted = [name for name, valid in results.items() if valid is True]
    bare = _without(words, "--model", "--all", *_SHOWN)
    doubted = [name for name in asked if name not in trusted]
    if trusted and doubted:
        why = f"{doubted[0]} is not to be trusted here, {trusted[0]} is: see the notes"
        yield NextStep((*bare, "--model", trusted[0]), why)
    if not trusted:
        others = [name for name in (reference.name, off_axis.name, judge.name) if name not in results]
        yield from (NextStep((*bare, "--model", name), "none of these is to be trusted here") for name in others)
    elif not {judge.name, off_axis.name} & set(results):
        if any(map(_differs_on_hemisphere, answer["results"])):
            why = "a hemisphere with a free rim differs from the closed sphere of this result: see the notes"
            yield from (NextStep((*bare, "--model", name), why) for name in (judge.name, off_axis.name))
        else:
            yield NextStep((*bare, "--model", judge.name), "finite elements judge it, with error bars of their own")
    yield from (NextStep(("cite", name), "what it is made of") for name in trusted[:1] if name in asked)


def _differs_on_hemisphere(result: Answer) -> bool:
    """Check if a result, or one of its points, differs by more than 1 % from that of a hemisphere."""
    changes = numpy.array(list(result.get("hemisphere", {}).values()), dtype=float)
    return bool((abs(changes) > NOTED_CHANGE).any())


_SHOWN = ("--units", "--figure", "--section", "--view", "--vtk", "--report", "--tolerance")
"""How an answer is shown, which the next one need not be."""


def _after_curve(answer: Answer, words: Words) -> Iterator[NextStep]:
    if answer["valid"] is not True and answer["model"] != reference.name:
        why = f"{answer['model']} is not to be trusted all the way"
        yield NextStep((*_without(words, "--model"), "--model", reference.name), why)
    yield NextStep(("cite", answer["model"]), "what it is made of")


def _after_best(answer: Answer, words: Words) -> Iterator[NextStep]:
    """The joint that was found, by every model."""
    place = answer["point"] if "point" in answer else _least(answer)
    chosen = [each for part, name in answer.get("materials", {}).items() for each in (f"--{part}", name)]
    numbers = [each for name, value in place.items() for each in _option(name, value)]
    loads = [] if any(name in place for name in ("force", "indentation")) else _kept(words, "--force", "--indentation")
    left = _without(words, *(option for option in _OF_JOINT if _fixes(option) & set(map(_fixed_by, place))))
    yield NextStep(("press", *_joint(left), *chosen, *numbers, *loads, "--all"), "that joint by every model")


def _fixed_by(name: str) -> str:
    """What a parameter fixes: a diameter the radius, an outer radius the thickness of the liner."""
    own = DIAMETERS.get(name, name)
    return "liner_thickness" if own == "outer_radius" else own


def _fixes(option: str) -> set[str]:
    name = option.removeprefix("--").replace("-", "_")
    return {_fixed_by(name), _fixed_by(f"liner_{name}")}


def _least(answer: Answer) -> Mapping[str, Any]:
    quantities = answer["quantities"]
    least: Answer = quantities.get("max_pressure", next(iter(quantities.values())))[0]["at"]
    return least


def _option(name: str, value: float) -> Iterator[str]:
    """A parameter as an option of `press`."""
    each = QUANTITIES.get(name)
    unit = "" if each is None else each.unit.replace("mm2", "mm²").removeprefix("1")
    yield f"--{name.removeprefix('liner_') if name in _OF_LINER else name}".replace("_", "-")
    yield f"{value:.6g} {unit}".strip()


_OF_LINER = ("liner_young", "liner_poisson")


def _after_scatter(answer: Answer, words: Words) -> Iterator[NextStep]:
    load = _kept(words, "--force", "--indentation")
    yield NextStep(("press", *_joint(words), *load, "--all"), "the joint in the middle, by every model")


def _after_study(answer: Answer, words: Words) -> Iterator[NextStep]:
    if not _kept(words, "--out"):
        yield NextStep((*words, "--out", "study.csv"), "all numbers, a row a point")


def _after_orient(answer: Answer, words: Words) -> Iterator[NextStep]:
    tilts = zip(chain(*answer["edge_distance"]), chain(*answer["tilt_deg"]), strict=True)
    known = [(distance, tilt) for distance, tilt in tilts if distance is not None]
    if known:
        load = _kept(words, "--force", "--indentation", "--half-angle")
        step = ("press", *_joint(words), *load, "--tilt", f"{max(known)[1]:.4g} deg")
        yield NextStep(step, "the orientation that is farthest from the rim")


def _after_identify(answer: Answer, words: Words) -> Iterator[NextStep]:
    if not answer["valid"]:
        why = answer["notes"][0] if answer["notes"] else "not every number is identifiable"
        yield NextStep((*words, "--experiment", "next.png"), why)
    elif answer["posterior"] is None:
        yield NextStep((*words, "--samples", "4000"), "samples of the posterior within the ranges")


def _after_hip(answer: Answer, words: Words) -> Iterator[NextStep]:
    if not _kept(words, "--report", "--patients"):
        yield NextStep((*words, "--report", "hip.html"), "a page with figures of load, contact and wear")


def _after_evidence(answer: Answer, words: Words) -> Iterator[NextStep]:
    if _kept(words, "--check"):
        return
    folder = (_kept(words, "--out") or ["--out", "evidence"])[1]
    yield NextStep(("evidence", "--check", folder), "computes all of it again and names what differs")


def _after_calibrate(answer: Answer, words: Words) -> Iterator[NextStep]:
    yield from (
        NextStep(("press", name, "--force", "3 kN", "--all"), "every model on that joint") for name in _named(words)
    )


def _after_list(answer: Answer, words: Words) -> Iterator[NextStep]:
    names = [*answer.get("joints", {})]
    yield from (
        NextStep(("press", name, "--force", "3 kN", "--all"), "every model on that joint") for name in names[:1]
    )
    yield from (NextStep(("cite", each["name"]), "BibTeX") for each in answer.get("models", [])[:1])


def _joint(words: Words) -> tuple[str, ...]:
    """The joint's file or preset, and what changes it."""
    return (*_named(words), *_kept(words, *_OF_JOINT))


_OF_JOINT = tuple(
    f"--{name}".replace("_", "-")
    for name in (*LENGTHS, "young", "poisson", "liner", "ball_young", "ball_poisson", "ball")
)


def _named(words: Words) -> list[str]:
    """The first word that is neither the command, nor an option, nor an option's value."""
    return [
        word for before, word in pairwise(words) if not word.startswith("-") and (before is words[0] or "=" in before)
    ][:1]


def _without(words: Words, *options: str) -> list[str]:
    """The words without options and their values; `--all` has none."""
    left, drop = [], 0
    for word in words:
        name, _, value = word.partition("=")
        if name in options:
            drop = 0 if value or name == "--all" else 1
        elif drop:
            drop -= 1
        else:
            left.append(word)
    return left


def _kept(words: Words, *options: str) -> list[str]:
    """Those options with their values."""
    found = []
    for place, word in enumerate(words):
        name, _, value = word.partition("=")
        if name in options:
            found += [name, value or "".join(words[place + 1 : place + 2])]
    return found


_AFTER: Mapping[str, Callable[[Answer, Words], Iterator[NextStep]]] = MappingProxyType(
    {
        "press": _after_press,
        "curve": _after_curve,
        "map": _after_best,
        "study": _after_study,
        "optimise": lambda answer, words: _after_best(answer, words) if "value" in answer else _nothing(answer, words),
        "sensitivity": _after_scatter,
        "orient": _after_orient,
        "identify": _after_identify,
        "hip": _after_hip,
        "evidence": _after_evidence,
        "calibrate": _after_calibrate,
        "models": _after_list,
        "presets": _after_list,
    }
)
"""By the name of the command."""
