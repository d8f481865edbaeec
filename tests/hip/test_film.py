"""Film, friction and the distance to the rim over a cycle."""

import json
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Cycle, Lubricant, flexion
from ballsocket.hip.film import film_thickness

from .test_wear import hip


def test_film_of_a_hip_is_in_the_published_range():
    joint = bs.Joint(
        ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.Material(young=1000.0, poisson=0.4), ball=bs.COCR
    )
    least, central = film_thickness(joint, np.array(2500.0), np.array(1.5), 2.5e-3)
    assert 1e6 * least == pytest.approx(72, abs=0.5)
    assert 1e6 * central == pytest.approx(139, abs=0.5)


def test_film_scales_equally_with_speed_and_viscosity():
    joint, force = hip().joint, np.array(2500.0)
    films = [
        film_thickness(joint, force, np.array(w), eta)[0] for w, eta in ((1.5, 2.5e-3), (1.5, 5e-3), (3.0, 2.5e-3))
    ]
    assert films[1] == pytest.approx(films[2], rel=1e-12)
    assert films[1] / films[0] == pytest.approx(2**0.65, rel=1e-12)


def test_power_of_the_moment_equals_the_friction_power():
    use = hip()
    film = use.film(Lubricant(friction=0.1))
    assert 1e-3 * np.einsum("tk,tk->", film.moment, use.rotation_increments) == pytest.approx(film.heat, rel=1e-12)
    assert film.heat == pytest.approx(0.1 * use.first.work, rel=1e-12)
    assert film.power.mean() * use.cycle.duration == pytest.approx(film.heat, rel=1e-12)


def test_json_has_the_largest_moment_vector():
    """Flexion turns about the side: so does its moment, in the cup's frame across the tilt."""
    use = hip(cycle=flexion(72))
    told = use.film(Lubricant()).summary()
    vector = np.array(told["moment_on_cup_Nmm"])
    assert np.linalg.norm(vector) == pytest.approx(told["moment_Nmm"], rel=1e-12)
    aside = np.array(use.placed.frame) @ [1.0, 0.0, 0.0]
    assert abs(vector @ aside) == pytest.approx(told["moment_Nmm"], rel=0.02)


def test_moment_lies_between_bounds_of_force_and_pressure():
    """μ R F for a contact that is a point, and less than μ R ∫ p dA."""
    use = hip()
    film, size = use.film(Lubricant(friction=0.05)), use.cycle.force_magnitudes
    moment = np.linalg.norm(film.moment, axis=1)
    whole = (use.unworn.pressure @ use.foundation.areas) * 0.05 * 14.0
    assert (moment < whole).all()
    assert (moment > 0.5 * 0.05 * 14.0 * size).all()


def test_smooth_surfaces_have_a_full_film():
    use = hip()
    assert use.film(Lubricant(ball_roughness=1e-6, cup_roughness=1e-6)).regime == "full"
    assert use.film(Lubricant()).regime == "boundary"


def test_film_is_carried_over_the_cycle_and_compared_with_the_formula():
    use = hip()
    wave, formula = use.film(method="wave"), use.film()
    assert wave.method == "wave"
    assert wave.thickness.shape == use.unworn.pressure.shape
    assert np.isnan(wave.thickness[use.unworn.pressure == 0]).mean() > 0.9
    assert wave.comparison == pytest.approx(formula.least, rel=1e-12)
    assert formula.note.startswith("Hamrock and Dowson")
    assert formula.method == "hamrock-dowson"


def test_walking_does_not_refresh_the_middle_of_the_contact():
    """The film is squeezed to 21 nm in 100 cycles, on any width of the cells, and is not marked as valid."""
    film = hip().film(method="wave")
    assert 1e6 * film.least.min() == pytest.approx(21.0, rel=0.03)
    assert film.unreached > 0.2
    assert not film.valid
    assert "fresh lubricant does not reach" in film.note


def test_a_still_ball_has_no_film():
    still = Cycle(
        name="still",
        force=lambda phase: np.stack([0 * phase, 0 * phase, 1000.0 + 0 * phase]),
        angles=lambda phase: np.zeros((3, *phase.shape)),
    )
    assert hip(cycle=still).film(method="wave").least == pytest.approx(0.0)


@pytest.mark.parametrize("words", [{"viscosity": 0.0}, {"friction": -0.1}, {"cup_roughness": np.inf}])
def test_invalid_lubricants_are_refused(words):
    with pytest.raises(ValueError, match=f"{next(iter(words))} = .* is not allowed"):
        Lubricant(**words)


def test_edge_distance_equals_the_closed_form():
    use = hip()
    contact = bs.HessForsbach().press(use.joint, force=use.cycle.force_magnitudes)
    expected = use.cup.edge_distance(use.joint.socket_radius, contact.half_angle)
    assert use.edge_distance(use.unworn) == pytest.approx(expected, abs=0.05)


def test_contact_at_the_rim_is_noted_with_its_instant():
    history = hip(cup=bs.Cup(inclination=radians(60.0))).after(1e5)
    assert history.last.edge_distance.min() == 0
    note = next(note for note in history.notes if note.startswith("edge loading: in the first cycle"))
    assert "of 72 instants, most at 11.8 % of the cycle, 0° from the cup's uppermost point" in note
    edge = history.summary()["history"][-1]["edge"]
    assert (edge["distance_mm"], edge["place_deg"]) == (0.0, pytest.approx(0.0, abs=0.1))
    assert 0 < edge["pressure_at_rim_MPa"] < history.last.max_pressure
    first = history.summary()["cycle"]["edge"]["pressure_at_rim_MPa"]
    assert f"the pressure in the outermost ring is at most {first:.3g} MPa" in note


@pytest.mark.parametrize("surface", [bs.Springs(), bs.ClosedShell()], ids=["springs", "shell"])
def test_edge_distance_decreases_continuously_to_zero(surface):
    """One load at tilts by 0.5°: each moves the edge by at most 0.26 mm, and a shell's as `Sphere` has it."""
    tilts = np.radians(np.arange(36.0, 56.0, 0.5))
    loads = 1500.0 * np.stack([np.sin(tilts), 0 * tilts, np.cos(tilts)])
    cycle = Cycle(name="tilting", force=lambda t: loads, angles=flexion().angles, n_steps=len(tilts))
    use = hip(cycle=cycle, cup=bs.Cup(), surface=surface)
    distance = use.edge_distance(use.unworn)
    steps = np.diff(distance[distance > 0])
    assert len(steps) > 10
    assert steps.max() < 0
    assert abs(steps).max() < 0.26
    assert distance[distance > 0].min() < 0.26
    model = bs.Sphere(cup=bs.Cup(), surface=surface)
    expected = model.press(use.joint, force=1500.0, tilt=tilts[:10:3]).edge_distance
    assert distance[:10:3] == pytest.approx(expected, abs=0.1)


def test_edge_azimuth_follows_the_load():
    """Seen along the cup's axis: 40° around it, new, at every load."""
    lean = np.array([np.cos(radians(40.0)), np.sin(radians(40.0)), 1.0])
    use = hip(
        cycle=Cycle(name="leaning", force=lambda t: np.outer(lean, 800 + 600 * t), angles=flexion().angles),
        cup=bs.Cup(),
    )
    edge = use.edge(use.unworn)
    assert np.degrees(edge.azimuth) == pytest.approx(40.0, abs=2.0)
    assert edge.closest_approach(use).step_description == "99.5 % of the cycle"


@pytest.mark.parametrize(
    ("words", "lubricant", "missing"),
    [
        ({"clearance": 0.0}, Lubricant(), "least_nm"),
        ({}, Lubricant(ball_roughness=0.0, cup_roughness=0.0), "lambda_largest"),
    ],
)
def test_missing_films_are_null_in_json(words, lubricant, missing):
    told = hip(**words).after(1e4, lubricant=lubricant).summary()
    assert told["film"][missing] is None
    assert told["film"]["heat_J_per_cycle"] > 0
    json.dumps(told, allow_nan=False)
