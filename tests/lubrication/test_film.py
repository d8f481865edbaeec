"""Steady film of a pressed contact by its three methods: each is judged by the next one."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.validity import Status
from ballsocket.lubrication.dry_contact import dry_contact
from ballsocket.lubrication.wave import FilmWave, godunov_flow

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
SPRINGS = bs.RadialFoundation(modulus=bs.constant(276.67))
CONTACT = SPRINGS.press(JOINT, force=1500.0)


@pytest.mark.parametrize(
    ("rate", "central", "least"),
    [(10.0, 515.5, 433.0), (100.0, 1775.2, 1456.1)],
)
def test_reynolds_on_springs(rate, central, least):
    """Values of rings and meridians of half the width; they change by less than 0.2 %.

    A prototype with rings of 2 degrees has 535 and 441.6 nm, and 1857 and 1490 nm. Its own rings of 0.25 degrees have
    1792 nm: upwind differences of first order.
    """
    film = bs.film(CONTACT, spin=(rate, 0.0, 0.0), method="reynolds")
    assert film.status is Status.OK
    assert film.valid
    assert 1e6 * film.central == pytest.approx(central, rel=0.005)
    assert 1e6 * film.minimum == pytest.approx(least, rel=0.005)
    load = (film.pressure * film.areas) @ film.directions
    assert load == pytest.approx([0.0, 0.0, 1500.0], abs=1e-3)


@pytest.mark.parametrize("rate", [0.1, 10.0])
def test_the_wave_keeps_its_stated_error(rate):
    wave, judge = (bs.film(CONTACT, spin=(rate, 0.0, 0.0), method=method) for method in ("wave", "reynolds"))
    assert wave.central == pytest.approx(judge.central, rel=max(wave.error, 0.03))
    assert wave.minimum == pytest.approx(judge.minimum, rel=max(wave.error, 0.03))


def test_the_film_pressure_tends_to_the_dry_one():
    film = bs.film(CONTACT, spin=(0.1, 0.0, 0.0), method="reynolds")
    assert film.pressure.max() == pytest.approx(CONTACT.max_pressure, rel=0.005)


def test_wave_films_on_springs_scale_with_the_root_of_viscosity_and_speed():
    """One map of shape for each dry contact: 155.8 and 131.4 nm per root of rad/s in the limit of small cells."""
    slow, fast = (bs.film(CONTACT, spin=(rate, 0.0, 0.0), cell_width=radians(4.0)) for rate in (1.0, 4.0))
    assert fast.thickness[fast.dry.inside] == pytest.approx(2 * slow.thickness[slow.dry.inside], rel=1e-9)
    fine = bs.film(CONTACT, spin=(1.0, 0.0, 0.0), cell_width=radians(1.5))
    assert 1e6 * fine.central == pytest.approx(155.8, rel=0.015)
    assert 1e6 * fine.minimum == pytest.approx(131.4, rel=0.02)


def test_the_direction_of_the_motion_turns_the_map():
    along, across = bs.film(CONTACT, spin=(2.0, 0.0, 0.0)), bs.film(CONTACT, spin=(0.0, 2.0, 0.0))
    assert along.central == pytest.approx(across.central, rel=0.005)
    assert along.minimum == pytest.approx(across.minimum, rel=0.005)


def test_reynolds_on_elastic_bodies_confirms_the_wave():
    """Central 468 and least 285 nm; with 48 meridians in place of 40 they are 467 and 288 nm."""
    contact = bs.Exact().press(JOINT, force=1500.0)
    judge, wave = (bs.film(contact, spin=(10.0, 0.0, 0.0), method=method) for method in ("reynolds", "wave"))
    assert judge.status is Status.OK
    assert 1e6 * judge.central == pytest.approx(467.5, rel=0.01)
    assert wave.central == pytest.approx(judge.central, rel=wave.error)
    assert wave.minimum == pytest.approx(judge.minimum, rel=wave.error)
    assert (judge.pressure * judge.areas) @ judge.directions == pytest.approx([0.0, 0.0, 1500.0], abs=0.01)


def test_film_at_the_exact_contact_loses_little_on_its_way():
    contact = bs.Exact().press(JOINT, force=1500.0)
    inlet, wave = (bs.film(contact, method=method) for method in ("inlet", "wave"))
    assert wave.central == pytest.approx(inlet.central, rel=inlet.error)
    assert wave.central < inlet.central
    assert wave.valid
    assert not inlet.valid


@pytest.mark.parametrize(
    "surface", [bs.Springs(modulus=bs.constant(276.67)), bs.ClosedShell()], ids=["springs", "shell"]
)
def test_a_tilted_load_has_the_film_of_an_axial_one(surface):
    """The axis of rotation is tilted with the load: the same contact, on cells that cut its edge."""
    tilt = 0.5
    model = bs.Sphere(surface=surface)
    axial = bs.film(CONTACT if surface.edge_exponent == 1 else bs.Exact().press(JOINT, force=1500.0))
    tilted = bs.film(model.press(JOINT, force=1500.0, tilt=tilt), spin=(0.0, 1.5, 0.0))
    assert tilted.central == pytest.approx(axial.central, rel=0.03)


def test_a_contact_at_the_rim_says_that_its_inlet_is_starved():
    contact = bs.Sphere().press(JOINT, force=3000.0, tilt=radians(70.0))
    film = bs.film(contact)
    assert contact.edge_loaded
    assert not film.valid
    assert any("rim cuts the contact" in note for note in film.notes)


@pytest.mark.parametrize("method", ["inlet", "wave", "reynolds"])
@pytest.mark.parametrize("spin", [(0.0, 0.0, 2.0), (0.0, 0.0, 0.0)])
def test_a_ball_that_turns_about_its_load_has_no_steady_film(method, spin):
    film = bs.film(CONTACT, spin=spin, method=method)
    assert film.central == film.minimum == film.ratio == 0.0
    assert not film.valid
    assert any("no lubricant enters" in note for note in film.notes)


def test_a_film_at_rest_is_squeezed_out_with_the_root_of_time():
    """On springs h ~ t^(-1/2) once the first film is forgotten."""
    dry = dry_contact(CONTACT, radians(2.0))
    wave = FilmWave(contact=dry, viscosity=2.5e-9, spin=np.zeros(3), flood=1e-3)
    early = wave.advance(np.full(dry.mesh.cells, 1e-3), 2.0)
    late = wave.advance(early, 6.0)
    assert late[dry.inside].mean() == pytest.approx(early[dry.inside].mean() / 2, rel=0.02)


def test_a_film_starts_up_from_the_inlet():
    """A dry contact fills while the ball turns by its width."""
    dry = dry_contact(CONTACT, radians(2.0))
    wave = FilmWave(contact=dry, viscosity=2.5e-9, spin=np.array([1.5, 0.0, 0.0]))
    steady, _ = wave.solve_steady()
    first = wave.advance(np.zeros(dry.mesh.cells), 0.3)
    assert 0.2 < (first > steady / 2)[dry.inside].mean() < 0.8
    late = wave.advance(first, 6.0)
    assert late[dry.inside] == pytest.approx(steady[dry.inside], rel=0.02)


def test_godunovs_flow_is_that_of_the_film_between():
    """The least or largest flow between two films, by a search."""
    random = np.random.default_rng(1)
    carried, pressed = random.normal(size=(2, 200))
    upstream, downstream = random.uniform(0.0, 2.0, size=(2, 200))
    between = upstream + (downstream - upstream) * np.linspace(0.0, 1.0, 4001)[:, None]
    flow = carried * between - pressed * between**3
    expected = np.where(upstream <= downstream, flow.min(axis=0), flow.max(axis=0))
    assert godunov_flow(carried, pressed, upstream, downstream) == pytest.approx(expected, abs=1e-5)


def test_a_film_that_does_not_become_steady_is_returned_with_its_status(monkeypatch):
    from ballsocket.lubrication import film as module

    state = module.develop_film
    monkeypatch.setattr(module, "develop_film", lambda *words: replace(state(*words), converged=False))
    film = bs.film(CONTACT, method="reynolds")
    assert film.status is Status.NOT_CONVERGED
    assert film.central > 0
    assert not film.valid


@pytest.mark.parametrize(
    ("contact", "words", "message"),
    [
        (CONTACT, {"spin": (np.nan, 0.0, 0.0)}, r"spin\[0\] = nan is not allowed"),
        (CONTACT, {"spin": (1.0, 0.0)}, "spin"),
        (CONTACT, {"spin": [[1.0, 0.0, 0.0]]}, "one rotation rate"),
        (CONTACT, {"method": "magic"}, "inlet"),
        (CONTACT, {"cell_width": 1.0}, "cell_width = 1 is not allowed"),
        (bs.Hertz().press(JOINT, force=1.0), {"method": "reynolds"}, "springs"),
        (SPRINGS.press(JOINT, force=np.array([1.0, 2.0])), {}, "single contact"),
        (SPRINGS.press(JOINT, force=0.0), {}, "force = 0 N is not allowed"),
        (SPRINGS.press(replace(JOINT, clearance=0.0), force=10.0), {}, "clearance = 0 mm is not allowed"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(contact, words, message):
    with pytest.raises(ValueError, match=message) as refusal:
        bs.film(contact, **words)
    assert "\n" not in str(refusal.value)


def test_other_objects_are_refused():
    with pytest.raises(TypeError, match="contact must be a pressed contact"):
        bs.film(JOINT)
    with pytest.raises(TypeError, match="lubricant must be a Lubricant"):
        bs.film(CONTACT, lubricant=2.5e-3)
    with pytest.raises(ValueError, match="viscosity = inf is not allowed"):
        bs.Lubricant(viscosity=np.inf)
