"""
Largest pressure in a bore out of round
=======================================

The effect of wear, waviness, a press fit and the deviations of a scan on the largest pressure.

A head of 36 mm is pressed into polyethylene with 100 µm of clearance by 2.5 kN, 20° from the cup's axis. Waves of 5 µm
change the largest pressure by 5 %. A bore worn in by the head has a lower largest pressure, by a sixth after 50 µm.
The oval of a press fit lowers it too, by at most 6 % for a diameter that is smaller by 60 µm.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import meshio
import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs

hip = bs.Joint(ball_radius=18.0, clearance=0.1, liner_thickness=7.0, liner=bs.UHMWPE, ball=bs.COCR)
sphere = bs.Sphere(cup=bs.Cup(arc_of_cover=np.radians(170.0)), ring_width=np.radians(3.0))
LOAD = {"force": 2500.0, "tilt": np.radians(20.0)}
WAY = np.array([np.sin(LOAD["tilt"]), 0.0, np.cos(LOAD["tilt"])])

# %%
# A form is a function of directions, a table over polar angle and azimuth, or a scan of triangles. A table of waves as
# a cutting tool leaves them, 4 µm high:

polar, azimuth = np.radians(np.arange(0.0, 91.0, 2.0)), np.radians(np.arange(0.0, 360.0, 6.0))
waves = 0.002 * np.sin(9 * polar[:, None]) * np.ones_like(azimuth)

# %%
# And a scan, here one that is made up: a bore with three lobes of 10 µm and 2 µm of noise, as an STL file.


def lobed(path: Path) -> None:
    """Write a bore of triangles."""
    rows, columns = np.meshgrid(np.linspace(0.01, np.radians(85.0), 60), np.linspace(0.0, 2 * np.pi, 121))
    depth = 0.01 * np.sin(rows) ** 3 * np.cos(3 * columns) + np.random.default_rng(1).normal(0.0, 0.002, rows.shape)
    normal = np.stack([np.sin(rows) * np.cos(columns), np.sin(rows) * np.sin(columns), np.cos(rows)], axis=-1)
    points = ((18.1 + depth)[..., None] * normal).reshape(-1, 3)
    corner = (np.arange(120)[:, None] * 60 + np.arange(59)).ravel()
    triangles = np.concatenate([corner[:, None] + [0, 60, 61], corner[:, None] + [0, 61, 1]])
    meshio.write_points_cells(path, points, [("triangle", triangles)])


with TemporaryDirectory() as folder:
    lobed(Path(folder) / "bore.stl")
    scan = bs.read_scan(Path(folder) / "bore.stl")
print(f"scan: radius {scan.radius:.3f} mm, {1e3 * scan.roughness:.1f} µm off the sphere")

forms = {
    "round": None,
    "worn by 50 µm along the load": bs.BoreDeviation(
        of=lambda n: 0.05 * np.clip(np.tensordot(WAY, n, 1), 0.0, 1.0) ** 2
    ),
    "waves of 4 µm": bs.DepthTable(polar=polar, azimuth=azimuth, values=waves),
    "a scan of three lobes": scan,
}
contacts = {name: replace(sphere, worn=form).press(hip, **LOAD) for name, form in forms.items()}
for name, contact in contacts.items():
    change = 100 * (contact.max_pressure / contacts["round"].max_pressure - 1)
    print(f"{name}: pmax {contact.max_pressure:.2f} MPa ({change:+.1f} %), ε {np.degrees(contact.half_angle):.1f}°")

# %%
# A press fit that pinches the cup makes an oval of its bore. Squeezed across the plane of the load it holds the ball on
# two sides, and the pressure is shared; in that plane it loses about as much on one side as it gains on the other.

squeeze = np.linspace(0.0, 0.15, 6)
ways = {"in the plane of load and axis": 0.0, "across it": np.pi / 2}
pinched = {
    name: [replace(sphere, worn=bs.OvalBore(squeeze=s, direction=way)).press(hip, **LOAD).max_pressure for s in squeeze]
    for name, way in ways.items()
}

figure = Figure(figsize=(10.0, 4.2), layout="constrained")
left, right = figure.subplots(1, 2)
out = np.radians(np.linspace(-60.0, 60.0, 241))
LINES = (("black", "-"), ("#0072B2", (0, (6, 2))), ("#D55E00", (0, (2, 1.5))), ("#009E73", (0, (7, 2, 1.5, 2))))
for (name, contact), (colour, dash) in zip(contacts.items(), LINES, strict=True):
    places = np.stack([np.sin(out + LOAD["tilt"]), 0 * out, np.cos(out + LOAD["tilt"])], axis=-1)
    left.plot(np.degrees(out), contact.pressure_at(places), color=colour, linestyle=dash, linewidth=1.8, label=name)
left.set_xlabel("angle from the load, towards the rim [°]")
left.set_ylabel("pressure [MPa]")
left.legend(frameon=False, fontsize=9)
for (name, largest), (colour, dash) in zip(pinched.items(), LINES[1:], strict=False):
    right.plot(1e3 * squeeze, largest, color=colour, linestyle=dash, linewidth=1.8, label=f"squeezed {name}")
    print(f"squeezed by 60 µm {name}: {100 * (np.interp(0.06, squeeze, largest) / largest[0] - 1):+.1f} %")
right.set_xlabel("what the diameter loses to the press fit [µm]")
right.set_ylabel("largest pressure [MPa]")
right.legend(frameon=False, fontsize=9)
for panel in (left, right):
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
figure.savefig("how_round_must_a_bore_be.png", dpi=150)
