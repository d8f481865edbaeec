"""Impossible measurements, unknowns, machines and options: each is refused with the reason."""

from math import inf, nan

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import HeavyTailed, Machine, Measured, oscillation, sliding_torque
from ballsocket.identify.misfit import by_tracing
from ballsocket.identify.synthetic import trials
from ballsocket.identify.unknowns import collect_unknowns

from .rigid import JOINT, MODEL

FORCE = [100.0, 400.0, 900.0]
CLEARANCE, YOUNG = {"clearance": (0.02, 0.3)}, {"liner.young": (400.0, 2000.0)}


def measured(quantity="indentation", values=(0.01, 0.02, 0.03), force=FORCE, uncertainty=1e-3, **settings):
    return Measured(quantity=quantity, values=values, uncertainty=uncertainty, force=force, **settings)


def identified(free=CLEARANCE, model=MODEL, joint=JOINT, data=None, **options):
    return bs.identify(model, joint, measured() if data is None else data, free, **options)


def unknowns(free, *machines):
    return collect_unknowns(free, machines, MODEL)


def torques():
    return measured("friction_torque", observable=sliding_torque())


@pytest.mark.parametrize(
    ("call", "message"),
    [
        # numbers of a set of measurements
        (lambda: measured(uncertainty=[1e-3, nan, 1e-3]), "indentation_uncertainty has no number in row 2"),
        (lambda: measured(uncertainty=inf), "indentation_uncertainty.* an uncertainty is above 0 and finite"),
        (lambda: measured(uncertainty=-1e-3), r"indentation_uncertainty\[0\] = -0.001 .*an uncertainty is above"),
        (lambda: measured(name="film", uncertainty=0.0), r"film: indentation_uncertainty\[0\] = 0 \(and 2 more\)"),
        (lambda: measured(order=[nan, 1.0, 2.0]), "order has no number in row 1"),
        (lambda: measured(order=[0.0, inf, 2.0]), r"order\[1\] = inf is not allowed: numbers of readings must be fin"),
        (lambda: measured(order=[1, 2]), "order must have 1 or 3 numbers, got 2"),
        (lambda: measured(values=[nan, 0.02, nan]), "indentation has no number in row 1, 3: add it, or omit the row"),
        (lambda: measured(values=[nan] * 12, force=[1.0] * 12), "no number in row 1, 2, 3, 4, 5, 6, 7, 8: add it"),
        (lambda: measured(values=[[0.01, 0.02]]), r"indentation of shape \(1, 2\) must be a row of numbers"),
        (lambda: measured(values=[]), r"indentation of shape \(0,\) must be a row of numbers"),
        (lambda: measured(values=["thick", "thin", "flat"]), "indentation = .* must be numbers"),
        (lambda: measured(values=np.array([0.02 + 1j])), "indentation.* must be numbers"),
        (lambda: measured(values=[10**400, 0.03]), "indentation.* must be numbers"),
        (lambda: measured(values=[-0.01, 0.02, 0.03]), r"indentation\[0\] = -0.01 is not allowed: an indentation"),
        (lambda: measured("displacement", values=-0.01, force=1.0), "positive into the socket and 0 at first touch"),
        (lambda: measured("stiffness", values=[1.0, -2.0, 3.0]), r"stiffness\[1\] = -2 .*the value must be 0 or more"),
        (lambda: measured("energy", values=[1.0, inf, 3.0]), r"energy\[1\] = inf .*the value must be 0 or more"),
        (lambda: measured("half_angle", values=30.0), r"half_angle\[0\] = 30 is not allowed: a half angle"),
        (lambda: measured(force=[100.0, nan, 300.0]), "force has no number in row 2"),
        (lambda: measured(force=[100.0, 200.0]), "force must have 1 or 3 numbers, got 2"),
        (lambda: measured(force=[-1.0, 1.0, 2.0]), r"force\[0\] = -1 is not allowed"),
        (
            lambda: measured(force=[0.0, 100.0, 200.0], machine=Machine(compliance=1e-6)),
            r"force\[0\] = 0 is not allowed: at first touch the indentation is 0",
        ),
        (lambda: measured(load_uncertainty=-1.0), r"load_uncertainty\[0\] = -1 .*must be 0 or more and finite"),
        (lambda: measured(load_uncertainty=inf), "load_uncertainty.* the value must be 0 or more and finite"),
        (lambda: measured(saturation=0.0), "saturation = 0 is not allowed: the largest reading of a film is above 0"),
        # kinds of measurements
        (lambda: measured("indentations"), "quantity 'indentations' is not known; did you mean 'indentation'?"),
        (lambda: measured("force"), "force is both the measured quantity and the load; choose another load"),
        (lambda: measured(force=None), "exactly one of force, indentation, half_angle is needed, got none"),
        (lambda: measured(indentation=0.1), "exactly one of force, indentation, half_angle .* got force, indentation"),
        (lambda: measured(angle=0.1), "indentation takes no angle"),
        (lambda: measured("pressure"), "pressure needs an angle"),
        (lambda: measured("pressure", angle=[0.1, 0.2]), "angle must have 1 or 3 numbers, got 2"),
        (lambda: measured("pressure", angle=4.0), "a polar angle lies between -pi and pi"),
        (lambda: measured("area", machine=Machine()), "area has a machine, but only indentations are read by one"),
        *((lambda mass=mass: oscillation(mass), "a mass .kg. is above 0 and finite") for mass in (0.0, -1.0, inf)),
        *(
            (lambda angle=angle: sliding_torque(angle), "axis_angle = .* not allowed: the angle between axis and load")
            for angle in (-0.1, 1.6, 90.0, nan)
        ),
        *(
            (lambda degrees=degrees: HeavyTailed(degrees=degrees), "degrees of freedom are above 0 and finite")
            for degrees in (0.0, -1.0, inf, nan)
        ),
        # machines
        (lambda: Machine(compliance=-1e-6), "a machine's compliance .mm/N. is 0 or more"),
        (lambda: Machine(compliance=(-1e-6, 1e-6)), "a machine's compliance .mm/N. is 0 or more"),
        (lambda: Machine(offset=(0.1, 0.1)), "offset = .* must be a number, or two ends in ascending order"),
        (lambda: Machine(offset=(0.2, 0.1)), "two ends in ascending order"),
        (lambda: Machine(offset=(0.1, 0.2, 0.3)), "two ends in ascending order"),
        (lambda: Machine(drift=inf), "two ends in ascending order"),
        (lambda: Machine(drift=(-inf, 0.0)), "two ends in ascending order"),
        (lambda: unknowns({}, Machine(offset=1.0), Machine(offset=2.0)), "two machines have the name 'machine'; use"),
        # unknowns
        (lambda: unknowns({**YOUNG, "liner_young": (1.0, 2.0)}), "an unknown is stated twice"),
        (lambda: unknowns({"clearance": (0.1, inf)}), "two finite ends in ascending order"),
        (lambda: unknowns({"clearance": (0.1, 0.1)}), "two finite ends in ascending order"),
        (lambda: unknowns({"clearance": (0.1, 0.2, 0.3)}), "must be two ends, such as"),
        (lambda: unknowns({"clearance": "wide"}), "must be two ends, such as"),
        (lambda: unknowns({"clearance": 0.1}), "clearance = 0.1 must be two ends"),
        (lambda: unknowns({"force": (1.0, 2.0)}), "'force' among the unknowns is not known"),
        (lambda: unknowns({"tilt": (0.1, 0.2)}), "'tilt' among the unknowns is not known"),
        (lambda: unknowns({"clearence": (0.1, 0.2)}), "'clearence' among the unknowns is not known; did you mean 'cl"),
        (lambda: unknowns({"liner_poisson": (0.3, 0.6)}), "liner_poisson = 0.6 is not allowed"),
        (lambda: unknowns({"clearance": (-0.1, 0.1)}), "clearance = -0.1 is not allowed: a radial clearance"),
        (
            lambda: identified({"work_of_adhesion": (1e-5, 1e-3)}),
            "work_of_adhesion is not a number of the model hess-forsbach; models that have it: adhesive",
        ),
        (
            lambda: identified({"work_of_adhesion": (-1e-5, 1e-3)}, bs.AdhesiveSocket()),
            "work_of_adhesion = -1e-05 is not allowed: a work of adhesion",
        ),
        (lambda: identified({"work_of_adhesio": (1e-5, 1e-3)}), "did you mean 'work_of_adhesion'"),
        # identification
        (lambda: identified({}), "free has no unknowns"),
        (lambda: identified({"clearance": (0.2, 0.1)}), r"clearance = \(0.2, 0.1\) is not allowed: two finite ends"),
        (lambda: identified({"clearance": (0.1, 0.2), "diametral_clearance": (0.1, 0.2)}), "are one too many"),
        (
            lambda: identified({**CLEARANCE, **YOUNG, "liner.poisson": (0.3, 0.4), "ball_radius": (15.0, 17.0)}),
            "3 values do not suffice for 4 unknowns",
        ),
        (
            lambda: identified(data=measured("area", values=[10.0, 5000.0, 20.0])),
            r"area\[1\] = 5000 is not allowed: a contact area is below half of the ball, 2π",
        ),
        (
            lambda: identified(data=measured(values=0.02, force=1000.0, uncertainty=None)),
            "the uncertainty of indentation is missing, and 1 values are too few",
        ),
        (lambda: identified(data=[]), "data must have at least one set of measurements"),
        (lambda: identified(joint=JOINT.replace(clearance=np.array([0.1, 0.2]))), "identify one joint at a time"),
        (
            lambda: identified({"liner_thickness": (0.05, 0.1)}, bs.Tabulated()),
            "tabulated has no result for all the data anywhere within the ranges",
        ),
        (lambda: identified(data=torques()), "data of friction_torque depend on friction_coefficient: free it, with"),
        (
            lambda: identified({**CLEARANCE, "friction_coefficient": (0.0, 0.3)}),
            "no data depend on friction_coefficient: do not free it, or add data",
        ),
        (
            lambda: identified({"friction_coefficient": (-0.1, 0.3)}, data=torques()),
            r"friction_coefficient = -0\.1 is not allowed: a coefficient of friction is 0",
        ),
        (lambda: identified(model=bs.Exact(), slopes=by_tracing), "exact cannot be traced by JAX: use by_differences"),
        (lambda: trials(identified(), 0), "count = 0 is not allowed: 1 trial or more"),
    ],
)
def test_a_wrong_number_is_refused_with_the_reason(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: identified(model="tabulated"), r"model must be a model, such as bs.Tabulated\(\), got 'tabulated'"),
        (lambda: identified(joint="hip-36"), "joint must be a Joint"),
        (lambda: identified(data=[3.0]), "data must be sets of Measured, got 3.0"),
        (lambda: measured(machine="press"), "machine must be a Machine, got 'press'"),
        (lambda: Machine(offsett=0.1), "'offsett' is not an error of a machine; did you mean 'offset'"),
    ],
)
def test_an_argument_of_a_wrong_kind_is_refused(call, message):
    with pytest.raises(TypeError, match=message):
        call()
