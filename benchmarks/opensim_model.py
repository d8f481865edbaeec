"""OpenSim's elastic foundation: a ball (a sphere) pressed into a socket (a mesh); mm, N and MPa/mm outside."""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy
from scipy.sparse import csr_matrix, identity
from scipy.sparse.linalg import spsolve

import ballsocket as bs

from .timing import Job
from .tools import silent_opensim

METRES, STIFFNESS = 1e-3, 1e9  # per millimetre; Pa/m per MPa/mm


@dataclass
class BallInSocket:
    """A socket fixed to the ground and a ball that slides along x, without gravity, friction or dissipation."""

    model: Any  # kept: it must not be freed while its state is in use
    state: Any
    coordinate: Any
    ball: int  # index of the ball's forces
    clearance: float  # mm

    def force(self, indentation: float) -> float:
        """The axial force, in N, with the ball pressed `indentation` mm beyond first touch."""
        self.coordinate.setValue(self.state, (self.clearance + indentation) * METRES, False)
        self.model.realizeDynamics(self.state)
        return -float(self.model.getRigidBodyForces(self.state).get(self.ball).get(1).get(0))

    def job(self, depth: float, calls: int) -> Job:
        """Force evaluations at two alternating positions, as in the steps of a simulation."""
        return Job(lambda: [self.force(depth * (1 + 1e-6 * (number % 2))) for number in range(calls)], calls)


def socket_mesh(radius: float, faces: int) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Vertices and triangles of a closed solid: a hemispherical socket (pole at +x), a rim and an outer cone."""
    rings = max(2, round(math.sqrt(faces / 6 + 2.25) - 1.5))  # gives 6 rings² + 18 rings faces
    rows, triangles = [numpy.array([[radius, 0.0, 0.0]])], []
    for ring in range(1, rings + 1):
        polar, around = math.pi / 2 * ring / rings, math.pi / 3 * numpy.arange(6 * ring) / ring
        circle = numpy.column_stack([0 * around, numpy.cos(around), numpy.sin(around)])
        rows.append(radius * (math.sin(polar) * circle + [math.cos(polar), 0.0, 0.0]))
        first, before = 1 + 3 * ring * (ring - 1), 1 + 3 * (ring - 1) * (ring - 2) if ring > 1 else 0
        for sector in range(6):
            far = [first + (sector * ring + step) % (6 * ring) for step in range(ring + 1)]
            near = [before + (sector * (ring - 1) + step) % max(1, 6 * (ring - 1)) for step in range(ring)]
            triangles += [(near[step], far[step + 1], far[step]) for step in range(ring)]
            triangles += [(near[step], near[step + 1], far[step + 1]) for step in range(ring - 1)]
    vertices, inside = numpy.vstack(rows), numpy.array(triangles)
    vertices = _centroids_near_sphere(vertices, inside, radius)
    rim, edge, apex = len(vertices) - 6 * rings, len(vertices), len(vertices) + 6 * rings
    for a, b in ((step, (step + 1) % (6 * rings)) for step in range(6 * rings)):
        triangles += [(rim + a, rim + b, edge + a), (rim + b, edge + b, edge + a), (edge + a, edge + b, apex)]
    solid = numpy.vstack([vertices, 1.3 * vertices[rim:], [[3 * radius, 0.0, 0.0]]])
    return solid, numpy.array(triangles)


def _centroids_near_sphere(vertices: numpy.ndarray, faces: numpy.ndarray, radius: float) -> numpy.ndarray:
    """The vertices moved so that the centroids of the faces, where the springs act, come near to the sphere.

    First along the radius; then by damped least squares in all directions, with little damping: without any the
    faces would lose their shape, without this step the force on the coarsest mesh would be 75 % off at 5 µm.
    """
    corners = faces.ravel()
    for _ in range(30):
        scale = numpy.repeat(radius / numpy.linalg.norm(vertices[faces].mean(axis=1), axis=1), 3)
        vertices = vertices * (numpy.bincount(corners, weights=scale) / numpy.bincount(corners))[:, None]
    places = numpy.repeat(numpy.arange(len(faces)), 9), (3 * faces[:, :, None] + numpy.arange(3)).ravel()
    for _ in range(10):
        centroids = vertices[faces].mean(axis=1)
        size = numpy.linalg.norm(centroids, axis=1)
        slopes = numpy.tile(centroids / size[:, None] / 3, (1, 3)).ravel()
        matrix = csr_matrix((slopes, places), shape=(len(faces), vertices.size))
        damped = (matrix @ matrix.T + 1e-4 * identity(len(faces))).tocsc()
        vertices = vertices + (matrix.T @ spsolve(damped, radius - size)).reshape(-1, 3)
    return vertices


def build(joint: bs.Joint, foundation_modulus: float, faces: int) -> BallInSocket:
    """The model, with about `faces` faces in the socket's mesh."""
    opensim, ball_radius, clearance = silent_opensim(), float(joint.ball_radius), float(joint.clearance)
    vertices, triangles = socket_mesh((ball_radius + clearance) * METRES, faces)
    model, zero = opensim.Model(), opensim.Vec3(0)
    model.setGravity(zero)
    ball = opensim.Body("ball", 1.0, zero, opensim.Inertia(1.0, 1.0, 1.0))
    slider = opensim.SliderJoint("slider", model.getGround(), ball)
    model.addBody(ball)
    model.addJoint(slider)
    contact = opensim.ElasticFoundationForce()
    contact.setStiffness(foundation_modulus * STIFFNESS)
    for name in ("socket", "sphere"):
        contact.addGeometry(name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "socket.obj"
        lines = ["v {:.17g} {:.17g} {:.17g}\n".format(*vertex) for vertex in vertices.tolist()]
        lines += ["f {} {} {}\n".format(*corners) for corners in (triangles + 1).tolist()]
        path.write_text("".join(lines), encoding="ascii")
        model.addContactGeometry(opensim.ContactMesh(str(path), zero, zero, model.getGround(), "socket"))
        model.addContactGeometry(opensim.ContactSphere(ball_radius * METRES, zero, ball, "sphere"))
        model.addForce(contact)
        state = model.initSystem()  # reads the mesh: the folder must still exist
    return BallInSocket(model, state, slider.getCoordinate(), ball.getMobilizedBodyIndex(), clearance)


def exported(path: Path, clearance: float) -> BallInSocket:
    """The model of a file of ours, with its expression for the force."""
    opensim = silent_opensim()
    model = opensim.Model(str(path))
    model.setGravity(opensim.Vec3(0))
    ball, along = model.getBodySet().get("ball"), model.getCoordinateSet().get("x")
    return BallInSocket(model, model.initSystem(), along, ball.getMobilizedBodyIndex(), clearance)
