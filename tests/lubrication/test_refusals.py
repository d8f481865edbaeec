"""Films that cannot be computed are refused in one line."""

from dataclasses import replace

import numpy as np

import ballsocket as bs
from ballsocket.lubrication.transient import film_over_steps

from ..refusals import refused_calls
from .test_film import CONTACT, JOINT, SPRINGS


def film(contact=CONTACT, **words):
    return lambda: bs.film(contact, **words)


def steps(model=SPRINGS, **words):
    usual = {"forces": [1000.0, 1500.0], "spins": [(1.5, 0.0, 0.0)] * 2, "durations": 0.05}
    return lambda: film_over_steps(model, JOINT, **usual | words)


LUBRICANTS = {"viscosity": (np.inf, np.nan, 0.0), "cup_roughness": (-1e-9, np.inf), "friction": (-1e-9, 10.0)}

test_films_that_cannot_be_computed_are_refused = refused_calls(
    (film(spin=(np.nan, 0.0, 0.0)), r"spin\[0\] = nan is not allowed"),
    (film(spin=(0.0, np.inf, 0.0)), r"spin\[1\] = inf is not allowed"),
    (film(spin=(1.0, 0.0)), "spin"),
    (film(spin=[[1.0, 0.0, 0.0]]), "one rotation rate"),
    (film(method="magic"), "inlet"),
    (film(spin=(1e300, 0.0, 0.0)), r"spin\[0\] = 1e\+300 is not allowed: a rotation rate"),
    (film(cell_width=2.0), "cell_width = 2 is not allowed: a cell is 0.0035 to 0.175 rad wide"),
    (film(bs.Hertz().press(JOINT, force=1.0), method="reynolds"), "springs"),
    (film(SPRINGS.press(JOINT, force=np.array([1.0, 2.0]))), "single contact"),
    (film(SPRINGS.press(JOINT, force=0.0)), "force = 0 N is not allowed"),
    (film(SPRINGS.press(replace(JOINT, clearance=0.0), force=10.0)), "clearance = 0 mm is not allowed"),
    *(
        (lambda name=name, value=value: bs.Lubricant(**{name: value}), f"{name} = .* is not allowed: a ")
        for name, values in LUBRICANTS.items()
        for value in values
    ),
    (steps(forces=[1500.0, -1.0]), r"forces\[1\] = -1 is not allowed: a film needs a load"),
    (steps(durations=0.0), r"durations = 0 is not allowed: a step \(s\) takes time"),
    (steps(spins=[(1.5, 0.0, 0.0)]), r"spins of shape \(1, 3\) .* are not allowed for 2 forces"),
    (steps(spins=[(0, 0, 1.5), (0, 0, 0)]), "does not move across the load in any step"),
    (steps(bs.Hertz()), "method = 'reynolds' is not possible for hertz"),
    (steps(forces=[10.0, 3000.0], lubricant=bs.Lubricant(viscosity=1e-9)), "the edge of the contact moves"),
)

test_arguments_of_another_kind_are_refused = refused_calls(
    (film(JOINT), "contact must be a pressed contact"),
    (film(lubricant=2.5e-3), "lubricant must be a Lubricant"),
    (film(cell_width="2 deg"), "cell_width must be a number"),
    *(
        (lambda name=name, value=value: bs.Lubricant(**{name: value}), f"{name} must be")
        for name in ("viscosity", "ball_roughness", "cup_roughness", "friction")
        for value in ("1", None, [1e-3, 2e-3])
    ),
    error=TypeError,
)
