"""Directions in the cup's frame: angles, unit vectors, tangents and frames."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.directions import (
    check_direction,
    cup_frames,
    magnitudes_and_directions,
    polar_angle,
    tangents,
    tilted_directions,
    unit_vectors,
)

POLAR, AZIMUTH = np.linspace(0.1, 3.0, 7)[:, None], np.linspace(-3.0, 3.0, 5)


def test_unit_vectors_have_their_angles():
    n = unit_vectors(POLAR, AZIMUTH)
    assert np.linalg.norm(n, axis=0) == pytest.approx(1.0)
    assert polar_angle(5.0 * n) == pytest.approx(POLAR + 0 * AZIMUTH)
    assert np.arctan2(n[1], n[0]) == pytest.approx(AZIMUTH + 0 * POLAR)
    assert n[2] == pytest.approx(np.cos(POLAR) + 0 * AZIMUTH)


def test_polar_angle_is_accurate_at_both_poles():
    assert polar_angle(np.array([[1e-9, 0.0], [0.0, 1e-9], [1.0, -1.0]])) == pytest.approx([1e-9, pi - 1e-9], rel=1e-6)


def test_tangents_form_right_handed_frames():
    n = unit_vectors(POLAR, AZIMUTH)
    first, second = tangents(n)
    for vectors in (first, second):
        assert np.linalg.norm(vectors, axis=0) == pytest.approx(1.0)
        assert (vectors * n).sum(axis=0) == pytest.approx(0.0, abs=1e-15)
    assert np.cross(first, second, axis=0) == pytest.approx(n)


def test_zero_vectors_have_zero_direction():
    vectors = np.array([[0.0, 3.0, 4.0], [0.0, 0.0, 0.0], [-2.0, 0.0, 0.0]])
    length, direction = magnitudes_and_directions(vectors)
    assert length == pytest.approx([5.0, 0.0, 2.0])
    assert direction == pytest.approx(np.array([[0.0, 0.6, 0.8], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]))


def test_directions_of_extreme_length_are_scaled():
    for scale in (1e-200, 1e-99, 1.0, 1e99, 1e200):
        checked = check_direction([[3.0 * scale, 0.0, 4.0 * scale]])
        length = np.linalg.norm(checked, axis=-1)
        assert 0 < length < np.inf
        assert checked / length[:, None] == pytest.approx(np.array([[0.6, 0.0, 0.8]]))
    assert check_direction([1e99, 0, 0])[0] == 1e99
    assert check_direction([1e101, 0, 0])[0] == pytest.approx(1.0)


def test_tilted_directions_start_at_x():
    assert tilted_directions(0.4, None) == pytest.approx([np.sin(0.4), 0.0, np.cos(0.4)])
    n = tilted_directions(np.array([0.4, 0.8]), np.array([[0.3], [2.0]]))
    assert n.shape == (2, 2, 3)
    assert n[1, 0] == pytest.approx([np.sin(0.4) * np.cos(2.0), np.sin(0.4) * np.sin(2.0), np.cos(0.4)])


def test_frames_of_many_cups_are_those_of_single_cups():
    cup = bs.Cup(inclination=0.7, anteversion=0.2, side=bs.Side.LEFT)
    inclination, anteversion = np.array([[0.3], [0.9]]), np.array([0.0, 0.4, 0.5])
    frames = cup_frames(cup, inclination, anteversion)
    assert frames.shape == (2, 3, 3, 3)
    for i in range(2):
        for j in range(3):
            single = replace(cup, inclination=float(inclination[i, 0]), anteversion=float(anteversion[j]))
            assert frames[i, j] == pytest.approx(np.array(single.frame))
    assert cup_frames(cup, None, 0.4) == pytest.approx(np.array(replace(cup, anteversion=0.4).frame))
    assert cup_frames(cup, 0.3, None) == pytest.approx(np.array(replace(cup, inclination=0.3).frame))
