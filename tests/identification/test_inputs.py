"""Measurements, machines and unknowns: their numbers, the search scale, and refusals with the reason."""

from math import inf, log, nan

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identification import CustomObservable, HeavyTailed, Machine, Measured, oscillation, sliding_torque
from ballsocket.identification.bands import trials
from ballsocket.identification.misfit import by_tracing
from ballsocket.identification.unknowns import ParameterTransform, collect_unknowns, log_prior
from ballsocket.studies import LogNormal, Normal

from ..refusals import refused_calls
from .rigid import JOINT, MODEL

FORCE = [100.0, 400.0, 900.0]
CLEARANCE, YOUNG = {"clearance": (0.02, 0.3)}, {"liner.young": (400.0, 2000.0)}
COMPLIANT = Machine(compliance=1e-6)


def measured(quantity="indentation", values=(0.01, 0.02, 0.03), force=FORCE, uncertainty=1e-3, **settings):
    return Measured(quantity=quantity, values=values, uncertainty=uncertainty, force=force, **settings)


def identified(free=CLEARANCE, model=MODEL, joint=JOINT, data=None, **options):
    return bs.identify(model, joint, measured() if data is None else data, free, **options)


def unknowns(free, *machines):
    return collect_unknowns(free, machines, MODEL)


def torques():
    return measured("friction_torque", observable=sliding_torque())


test_numbers_that_are_not_allowed_are_refused = refused_calls(
    # numbers of a set of measurements
    (lambda: measured(uncertainty=[1e-3, nan, 1e-3]), "indentation_uncertainty has no number in row 2"),
    (lambda: measured(uncertainty=inf), "indentation_uncertainty.* an uncertainty is above 0 and finite"),
    (lambda: measured(name="film", uncertainty=0.0), r"film: indentation_uncertainty\[0\] = 0 \(and 2 more\)"),
    (lambda: measured(order=[0.0, inf, 2.0]), r"order\[1\] = inf is not allowed: numbers of readings must be fin"),
    (lambda: measured(values=[nan, 0.02, nan]), "indentation has no number in row 1, 3: add it, or omit the row"),
    (lambda: measured(values=[nan] * 12, force=[1.0] * 12), "no number in row 1, 2, 3, 4, 5, 6, 7, 8: add it"),
    (lambda: measured(values=[[0.01, 0.02]]), r"indentation of shape \(1, 2\) must be a row of numbers"),
    (lambda: measured(values=["thick", "thin", "flat"]), "indentation = .* must be numbers"),
    *((lambda v=v: measured(values=[v, 0.03]), "indentation.* must be numbers") for v in (0.02 + 1j, 10**400)),
    (lambda: measured("displacement", values=-0.01, force=1.0), "positive into the socket and 0 at first touch"),
    (lambda: measured("stiffness", values=[1.0, -2.0, 3.0]), r"stiffness\[1\] = -2 .*the value must be 0 or more"),
    (lambda: measured("energy", values=[1.0, inf, 3.0]), r"energy\[1\] = inf .*the value must be 0 or more"),
    (lambda: measured(force=[100.0, 200.0]), "force must have 1 or 3 numbers, got 2"),
    (lambda: measured(force=[-1.0, 1.0, 2.0]), r"force\[0\] = -1 is not allowed"),
    (lambda: measured(force=[0.0, 1.0, 2.0], machine=COMPLIANT), "force.* = 0 .*: at first touch the indentation"),
    *((lambda u=u: measured(load_uncertainty=u), "load_.* must be 0 or more and finite") for u in (-1.0, inf)),
    (lambda: measured(saturation=0.0), "saturation = 0 is not allowed: the largest reading of a film is above 0"),
    # kinds of measurements
    (lambda: measured("indentations"), "quantity 'indentations' is not known; did you mean 'indentation'?"),
    (lambda: measured("force"), "force is both the measured quantity and the load; choose another load"),
    (lambda: measured(force=None), "exactly one of force, indentation, half_angle is needed, got none"),
    (lambda: measured(angle=0.1), "indentation takes no angle"),
    (lambda: measured("pressure"), "pressure needs an angle"),
    (lambda: measured("pressure", angle=4.0), "a polar angle lies between -pi and pi"),
    (lambda: measured("area", machine=Machine()), "area has a machine, but only indentations are read by one"),
    *((lambda mass=mass: oscillation(mass), "a mass .kg. is above 0 and finite") for mass in (0.0, inf)),
    *((lambda angle=angle: sliding_torque(angle), "axis_angle = .* not allowed") for angle in (-0.1, 1.6, nan)),
    *((lambda n=n: HeavyTailed(degrees=n), "degrees of freedom are above 0 and finite") for n in (0.0, inf, nan)),
    # machines
    (lambda: Machine(compliance=(-1e-6, 1e-6)), "a machine's compliance .mm/N. is 0 or more"),
    (lambda: Machine(offset=(0.1, 0.1)), "offset = .* must be a number, or two ends in ascending order"),
    *((lambda o=o: Machine(drift=o), "two ends in ascending order") for o in ((0.1, 0.2, 0.3), (-inf, 0.0))),
    (lambda: unknowns({}, Machine(offset=1.0), Machine(offset=2.0)), "two machines have the name 'machine'; use"),
    # unknowns
    (lambda: unknowns({**YOUNG, "liner_young": (1.0, 2.0)}), "an unknown is stated twice"),
    *((lambda e=e: unknowns({"clearance": (0.1, e)}), "two finite ends in ascending order") for e in (inf, 0.1)),
    *((lambda e=e: unknowns({"clearance": e}), "must be two ends, such as") for e in ((0.1, 0.2, 0.3), "wide")),
    (lambda: unknowns({"clearence": (0.1, 0.2)}), "'clearence' among the unknowns is not known; did you mean 'cl"),
    (lambda: unknowns({"liner_poisson": (0.3, 0.6)}), "liner_poisson = 0.6 is not allowed"),
    (lambda: unknowns({"clearance": (-0.1, 0.1)}), "clearance = -0.1 is not allowed: a radial clearance"),
    (lambda: identified({"work_of_adhesion": (1e-5, 1e-3)}), "not a number of the model .*: adhesive"),
    (lambda: identified({"work_of_adhesion": (-1e-5, 1e-3)}, bs.AdhesiveSocket()), "= -1e-05 .*a work of adhesion"),
    (lambda: identified({"work_of_adhesio": (1e-5, 1e-3)}), "did you mean 'work_of_adhesion'"),
    # identification
    (lambda: identified({}), "free has no unknowns"),
    (lambda: identified({"clearance": (0.1, 0.2), "diametral_clearance": (0.1, 0.2)}), "are one too many"),
    (
        lambda: identified({**CLEARANCE, **YOUNG}, data=measured(values=0.02, force=9.0)),
        "too few data, 1 value for 2 unknowns",
    ),
    (lambda: identified(data=measured(values=0.02, force=9.0, uncertainty=None)), "cannot be estimated from 1 value:"),
    (lambda: identified(data=measured("area", [10.0, 5e3, 20.0])), r"area\[1\] = 5000 .* below half of the ball"),
    (lambda: identified(data=[]), "data must have at least one set of measurements"),
    (lambda: identified(joint=JOINT.replace(clearance=np.array([0.1, 0.2]))), "identify one joint at a time"),
    (lambda: identified({"liner_thickness": (0.05, 0.1)}, bs.Tabulated()), "has no result for all the data"),
    (lambda: identified(data=torques()), "data of friction_torque depend on friction_coefficient: free it, with"),
    (lambda: identified({**CLEARANCE, "friction_coefficient": (0.0, 0.3)}), "no data depend on friction"),
    (lambda: identified({"friction_coefficient": (-0.1, 0.3)}, data=torques()), "-0.1 .*: a coefficient of fric"),
    (lambda: identified(model=bs.Exact(), slopes=by_tracing), "exact cannot be traced by JAX: use by_differences"),
    (lambda: trials(identified(), 0), "count = 0 is not allowed: 1 trial or more"),
)

test_arguments_of_another_kind_are_refused = refused_calls(
    (lambda: identified(model="tabulated"), r"^model must be a model, such as bs.Tabulated\(\), got 'tabulated'"),
    (lambda: identified(joint="hip-36"), "^joint must be a Joint"),
    (lambda: identified(data=[3.0]), "^data must be sets of Measured, got 3.0"),
    (lambda: measured(machine="press"), "^machine must be a Machine, got 'press'"),
    (lambda: Machine(offsett=0.1), "^'offsett' is not an error of a machine; did you mean 'offset'"),
    error=TypeError,
)


def test_a_machine_with_a_zero_error_may_read_below_zero_and_without_a_load():
    for machine in (Machine(offset=-0.02), Machine(drift=-0.02), Machine(offset=(-0.1, 0.0))):
        assert measured(values=[-0.01, 0.0, 0.02], force=[0.0, 100.0, 200.0], machine=machine).values[0] == -0.01
        by_depth = measured("force", FORCE, None, indentation=[-0.01, 0.02, 0.03], machine=machine)
        assert by_depth.loads[0] == -0.01


def test_a_custom_observable_is_read_from_contacts_with_any_name_and_values():
    contact = MODEL.press(JOINT, force=1000.0)
    frequency = oscillation(2.0).read(contact)
    assert (2 * np.pi * frequency) ** 2 * 2.0 == pytest.approx(1e3 * contact.stiffness)
    twice = CustomObservable(oscillation(1.0).described, lambda contact: -2 * contact.force)
    data = measured("pull", [-200.0, -400.0, -600.0], observable=twice)
    assert (data.described, data.quantity) == (twice.described, "pull")


def unknown_of(name, prior, machines=()):
    return collect_unknowns({name: prior}, machines, MODEL)[0]


RANGE = unknown_of("clearance", (0.02, 0.3))
POISSON = unknown_of("liner_poisson", (0.3, 0.48))
NORMAL = unknown_of("liner.young", Normal(mean=900.0, deviation=50.0))
FACTOR = unknown_of("clearance", LogNormal(median=0.1, factor=1.2))


def test_the_log_prior_is_flat_in_the_value_of_a_range_and_minus_half_the_squared_distance_of_a_distribution():
    transform = ParameterTransform((RANGE,))
    density = log_prior(transform, transform.to_theta([[0.03], [0.06]]))
    assert density[1] - density[0] == pytest.approx(log(2.0))  # d value / d theta grows with the value
    assert log_prior(transform, transform.to_theta([[0.019], [0.31]])).tolist() == [-inf, -inf]
    assert np.isfinite(log_prior(transform, np.stack([transform.low, transform.high]))).all()
    transform = ParameterTransform((NORMAL, FACTOR))
    theta = transform.to_theta([[900.0, 0.1], [950.0, 0.1], [900.0, 0.144]])
    np.testing.assert_allclose(log_prior(transform, theta), [0.0, -0.5, -2.0], atol=1e-9)


def test_distributions_are_searched_within_eight_standard_deviations_of_allowed_values():
    assert (NORMAL.low, NORMAL.high) == (500.0, 1300.0)
    assert (FACTOR.low, FACTOR.high) == pytest.approx((0.1 / 1.2**8, 0.1 * 1.2**8))
    cut = unknown_of("liner_young", Normal(mean=900.0, deviation=50.0, low=850.0, high=1000.0))
    assert (cut.low, cut.high) == (850.0, 1000.0)
    assert unknown_of("liner_young", Normal(mean=900.0, deviation=300.0)).low == pytest.approx(0.9)
    assert unknown_of("liner_poisson", Normal(mean=0.45, deviation=0.02)).high == 0.5
