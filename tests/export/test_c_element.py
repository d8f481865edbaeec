"""The element in C: the same numbers as the element in Python."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, ForceElement, Friction, Prony
from ballsocket.export import CElement
from ballsocket.export.tunable import reason_of_fixed_joint
from ballsocket.model_catalogue import listed_models, named_model
from ballsocket.models.closed_form import ClosedForm

from ..extent import either, some
from ..joints import HIP
from .library import Library, needs_compiler

LOSSES = {
    "damping": Damping(hysteresis=0.004, time=0.002),
    "friction": Friction(coefficient=0.05, static_coefficient=0.08, viscous=1e-4),
}
FILM = {"lubricant": bs.Lubricant(), "film_tension": 0.1}
CUP = bs.Cup(inclination=0.7, anteversion=0.2)
ELEMENTS = {
    "springs of a cup": lambda: ForceElement(bs.Bartel(), HIP, **LOSSES, **FILM, cup=CUP, smoothing=0.02),
    "springs": lambda: ForceElement(bs.HessForsbach(), HIP, **LOSSES),
    "wet springs": lambda: ForceElement(bs.HessForsbach(), HIP, **LOSSES, lubricant=bs.Lubricant()),
    "formula": lambda: ForceElement(bs.Hertz(), HIP, **LOSSES),
    "curve": lambda: ForceElement(bs.Tabulated(), HIP, **LOSSES, cup=CUP),
}
pytestmark = needs_compiler


@pytest.fixture(scope="module", params=some(reversed(ELEMENTS), 2))
def element(request):
    return ELEMENTS[request.param]()


@pytest.fixture(scope="module")
def library(element, tmp_path_factory):
    return Library(element, tmp_path_factory.mktemp("library"))


def drawn_states(count, seed=1):
    """Apart, touching lightly and deep, at the rim and beyond it; in all directions."""
    draw = np.random.default_rng(seed)
    way = draw.normal(size=(count, 3))
    depth = np.exp(draw.uniform(np.log(1e-6), np.log(1.0), count)) * draw.choice([-0.1, 1.0, 1.0], count)
    position = way / np.linalg.norm(way, axis=1)[:, None] * (HIP.clearance + depth)[:, None]
    return position, draw.normal(size=(count, 3)) * 30.0, draw.normal(size=(count, 3)) * 3.0


def close(got, wanted, scale):
    assert_allclose(got, wanted, rtol=1e-12, atol=1e-12 * scale)


def test_random_states_have_the_load_contact_and_tangent_of_the_python_element(element, library):
    statuses = [library.check(element, *state) for state in zip(*drawn_states(either(300, 1000)), strict=True)]
    touched = len(statuses) - statuses.count(ContactState.FREE)
    assert touched > either(150, 500)


def test_slopes_equal_finite_differences(library):
    draw = np.random.default_rng(2)
    for state in zip(*drawn_states(30, seed=3), strict=True):
        if library.load(*state)[0] not in (ContactState.CONTACT, ContactState.AT_RIM):
            continue
        way = draw.normal(size=9) * [1, 1, 1, 100, 100, 100, 10, 10, 10]
        step = 1e-6 * abs(np.linalg.norm(state[0]) - HIP.clearance)

        def answers(by, state=state, way=way):
            moved = [part + by * way[3 * n : 3 * n + 3] for n, part in enumerate(state)]
            return np.concatenate([*library.load(*moved)[1:], *library.contact(moved[0])[1:]])

        difference = (answers(step) - answers(-step)) / (2 * step)
        rounding = 1e-15 * np.abs(answers(0.0)) / step
        _, slope = library.slope(*state, way)
        for part in (slice(0, 3), slice(3, 6), slice(6, 7), slice(7, 8), slice(8, 9)):
            size = np.linalg.norm(slope[part])
            assert_allclose(slope[part], difference[part], rtol=2e-6, atol=2e-6 * size + 20 * max(rounding[part]))


@pytest.mark.parametrize("place", [0, 4, 8])
def test_a_state_of_nan_has_a_status(library, place):
    state = np.full(9, 0.08)
    state[place] = np.nan
    status, force, moment, energy = library.load(*state.reshape(3, 3))
    assert status == ContactState.NO_NUMBER
    assert np.isnan([*force, *moment, *energy]).all()
    far = (0.0, 0.0, 1e200), (0.0,) * 3, (0.0,) * 3  # too large to square
    for turned in (0, 1, 2):
        assert library.load(*far[-turned:], *far[:-turned])[0] == ContactState.NO_NUMBER
    assert library.contact(far[0])[0] == library.tangent(far[0])[0] == ContactState.NO_NUMBER


def test_beyond_its_range_the_force_goes_on_with_its_last_stiffness(plain):
    """F = F(w) + k(w) x and U = U(w) + F(w) x + k(w) x²/2 at x beyond the wall w."""
    element = ForceElement(bs.HessForsbach(), HIP)
    energy, force, stiffness = element.potential(element.wall)
    for x in (1e-6, 0.5, 30.0):
        position = (0.0, 0.0, -(HIP.clearance + element.wall + x))
        status, found, moment, work = plain.load(position, (0.0,) * 3, (0.0,) * 3)
        assert status == ContactState.THROUGH_WALL
        assert_allclose(found, (0.0, 0.0, force + stiffness * x), rtol=1e-12)
        assert_allclose(work, energy + force * x + 0.5 * stiffness * x * x, rtol=1e-12)
        assert_allclose(moment, 0.0)
        assert_allclose(plain.tangent(position)[1][8], stiffness, rtol=1e-12)


@pytest.mark.long
def test_an_element_that_stops_has_no_force_through_the_wall(element, tmp_path):
    status, force, *_ = Library(element, tmp_path, beyond="stop").load((0.0, 0.0, 9.0), (0.0,) * 3, (0.0,) * 3)
    assert status == ContactState.THROUGH_WALL
    assert np.isnan(force).all()


def test_an_iterative_law_is_exported_as_a_curve(tmp_path):
    solved = ForceElement(bs.HessForsbach(), HIP)
    formula = solved.potential
    object.__setattr__(solved, "potential", lambda depth: formula(np.asarray(depth, dtype=float)))
    assert set(CElement(element=solved).recording.curves) == {"energy_curve", "half_angle_curve", "max_pressure_curve"}
    library = Library(solved, tmp_path)
    for depth in (1e-6, 1e-3, 0.05):
        state = (0.0, 0.0, HIP.clearance + depth), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        assert_allclose(library.load(*state)[1][2], -formula(state[0][2] - HIP.clearance)[1], rtol=1e-9)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return Library(ForceElement(bs.HessForsbach(), HIP), tmp_path_factory.mktemp("plain"))


def test_losses_can_be_tuned_to_parameters_that_are_allowed(plain):
    tuned = ELEMENTS["springs"]()
    state = (0.0, 0.03, 0.12), (5.0, 1.0, 20.0), (0.0, 1.0, 2.0)
    plain.parameters[:7] = (0.004, 0.002, 0.05, 0.08, 0.1, 10.0, 1e-4)
    close(np.concatenate(plain.load(*state)[1:3]), np.concatenate(tuned(*state)[:2]), 1e3)
    plain.parameters[:] = plain.defaults
    assert plain.load(*state)[2].tolist() == [0.0, 0.0, 0.0]
    assert plain.complaint() is None
    plain.parameters[2] = -0.1
    assert plain.complaint() == b"friction_coefficient must be finite and 0 or more"
    plain.parameters[:] = plain.defaults


FORMULAS = [name for name, model in listed_models.items() if isinstance(model, ClosedForm) and name != "adhesive"]
JOINT = {"ball_radius": 15.0, "clearance": 0.3, "liner_thickness": 6.0, "liner_modulus": 1500.0}


@pytest.mark.parametrize("name", some(FORMULAS, 2))
def test_the_joint_of_a_formula_can_be_changed(name, tmp_path):
    model = named_model(name)
    library = Library(ForceElement(model, HIP, **LOSSES), tmp_path)
    library.parameters[-4:] = tuple(JOINT.values())
    lengths = {key: JOINT[key] for key in list(JOINT)[:3]}
    joint = HIP.replace(**lengths, liner=replace(HIP.liner, young=JOINT["liner_modulus"]))
    element = ForceElement(model, joint, **LOSSES)
    for depth in (-0.2, 1e-4, 0.01, 0.2, 1.0):
        state = (0.0, 0.6 * (0.3 + depth), 0.8 * (0.3 + depth)), (5.0, 1.0, 20.0), (0.0, 1.0, 2.0)
        library.check(element, *state)
    deepest = element.valid_depth
    assert library.valid((0.0, 0.0, 0.3 + 0.9 * deepest))  # at first touch a model counts as valid
    if name != "cosine-limit":  # small contacts count as valid, and its limits exclude each other in this joint
        assert not library.valid((0.0, 0.0, 0.3 + (1.1 * deepest or 0.01)))


UNYIELDING = HIP.replace(liner=replace(HIP.liner, yield_stress=None))  # whose validity needs no ratio of stresses
SUSPENSION = bs.joints["suspension-ball-joint"]


@pytest.mark.parametrize(
    ("name", "joint", "factors"),
    some(
        [
            ("hess-forsbach", UNYIELDING, (2.0, 2.5)),
            ("bonded-layer", UNYIELDING, (1.0, 0.3)),
            ("vessel", UNYIELDING, (2.0, 2.5)),
            ("bartel", UNYIELDING, (1.0, 2.5)),
            ("hertz", UNYIELDING, (2.0, 1.0)),
            ("hertz", SUSPENSION, (2.0, 1.0)),
        ],
        6,
    ),
)
def test_a_changed_joint_is_valid_where_its_own_export_is(name, joint, factors, tmp_path):
    clearance, thickness = joint.clearance * factors[0], joint.liner_thickness * factors[1]
    element = ForceElement(named_model(name), joint.replace(clearance=clearance, liner_thickness=thickness))
    own = Library(element, tmp_path, name="own")
    tuned = Library(ForceElement(named_model(name), joint), tmp_path)
    tuned.parameters[:] = own.defaults
    positions = [(0.0, 0.0, clearance + depth) for depth in np.geomspace(1e-6, 1.05, 200) * element.wall]
    valid = [own.valid(position) for position in positions]
    assert [tuned.valid(position) for position in positions] == valid
    assert not valid[-1]
    assert any(valid)


def test_a_joint_without_a_law_is_refused(tmp_path):
    library = Library(ForceElement(bs.Hertz(), HIP, smoothing=0.02), tmp_path)
    for name, value, text in (
        ("clearance", HIP.clearance, None),
        ("clearance", 0.0, b"hertz has no answer outside c"),
        ("clearance", 0.01, b"clearance must be at least the smoothing, 0.02 mm"),
        ("ball_radius", 0.0, b"ball_radius must be finite and above 0"),
    ):
        library.parameters[:] = library.defaults
        library.parameters[library.names.index(name)] = value
        found = library.complaint()
        assert found == text or found.startswith(text)


def test_the_joint_is_fixed_where_the_law_is_that_of_one_joint():
    def iterated(joint):
        """Modulus by a loop that depends on the joint."""
        return next(modulus for modulus in (100.0, 200.0, 300.0) if modulus > 10.0 * joint.liner_thickness)

    for element, reason in (
        (ForceElement(bs.Tabulated(), HIP), "the law of tabulated is computed for this joint"),
        (ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant()), "film of the lubricant"),
        (ForceElement(bs.RadialFoundation(modulus=iterated), HIP), "the law of iterated-linear is computed"),
    ):
        assert reason in reason_of_fixed_joint(element)
        assert len(CElement(element=element).tunables) == 7


BRISTLES = Bristles(coefficient=0.05, static_coefficient=0.08, damping=0.01, viscous=1e-4)
WITH_STATES = {
    "bristles": ForceElement(bs.HessForsbach(), HIP, LOSSES["damping"], BRISTLES, CUP),
    "liner": ForceElement(bs.Tabulated(), HIP, LOSSES["damping"], relaxation=Prony(terms=((0.4, 0.1),))),
    "both": ForceElement(bs.HessForsbach(), HIP, friction=BRISTLES, relaxation=Prony(terms=((0.3, 0.1), (0.2, 9.0)))),
}


@pytest.mark.parametrize("name", WITH_STATES)
def test_an_element_with_states_has_the_load_and_rates_of_the_python_element(name, tmp_path):
    element = WITH_STATES[name]
    values = {"deflection": (1e-4, 2e-4, -1e-4, 3e-4), "relaxed_force": (300.0, 200.0)}
    internal = {each: values[each][:count] for each, count in element.internal_states.items()}
    library, sizes = Library(element, tmp_path), element.internal_states.values()
    for depth in (-0.01, 1e-4, 0.05):  # at the second depth a relaxed liner does not touch the ball
        distance = HIP.clearance + depth
        state = (0.0, 0.6 * distance, 0.8 * distance), (5.0, 1.0, 20.0), (0.0, 1.0, 2.0)
        wanted = element(*state, **internal)
        found = library._call("load", [*state, *internal.values()], 3, 3, 1, *sizes)
        rates = (getattr(wanted, f"{each}_rate") for each in internal)
        for got, answer in zip(found[1:], (wanted.force, wanted.moment, wanted.energy, *rates), strict=True):
            close(got, answer, np.linalg.norm(answer))
        liner = [internal[each] for each in internal if each == "relaxed_force"]
        close(
            library._call("tangent", [state[0], *liner], 9)[1], np.ravel(wanted.tangent), np.abs(wanted.tangent).max()
        )
    for each, numbers in internal.items():
        lost = internal | {each: (np.nan, *numbers[1:])}
        found = library._call("load", [*state, *lost.values()], 3, 3, 1, *sizes)
        assert found[0] == ContactState.NO_NUMBER
        assert np.isnan(np.concatenate(found[1:])).all()


def test_a_header_explains_the_internal_states_that_it_has():
    for element in (ForceElement(bs.HessForsbach(), HIP), *WITH_STATES.values()):
        header = CElement(element=element).header
        assert ("ristles" in header, "Relaxed forces" in header) == tuple(
            each in element.internal_states for each in ("deflection", "relaxed_force")
        )


def test_names_are_those_that_c_allows_and_neither_open_nor_close_a_comment():
    for name in ("", "two words", "1st", "a-b"):
        with pytest.raises(ValueError, match="name must start with a letter"):
            CElement(element=ForceElement(bs.HessForsbach(), HIP), name=name)
    element = ForceElement(bs.HessForsbach(), replace(HIP, name="a /* b */ c /*/ d"))
    assert "a ? b ? c ?/ d" in CElement(element=element, name="joint").about["joint"]
