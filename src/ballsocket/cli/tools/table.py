"""The tools: which command each one is, what of it is offered, and what it is for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ...catalogue import off_axis


@dataclass(frozen=True, kw_only=True)
class Tool:
    """A command as other programs call it.

    Attributes
    ----------
    command : str
    what : str
        What it is for, in a sentence or two.
    fixed : tuple of str
        Words that are always said.
    hidden : tuple of str
        Parameters that are not offered, beside those that name files to write.
    required : tuple of str
        Parameters that must be given.
    file : str
        What sort of TOML file it reads, in words; empty where it reads none.
    writes : str
        The option for the folder that it writes into; empty where it writes nothing.
    forbidden : tuple of str
        What its file must not have at the top.
    """

    command: str
    what: str
    fixed: tuple[str, ...] = ()
    hidden: tuple[str, ...] = ()
    required: tuple[str, ...] = ()
    file: str = ""
    writes: str = ""
    forbidden: tuple[str, ...] = ()


_AIM = ("tilt", "direction", "ring_width")
_MESH = ("element_size", "element", "meshes")

TOOLS: Mapping[str, Tool] = MappingProxyType(
    {
        "press": Tool(
            command="press",
            what="Press a ball into its socket: force, indentation, half angle, pressures, area, stiffness by one "
            "model or several, beside the exact answer.",
            hidden=("every", *_AIM),
        ),
        "compare": Tool(
            command="press",
            what="The same by every model of the catalogue, with the distance of each from the exact answer.",
            fixed=("--all",),
            hidden=("model", "every", *_AIM, *_MESH),
        ),
        "tilt": Tool(
            command="press",
            what="A load that is tilted against the cup's axis: contact, rim and largest pressure in three dimensions.",
            fixed=(f"--model={off_axis.name}",),
            hidden=("model", "every", *_MESH),
        ),
        "curve": Tool(command="curve", what="From first touch to a load in equal steps, by one model."),
        "map": Tool(command="map", what="Least and largest answers over two numbers of a joint, within limits."),
        "optimise": Tool(
            command="optimise",
            what="The joint with the smallest answer within limits, or those that none beats in two answers.",
            required=("vary",),
        ),
        "sensitivity": Tool(
            command="sensitivity", what="Which number's scatter matters: Sobol indices.", required=("spread",)
        ),
        "study": Tool(
            command="study",
            what="A joint at every point of a design: axes, samples or a table.",
            file="a study",
            forbidden=("store", "engine"),
        ),
        "wear": Tool(
            command="hip",
            what="Wear, creep and film of a hip over millions of cycles of load and motion.",
            hidden=("patients",),
            file="a hip in use",
        ),
        "identify": Tool(
            command="identify",
            what="Clearance, modulus and more of a joint from measurements, with bands, and what these cannot tell.",
            file="measurements",
        ),
        "evidence": Tool(
            command="evidence",
            what="Everything that a reviewer asks of a computed number, written into a folder as a page and JSON.",
            file="a question",
            writes="--out",
        ),
        "models": Tool(command="models", what="The models: where each can be trusted, and where it comes from."),
        "materials": Tool(command="presets", what="Materials and joints by name, with the sources of their numbers."),
    }
)
"""By name."""
