"""Synthetic pelves: landmarks of a cup of known angles, as files of 3D Slicer.

`python -m tests.planning.pelves`, from the root, writes the example of the planning page.
"""

import json

import numpy as np

from ..places import EXAMPLES
from . import meshes

ASIS, PUBIS = 120.0, (0.0, -4.0, -95.0)
NAMES = ("right ASIS", "left ASIS", "pubic symphysis")


def rotated(pitch=0.0, roll=0.0, yaw=0.0):
    """Return the matrix of a pelvis in the scanner, by angles in degrees; pitch moves its top to the front."""
    p, r, y = np.radians([pitch, roll, yaw])
    about_x = np.array([[1, 0, 0], [0, np.cos(p), np.sin(p)], [0, -np.sin(p), np.cos(p)]])
    about_y = np.array([[np.cos(r), 0, -np.sin(r)], [0, 1, 0], [np.sin(r), 0, np.cos(r)]])
    about_z = np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def axis(inclination, anteversion, side="right"):
    """Return the axis out of the opening of a cup by radiographic angles in degrees."""
    ri, ra = np.radians([inclination, anteversion])
    x = np.sin(ri) * np.cos(ra)
    return np.array([x if side == "right" else -x, np.sin(ra), -np.cos(ri) * np.cos(ra)])


def pelvis(inclination=42.0, anteversion=17.0, side="right", scatter=0.0, turn=None, shift=(5.0, -40.0, 900.0)):
    """Return names and points (n, 3) in mm, RAS, of a pelvis whose pelvic plane is turned in the scanner."""
    anterior = [[ASIS, 0.0, 0.0], [-ASIS, 0.0, 0.0], [0.0, 0.0, -95.0]]
    out = axis(inclination, anteversion, side)
    first = np.cross(out, [0.0, 0.0, 1.0])
    first /= np.linalg.norm(first)
    angles = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    ring = 26.0 * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), np.cross(out, first)))
    ring += np.random.default_rng(5).normal(0.0, scatter, ring.shape) if scatter else 0.0
    centre = np.array([90.0 if side == "right" else -90.0, -40.0, -85.0])
    matrix = np.eye(3) if turn is None else turn
    everything = np.concatenate([anterior, centre + ring]) @ matrix.T + np.array(shift)
    return [*NAMES, *(f"rim-{number}" for number in range(1, 9))], everything


def fcsv(names, points, system="LPS"):
    signs = np.array([1.0, 1.0, 1.0] if system in ("RAS", "0") else [-1.0, -1.0, 1.0])
    head = f"# Markups fiducial file version = 4.11\n# CoordinateSystem = {system}\n"
    lines = ["# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID"]
    for number, (name, (x, y, z)) in enumerate(zip(names, points * signs, strict=True)):
        lines.append(f"vtkMRML_{number},{x:.4f},{y:.4f},{z:.4f},0,0,0,1,1,1,0,{name},,")
    return head + "\n".join(lines) + "\n"


def markups(names, points, system="LPS", unit="mm", scale=1.0):
    signs = np.array([1.0, 1.0, 1.0] if system == "RAS" else [-1.0, -1.0, 1.0])
    controls = [
        {"id": str(number), "label": name, "position": (point * signs * scale).tolist(), "positionStatus": "defined"}
        for number, (name, point) in enumerate(zip(names, points, strict=True))
    ]
    markup = {"type": "Fiducial", "coordinateSystem": system, "coordinateUnits": unit, "controlPoints": controls}
    return json.dumps({"@schema": "markups-schema-v1.0.3.json#", "markups": [markup]})


if __name__ == "__main__":
    folder = EXAMPLES / "planning"
    names, points = pelvis(scatter=0.3, turn=rotated(pitch=6.0, roll=1.5, yaw=4.0))
    content = json.loads(markups(names, points.round(2)))
    (folder / "pelvis.mrk.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    liner = meshes.scattered(meshes.liner(chamfer=1.0, steps=10, segments=24), 0.003)
    (folder / "liner.stl").write_bytes(meshes.binary(liner, b"synthetic liner of the planning page"))
    head = meshes.head(radius=15.95, steps=10, segments=24)
    (folder / "head.stl").write_bytes(meshes.binary(head, b"synthetic head of the planning page"))
