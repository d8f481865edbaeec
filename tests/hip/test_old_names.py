"""Names of version 1 in `ballsocket.hip`: each still works and warns."""

import numpy as np
import pytest

from ballsocket import hip as package
from ballsocket.hip import KelvinVoigtChain, cycle_file, iso_14242_1, population, wear_law, wear_laws
from ballsocket.hip.cycle_file import read_cycle

from . import test_cycles, test_rim, test_uncertainty
from .hips import QUICK, hip, report_after
from .test_cycle_file import write_table
from .test_variability import TIGHT, variability

ATTRIBUTES = [
    (lambda: hip(**QUICK), "rest solve_equilibrium, bed foundation, halved discretization_error"),
    (lambda: hip(**QUICK), "tether lateral_stiffness, moved side_cycle, largest largest_load_index"),
    (lambda: report_after(hip(**QUICK), 1e4), "worn_in wear_displacement, crept_in creep_displacement"),
    (lambda: report_after(hip(**QUICK), 1e4), "settled converged"),
    (lambda: iso_14242_1(20), "instants n_steps, sizes force_magnitudes, middles midpoint_rotations"),
    (lambda: iso_14242_1(20), "turns rotation_increments"),
    (lambda: test_cycles.mixed((test_cycles.WALK, 1.0)), "shares fractions, instants n_steps"),
    (test_rim.closest_approach, "reaching steps_at_rim"),
    (test_uncertainty.bands, "lived cohort, scatter variability, off quick_run_errors, without n_failed"),
    (lambda: wear_laws, "AreaLaw ContactAreaWear"),
    (lambda: KelvinVoigtChain, "advanced advance_strain"),
    (lambda: cycle_file, "Reading TableOptions"),
]


@pytest.mark.parametrize(("make", "names"), ATTRIBUTES)
def test_old_attributes_warn_and_work(make, names):
    owner = make()
    for old, new in (pair.split() for pair in names.split(", ")):
        with pytest.warns(DeprecationWarning, match=f"{old} is deprecated: use {new}"):
            value = getattr(owner, old)
        assert np.array_equal(getattr(value, "__wrapped__", value), getattr(owner, new))


def test_old_arguments_warn_and_work(tmp_path):
    seen, patients, table = [], variability(hip(**QUICK), clearance=TIGHT), write_table(tmp_path / "walk.csv")
    points, law = package.iso_14242_1_key_points().angles, package.CustomWearLaw(function=np.sum)
    for call, message in [
        (lambda: hip(**QUICK).after(1e4, listen=seen.append), "'listen' of after.* deprecated: use 'progress'"),
        (lambda: population(scatter=patients, counts=[1e3], patients=1), "'scatter'"),
        (lambda: iso_14242_1(16, key_points=points), "^argument 'key_points' of iso_14242_1"),
        (lambda: read_cycle(table, reading=cycle_file.TableOptions()), "'reading' of read_cycle.*: use 'options'"),
    ]:
        with pytest.warns(DeprecationWarning, match=message):
            call()
    assert seen[-1] == 1e4
    with pytest.warns(DeprecationWarning, match=r"^argument 'instants' of iso_14242_1\(\) is deprecated"):
        assert iso_14242_1(instants=20).n_steps == 20
    with pytest.warns(DeprecationWarning, match="'of' .* is deprecated: use 'function'"):
        assert package.OwnLaw(of=np.sum) == law
    with pytest.warns(DeprecationWarning, match="of is deprecated: use function"):
        assert law.of is np.sum


def test_old_classes_and_modules_are_the_present_ones():
    for names in ("AreaLaw ContactAreaWear", "EnergyLaw FrictionEnergyWear", "Ladder KelvinVoigtChain"):
        assert len({getattr(package, name) for name in names.split()}) == 1
    assert (package.InUse, package.OwnLaw) == (package.HipSimulation, package.CustomWearLaw)
    from ballsocket.hip.coefficients import wear_factor
    from ballsocket.hip.set_up import HipSetup
    from ballsocket.hip.use import HipSimulation

    from ballsocket.hip.history import NumericalError

    assert issubclass(HipSimulation, HipSetup)
    assert wear_factor is wear_law.wear_factor
    with pytest.warns(DeprecationWarning, match="First is deprecated"):
        from ballsocket.hip.first import First
    with pytest.warns(DeprecationWarning, match="Error is deprecated: use NumericalError"):
        from ballsocket.hip.history import Error
    assert isinstance(hip(**QUICK).first, First)
    assert Error is NumericalError
