"""Keys of joint files that commands offer as options."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..core.quantities import LOADS
from .inputs import Input, inputs_of
from .joint_file import JointFileTable

PARTS = ("joint", "liner", "ball", "shell")  # tables of lengths and materials in a joint file

ORIENTATION = tuple(f"cup.{key}" for key in ("inclination", "anteversion", "side", "orientation", "pelvic_tilt"))
"""Keys of a joint file for the orientation of the cup in the body."""

JOINT = (*PARTS, *ORIENTATION)
RIM = ("cup.arc_of_cover", "cup.chamfer", "cup.interface")
LOAD = tuple(f"load.{name}" for name in LOADS)

_ONLY_IN_FILES = re.compile(
    r"(ball_|shell_)?(proportional_limit|yield_stress|fatigue_limit|allowable_pressure)|"
    r"shell_(young|poisson)"
)
"""Names of inputs that are no options."""


def inputs_in(parts: Sequence[str]) -> list[Input]:
    """List the options for some parts of a joint file: tables such as "joint", and keys such as "cup.side"."""
    inputs = [entry for entry in inputs_of(JointFileTable) if not _ONLY_IN_FILES.fullmatch(entry.name)]
    return [entry for entry in inputs if {entry.part, f"{entry.part}.{entry.key}"} & {*parts}]
