"""The contact by finite elements: what the paper did with Abaqus, as one more model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import pi, radians

from .. import arrays
from ..checks import require
from ..contact import Contact
from ..gaps import CircularGap, LinearGap, check_gap
from ..joint import Joint
from ..models.base import Answer, Model
from ..models.by_joint import taken_apart
from ..sources import Source
from ..validity import CLOSE_FIT, SMALL_STRAIN, Range
from .bodies import Resolution, ball_compliance, socket_compliance, socket_shape
from .contact import MeshedContact
from .cup import Cup
from .curve import COARSE, Curve
from .memory import check_memory, mesh_size
from .pair import Pair, Surface
from .spacing import Adapted, Element, Spacing, Uniform

Array = arrays.Array

LIMIT = radians(88.0)
"""The widest contact where the socket reaches further."""


def _silent(_: str) -> None: ...


@dataclass(frozen=True, kw_only=True)
class FiniteElement(Model):
    """Axisymmetric finite elements: what the exact solution leaves out, a rim, a liner that slides, a shell that gives.

    Linear elasticity and small displacements, as in `Exact`; contact without friction and without penalty. The ball is
    the half that faces the socket, pushed by its equator, which stays plane. Each body is condensed once onto its
    contact surface, after which every load takes milliseconds. NumPy inside, whatever arrays come in.

    Parameters
    ----------
    cup : Cup
        Arc of cover, chamfer, and whether the liner is bonded to its backing. A hemisphere by default.
    spacing : Adapted or Uniform
        How fine the mesh is. By default as fine as the contact asks for.
    element : Element
        BIQUADRATIC (default) or BILINEAR.
    meshes : int
        2 (default) solves on a coarser mesh too and gives `contact.error`; 1 leaves that unknown, NaN.
    gap : type
        `LinearGap` (Eq. 6 of Heß & Forsbach 2021, default) or `CircularGap` (Eq. 5).
    progress : function of str
        Told in words what is about to be done. Silent by default.

    Raises
    ------
    ValueError
        A number that is not allowed; at a press, a joint that cannot be meshed, or a mesh larger than the memory.
    ImportError
        At a press: the finite elements' extra is not installed.

    References
    ----------
    The analysis is that of Heß & Forsbach (2021), doi 10.3390/app112311170. See the docs (finite elements).
    """

    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    spacing: Spacing = Adapted()  # noqa: RUF009 (frozen)
    element: Element = Element.BIQUADRATIC
    meshes: int = 2
    gap: type[LinearGap] | type[CircularGap] = LinearGap
    progress: Callable[[str], None] = field(default=_silent, compare=False, repr=False)

    def __post_init__(self) -> None:
        for name, kind in (("cup", Cup), ("spacing", Spacing), ("element", Element)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {kind}, got {getattr(self, name)!r}")
        require("meshes", self.meshes, self.meshes in (1, 2), "meshes are 1 (no error bars) or 2")
        check_gap(self.gap)

    @property
    def contact_type(self) -> type[Contact]:
        return MeshedContact

    @property
    def name(self) -> str:
        return "fem"

    @property
    def title(self) -> str:
        return f"axisymmetric finite elements, {self.element.name.lower()}"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (Source("hess2021", "section 2.3"),)

    @property
    def domain(self) -> tuple[Range, ...]:
        locked = "an incompressible liner has no bulk modulus: 0.4999 is solved"
        return (
            Range(quantity="joint.liner.poisson", symbol="ν", low=-1.0, high=0.49995, why=locked),
            Range(quantity="joint.thickness_ratio", symbol="R2/L", high=200.0, why="so thin a liner is not meshed"),
        )

    @property
    def validity(self) -> tuple[Range, ...]:
        return (CLOSE_FIT, SMALL_STRAIN) if self.gap is LinearGap else (SMALL_STRAIN,)

    @property
    def reach(self) -> str:
        return "half angles from a few elements up to the rim, at most 88°, less where the ball fills its socket before"

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        solution = taken_apart(self, joint, load, lambda one, loads: _curve(self, one).press(kind, loads))
        indentation = solution.indentation(joint, load)
        return Answer(
            laws=solution,
            force=solution.force(joint, load),
            indentation=indentation,
            converged=solution.spread(lambda piece: piece.state.unsound) != 1,
            beyond_equator=indentation < 0,
            at_rim=solution.spread(lambda piece: piece.state.at_rim) == 1,
        )


@lru_cache(maxsize=32)
def _curve(model: FiniteElement, joint: Joint) -> Curve:
    """The curve of a joint of plain numbers; kept, since more loads on it are likely."""
    _check(model, joint)
    radius, bore = float(joint.socket_radius), socket_shape(joint, model.cup).reach
    ends_at_rim = bore <= pi / 2 + 1e-12
    widest = bore if ends_at_rim else LIMIT
    classes = model.spacing.classes(widest, radius)

    @lru_cache(maxsize=2 * len(classes))
    def pair(number: int, mesh: int) -> Pair:
        coarse = model.spacing.coarse(classes[number], radius, model.element.value)
        resolution = coarse if mesh == COARSE else replace(coarse, halvings=1)
        return _pair(model, joint, resolution, min(1.2 * classes[number], widest))

    gap = model.gap(clearance=float(joint.clearance), socket_radius=radius)
    return Curve(pairs=pair, classes=classes, gap=gap, ends_at_rim=ends_at_rim, meshes=model.meshes)


def _check(model: FiniteElement, joint: Joint) -> None:
    """Raise ValueError for a geometry that cannot be meshed."""
    thicknesses = {"liner_thickness": joint.liner_thickness}
    thicknesses |= {f"backing[{number}].thickness": layer.thickness for number, layer in enumerate(joint.backing)}
    for name, thickness in thicknesses.items():
        if isinstance(model.spacing, Uniform):
            size = model.spacing.size
            require(name, thickness, thickness >= 2 * size, f"elements of {size:g} mm need two of them in a layer")
    chamfer, liner = model.cup.chamfer, float(joint.liner_thickness)
    require("chamfer", chamfer, chamfer < 0.9 * liner, f"a chamfer leaves a tenth of the liner, which is {liner:g} mm")
    bore = socket_shape(joint, model.cup).reach
    require("chamfer", chamfer, bore > model.cup.rim / 2, "a chamfer leaves half of the bore")


def _pair(model: FiniteElement, joint: Joint, resolution: Resolution, reach: float) -> Pair:
    size = mesh_size(joint, model.cup, resolution)
    check_memory(size, resolution.order)
    model.progress(f"condensing {size.elements} elements, {size.nodes} nodes")
    R1, R2, order = float(joint.ball_radius), float(joint.socket_radius), resolution.order
    angle, compliance = socket_compliance(socket_shape(joint, model.cup), resolution)
    surfaces = [Surface(angle=angle, order=order, compliance=compliance / (R2 * float(joint.liner.young)))]
    if joint.ball is not None:
        angle, compliance = ball_compliance(float(joint.ball.poisson), resolution)
        surfaces.append(Surface(angle=angle, order=order, compliance=compliance / (R1 * float(joint.ball.young))))
    return Pair(surfaces=tuple(surfaces), radius=R2, reach=reach, resolution=resolution)
