"""Presses on a GPU through PyTorch and JAX; tilted loads on a real cup and patients on springs through JAX.

The limit is a copy of the same bytes: joint, load and three answers read or written once. Fair, because both run on the
same device with the same arrays, in turns, each waited for.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import ballsocket as bs

from .gpu_inverse import ARRAYS, jax_rates
from .off_axis_many import jax_seconds
from .report import Report, Rows
from .timing import interleaved
from .wear_on_springs import patients_in_jax

COUNT, REPEATS = 10_000_000, 5
LOADS = (64, 512, 2048)
PATIENTS = (128, 1024, 8192)


def measure() -> Report | str:
    reports = [report for report in (_through_torch(), _through_jax()) if report is not None]
    if not reports:
        return "there is no GPU that PyTorch or JAX can use"
    tables, notes, rivals = ([item for report in reports for item in getattr(report, name)] for name in _PARTS)
    return Report(tables, notes, rivals)


_PARTS = ("tables", "notes", "rivals")


def _through_torch() -> Report | None:
    try:
        import torch
    except ImportError:
        return None
    if not torch.cuda.is_available():
        return None
    report = rates(torch.device("cuda"), COUNT)
    torch.cuda.empty_cache()  # the memory is JAX's next
    return report


def _through_jax() -> Report | None:
    """Presses by force, tilted loads on a real cup, patients on springs; products of matrices have full precision."""
    try:
        import jax

        device = jax.devices("gpu")[0]
    except (ImportError, RuntimeError):
        return None
    rows = Rows("Tilted loads on one real cup, µs a load", ("loads at once", "1e-4", "2e-5", "aims at 1e-4"))
    presses = jax_rates(device, COUNT)
    with jax.default_device(device):
        for count in LOADS:
            spreads = [jax_seconds(count, tolerance, perf_counter).per(1e-6 * count) for tolerance in (1e-4, 2e-5)]
            rows.add(count, *spreads, "25")
        springs = Rows(
            "Patients on springs, a cycle of 32 instants, µs a patient", ("patients", "GPU", "one core", "over")
        )
        for count in PATIENTS:
            ours, one = (spread.per(1e-6 * count) for spread in patients_in_jax(count, perf_counter))
            springs.add(count, ours, one, f"{one.over(ours)} times faster")
    note = f"Tilted loads on {device.device_kind}: float32, displacements and largest pressures, rings of 2°."
    core = "Patients on springs: float64, rings of 8°; one core solves them one by one, compiled by numba."
    inverse = f"Presses by force on {device.device_kind}: float64, one compiled call; the limit copies seven arrays."
    return Report([presses, rows, springs], [inverse, note, core], ("jax",))


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
