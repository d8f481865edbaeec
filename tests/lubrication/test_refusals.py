"""Films that cannot be computed are refused in one line."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.lubrication.transient import film_over_steps

from .test_film import CONTACT, JOINT, SPRINGS


def film(contact=CONTACT, **words):
    return lambda: bs.film(contact, **words)


def steps(model=SPRINGS, **words):
    usual = {"forces": [1000.0, 1500.0], "spins": [(1.5, 0.0, 0.0)] * 2, "durations": 0.05}
    return lambda: film_over_steps(model, JOINT, **usual | words)


REFUSALS = [
    (film(spin=(np.nan, 0.0, 0.0)), ValueError, r"spin\[0\] = nan is not allowed"),
    (film(spin=(0.0, np.inf, 0.0)), ValueError, r"spin\[1\] = inf is not allowed"),
    (film(spin=(1.0, 0.0)), ValueError, "spin"),
    (film(spin=[[1.0, 0.0, 0.0]]), ValueError, "one rotation rate"),
    (film(method="magic"), ValueError, "inlet"),
    (film(spin=(1e300, 0.0, 0.0)), ValueError, r"spin\[0\] = 1e\+300 is not allowed: a rotation rate"),
    (film(cell_width=2.0), ValueError, "cell_width = 2 is not allowed: a cell is 0.0035 to 0.175 rad wide"),
    (film(bs.Hertz().press(JOINT, force=1.0), method="reynolds"), ValueError, "springs"),
    (film(SPRINGS.press(JOINT, force=np.array([1.0, 2.0]))), ValueError, "single contact"),
    (film(SPRINGS.press(JOINT, force=0.0)), ValueError, "force = 0 N is not allowed"),
    (film(SPRINGS.press(replace(JOINT, clearance=0.0), force=10.0)), ValueError, "clearance = 0 mm is not allowed"),
    (film(JOINT), TypeError, "contact must be a pressed contact"),
    (film(lubricant=2.5e-3), TypeError, "lubricant must be a Lubricant"),
    (film(cell_width="2 deg"), TypeError, "cell_width must be a number"),
    *(
        (lambda name=name, value=value: bs.Lubricant(**{name: value}), TypeError, f"{name} must be")
        for name in ("viscosity", "ball_roughness", "cup_roughness", "friction")
        for value in ("1", None, [1e-3, 2e-3])
    ),
    *(
        (lambda value=value: bs.Lubricant(viscosity=value), ValueError, r"viscosity = .*: a viscosity \(Pa s\) is pos")
        for value in (np.inf, np.nan, 0.0)
    ),
    (steps(forces=[1500.0, -1.0]), ValueError, r"forces\[1\] = -1 is not allowed: a film needs a load"),
    (steps(durations=0.0), ValueError, r"durations = 0 is not allowed: a step \(s\) takes time"),
    (steps(spins=[(1.5, 0.0, 0.0)]), ValueError, r"spins of shape \(1, 3\) .* are not allowed for 2 forces"),
    (steps(spins=[(0, 0, 1.5), (0, 0, 0)]), ValueError, "does not move across the load in any step"),
    (steps(bs.Hertz()), ValueError, "method = 'reynolds' is not possible for hertz"),
    (steps(forces=[10.0, 3000.0], lubricant=bs.Lubricant(viscosity=1e-9)), ValueError, "the edge of the contact moves"),
]


@pytest.mark.parametrize(("call", "error", "message"), REFUSALS)
def test_impossible_films_are_refused_in_one_line(call, error, message):
    with pytest.raises(error, match=message) as refusal:
        call()
    assert "\n" not in str(refusal.value)
