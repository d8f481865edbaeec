"""Example of the planning page: `python -m tests.planning.make_example`, from the root, by hand."""

import json

from ..places import EXAMPLES
from . import meshes, pelves


def main():
    """Write landmarks, liner and head of a synthetic hip to `examples/planning`."""
    folder = EXAMPLES / "planning"
    folder.mkdir(exist_ok=True)
    names, points = pelves.pelvis(scatter=0.3, turn=pelves.rotated(pitch=6.0, roll=1.5, yaw=4.0))
    content = json.loads(pelves.markups(names, points.round(2)))
    (folder / "pelvis.mrk.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    liner = meshes.scattered(meshes.liner(chamfer=1.0, steps=10, segments=24), 0.003)
    (folder / "liner.stl").write_bytes(meshes.binary(liner, b"synthetic liner of the planning page"))
    head = meshes.head(radius=15.95, steps=10, segments=24)
    (folder / "head.stl").write_bytes(meshes.binary(head, b"synthetic head of the planning page"))


if __name__ == "__main__":
    main()
