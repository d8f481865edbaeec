"""Presses a second on a GPU through PyTorch, against the memory's bandwidth: the paper's model and the tables.

The limit is a copy of the same bytes: joint, load and three answers read or written once. Fair, because both run on the
same device with the same arrays, in turns, each waited for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ballsocket as bs

from .report import Report, Rows
from .timing import interleaved

COUNT, REPEATS = 10_000_000, 5
ARRAYS = 7  # R1, c, L, F in; d, ε, p0 out


def measure() -> Report | str:
    try:
        import torch
    except ImportError:
        return "PyTorch is not installed"
    if not torch.cuda.is_available():
        return "there is no GPU here"
    return rates(torch.device("cuda"), COUNT)


def rates(device: Any, count: int) -> Report:
    """Measured on a device with so many presses."""
    import torch

    numbers = torch.rand((4, count), dtype=torch.float64, device=device)
    joint = bs.Joint(
        ball_radius=11.0 + 12.0 * numbers[0],
        clearance=0.05 + 0.15 * numbers[1],
        liner_thickness=4.0 + 8.0 * numbers[2],
        liner=bs.UHMWPE,
    )
    force = 500.0 + 3500.0 * numbers[3]
    source = torch.zeros((ARRAYS, count), dtype=torch.float64, device=device)
    target = torch.empty_like(source)

    def waited(work: Callable[[], object]) -> Callable[[], object]:
        def done() -> None:
            work()
            if device.type == "cuda":
                torch.cuda.synchronize(device)

        return done

    def pressed(model: bs.Model) -> Callable[[], object]:
        def press() -> None:
            with torch.no_grad():
                contact = model.press(joint, force=force)
                _ = contact.half_angle, contact.max_pressure

        return waited(press)

    _, seconds = interleaved(
        REPEATS,
        {
            "copy": waited(lambda: target.copy_(source)),
            "paper": pressed(bs.HessForsbach()),
            "tabulated": pressed(bs.Tabulated()),
        },
    )
    rows = Rows("Presses on the device, ns a press", ("what", "ours", "limit", "ratio"))
    limit = seconds["copy"].per(1e-9 * count)
    for name in ("paper", "tabulated"):
        ours = seconds[name].per(1e-9 * count)
        rows.add(f"{name}, by force: d, ε, p0", ours, limit, f"{ours.over(limit)} times a copy of the same bytes")
    processor = torch.cuda.get_device_name(device) if device.type == "cuda" else "the processor, not a GPU"
    return Report(
        [rows], [f"On {processor}: {count:.0e} presses of as many joints, float64, eager PyTorch."], ("torch",)
    )
