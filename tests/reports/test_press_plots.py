"""Figures of presses, of motion and of contacts off the axis are pictures of their results."""

import subprocess
import sys
from dataclasses import replace
from math import degrees, pi, radians, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.unit_systems import Units
from ballsocket.dynamics import Damping, Prony, Viscoelastic, simulate
from ballsocket.elasticity.off_axis.vtk import BALL, BORE, write_vtk
from ballsocket.reports import cup_plots
from ballsocket.reports.cup_map import on_page, shown_maximum, shown_pressure
from ballsocket.reports.cup_plots import cup_figure, save_view
from ballsocket.reports.figure_files import save
from ballsocket.reports.press_plots import energy_balance, loop_figure, motion_figure, press_figure

from ..joints import HIP


def test_the_figure_of_a_massive_socket_says_so():
    pivot = bs.joints["tilting-pad-pivot"]
    contact = bs.Hertz().press(pivot, force=3000.0)
    title = press_figure({"hertz": contact}, {"hertz": contact}).get_suptitle()
    assert "head ⌀" in title
    assert "massive socket of" in title
    assert "inf" not in title


@pytest.fixture(scope="module")
def comparison():
    return bs.compare(HIP, force=3000.0)


def test_figure_draws_the_result(comparison):
    curves = {name: bs.catalogue[name].press(HIP, indentation=np.linspace(0.0, 0.06, 30)) for name in comparison}
    figure = press_figure(comparison, curves)
    left, right = figure.axes
    drawn = {line.get_label(): line for line in left.lines}
    assert set(drawn) == set(comparison)
    for name, line in drawn.items():
        largest = comparison[name].pressure(np.linspace(0.0, 1.4, 2000)).max()
        assert line.get_ydata().max() == pytest.approx(largest, rel=5e-3)
        assert line.get_linewidth() == (2.0 if comparison[name].valid else 1.0)
    assert len(right.lines) == 2 * len(comparison)
    assert ("MPa" in left.get_ylabel(), "kN" in right.get_ylabel()) == (True, True)
    assert "35.8 mm" in figure.get_suptitle()


@pytest.mark.long
def test_of_many_models_those_that_matter_are_drawn_and_the_others_named(comparison):
    figure = comparison.plot()
    drawn = [line.get_label() for line in figure.axes[0].lines]
    assert len(drawn) == 7
    assert "exact" in drawn
    assert "tabulated" not in drawn  # lies on the exact one
    assert all(name in drawn for name, contact in comparison.items() if contact.valid and name != "tabulated")
    title = figure.legends[0].get_title().get_text()
    assert title == f"not drawn: {', '.join(name for name in comparison if name not in drawn)}"


def test_few_models_are_all_drawn_with_the_reference_below_what_is_judged():
    few = {name: bs.catalogue[name] for name in ("hess-forsbach", "tabulated", "exact")}
    lines = bs.compare(HIP, force=3000.0, models=few).plot().axes[0].lines
    order = {line.get_label(): line.get_zorder() for line in lines}
    assert set(order) == set(few)
    assert order["exact"] < order["hess-forsbach"]


@pytest.fixture(scope="module")
def motion():
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=Damping(hysteresis=1e-3))
    throw = {"position": (0.0, 0.0, 0.0), "velocity": (20.0, 0.0, 200.0), "pull": (0.0, 0.0, 100.0)}
    return simulate(element, mass=1.0, duration=3e-3, step=2e-5, **throw)


def test_a_motion_has_its_energy_its_way_near_the_clearance_and_the_force_of_the_element(motion):
    (axes,) = energy_balance(motion).axes
    top = axes.collections[-1].get_paths()[0].vertices
    (line,) = axes.lines
    assert top[:, 1].max() == pytest.approx(line.get_ydata().max(), rel=1e-9)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["moving", "stored", "lost", "put in"]
    way, force = motion_figure(motion).axes
    np.testing.assert_array_equal(way.lines[1].get_xydata(), motion.position[:, [0, 2]])
    assert np.hypot(*way.lines[0].get_xydata().T) == pytest.approx(HIP.clearance)
    assert force.lines[0].get_ydata().max() == pytest.approx(motion.summary()["largest_force"])


def test_a_loop_tells_what_it_loses():
    liner = Viscoelastic(bs.HessForsbach(), HIP, Prony(terms=((0.3, 0.1),)))
    time = np.linspace(0.0, 1.0, 101)
    depth = 0.05 * np.sin(np.pi * time)
    force = liner.cycle_force(time, depth)
    (axes,) = loop_figure(depth, {"pressed": force, "at once": liner.instantaneous_force(depth)}).axes
    told = [text.get_text() for text in axes.get_legend().get_texts()]
    assert told[0] == f"pressed: {np.trapezoid(force, depth):.3g} N mm lost"
    assert float(told[1].split()[2]) == pytest.approx(0.0, abs=1e-9)


WIDE = radians(4.0)
CUP = bs.Cup(arc_of_cover=radians(170.0), inclination=radians(45.0), anteversion=radians(15.0))
SPHERE = bs.Sphere(cup=CUP, ring_width=WIDE)


@pytest.fixture(scope="module")
def contact():
    return SPHERE.press(HIP, force=3000.0, direction=(-0.2, 0.0, 1.0))


@pytest.fixture(scope="module")
def figure(contact):
    return cup_figure(contact)


def labels(axes):
    return [line.get_label() for line in axes.lines]


def texts(axes):
    return {text.get_text() for text in axes.texts}


def drawn_as(axes, label):
    return axes.lines[labels(axes).index(label)].get_xydata()


def test_areas_on_the_page_are_areas_on_the_bore():
    rng = np.random.default_rng(1)
    polar, azimuth = rng.uniform(0.05, 2.0, 50), rng.uniform(0, 2 * pi, 50)

    def place(polar, azimuth):
        directions = [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)]
        return np.stack(on_page(np.stack(directions, axis=-1)), axis=-1)

    step = 1e-5
    along = (place(polar + step, azimuth) - place(polar - step, azimuth)) / (2 * step)
    around = (place(polar, azimuth + step) - place(polar, azimuth - step)) / (2 * step)
    area = abs(along[:, 0] * around[:, 1] - along[:, 1] * around[:, 0])
    assert area == pytest.approx(np.sin(polar), rel=1e-6)
    assert np.hypot(*on_page((1.0, 0.0, 0.0))) == pytest.approx(sqrt(2))


def test_the_load_is_where_it_points_seen_from_the_opening(contact, figure):
    """Upwards on the page is the cup's x; to the right its y, as for an eye that looks to the dome."""
    right, up = drawn_as(figure.axes[0], "load")[0]
    lateral, across, axial = contact.force_vector / contact.force
    assert np.hypot(right, up) == pytest.approx(2 * np.sin(np.arccos(axial) / 2))
    assert np.arctan2(right, up) == pytest.approx(np.arctan2(across, lateral))
    x, y, z = np.array(CUP.frame)
    assert np.cross(z, x) == pytest.approx(y)  # forward times up is right


def test_the_largest_pressure_stands_in_the_legend_where_it_is(contact, figure):
    marked = next(name for name in labels(figure.axes[0]) if name.startswith("largest pressure"))
    assert f"{contact.max_pressure:.4g} MPa" in marked
    assert drawn_as(figure.axes[0], marked)[0] == pytest.approx(np.array(on_page(contact.max_pressure_at)))
    assert f"{contact.edge_distance:.1f} mm from contact to rim" in labels(figure.axes[1])
    assert f"{degrees(contact.tilt):.3g}° from the cup's axis" in figure.get_suptitle()
    assert texts(figure.axes[0]) >= {"up", "anterior", "30°", "60°"}
    imperial = labels(cup_figure(contact, Units.IMPERIAL).axes[0])
    assert f"largest pressure, {contact.max_pressure * 145.0377377:.4g} psi" in imperial


@pytest.mark.long
@pytest.mark.parametrize(("cup", "has_body"), [(bs.Cup(inclination=0.0), True), (bs.Cup(), False)])
def test_directions_of_the_body_need_an_orientation_of_which_zero_is_one(cup, has_body):
    contact = replace(SPHERE, cup=cup).press(HIP, force=2000.0)
    assert ("anterior" in texts(cup_figure(contact).axes[0])) == has_body


def test_the_pressure_ends_at_the_outline_and_is_the_band_on_the_section(contact, figure):
    far = contact.outline - 0.3 * contact.force_vector / contact.force
    assert shown_pressure(contact, far / np.linalg.norm(far, axis=1)[:, None]) == pytest.approx(0.0)
    assert shown_pressure(contact, contact.max_pressure_at[None]) == pytest.approx(contact.max_pressure, rel=0.01)
    band = drawn_as(figure.axes[1], "pressure on the cut")
    depth = 1 - np.hypot(*band.T) / HIP.socket_radius
    assert np.arctan2(*band[depth.argmax()]) == pytest.approx(contact.tilt, abs=WIDE)
    assert depth.max() == pytest.approx(0.45, rel=0.02)


@pytest.mark.long
def test_a_loaded_rim_is_marked_and_an_edge_that_digs_in_has_no_largest_pressure_on_the_figure():
    sphere = replace(SPHERE, cup=replace(CUP, chamfer=1.0))
    over = sphere.press(HIP, force=3000.0, tilt=radians(65.0))
    assert over.max_pressure == np.inf
    assert 0 < shown_maximum(over) < over.pressure_map[2].max()
    cup_map, section = cup_figure(over).axes[:2]
    assert "chamfer" in labels(cup_map)
    assert not any(name.startswith("largest") for name in labels(cup_map))
    assert "contact at the rim: unbounded pressure" in labels(section)
    bounded = SPHERE.press(HIP, force=3000.0, tilt=radians(70.0))
    assert "contact at the rim" in labels(cup_figure(bounded).axes[1])


SHELL = {"backing": (bs.Layer(thickness=4.0, material=bs.TITANIUM),)}


@pytest.mark.long
@pytest.mark.parametrize("socket", [SHELL, {"support": bs.Support.FREE}, {"liner_thickness": np.inf, "ball": None}])
def test_every_socket_has_a_section(socket, tmp_path):
    contact = bs.Sphere(ring_width=WIDE).press(replace(HIP, **socket), force=2000.0)  # along the axis
    save(cup_figure(contact), tmp_path / "a.svg")
    assert (tmp_path / "a.svg").stat().st_size > 10_000


def test_a_contact_that_is_alone_draws_its_cup(contact):
    assert contact.plot().axes[0].get_title() == "the cup seen from its opening"
    assert "force" in SPHERE.press(HIP, force=0.0).plot().axes[1].get_ylabel()
    with pytest.raises(ValueError, match="for one contact"):
        cup_figure(SPHERE.press(HIP, force=[1000.0, 2000.0]))


def test_bore_ball_and_edge_as_vtk(contact, tmp_path):
    import meshio

    write_vtk(contact, tmp_path / "cup.vtu")
    mesh = meshio.read(tmp_path / "cup.vtu")
    cells, data = mesh.cells_dict["quad"], mesh.cell_data_dict
    part, pressure, gap = (data[name]["quad"] for name in ("part", "pressure", "gap"))
    corners = mesh.points[cells]
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normal = np.cross(first, second) / 2
    force = (pressure[:, None] * normal)[part == BORE].sum(axis=0)
    assert np.linalg.norm(force) == pytest.approx(contact.force, rel=5e-3)
    assert abs(force) == pytest.approx(abs(contact.force_vector), abs=5e-3 * contact.force)
    assert gap.min() == 0
    assert gap[(part == BORE) & (pressure == 0)].min() > 0
    away = mesh.points[np.unique(cells[part == BALL])] - contact.displacement
    assert np.linalg.norm(away, axis=1) == pytest.approx(HIP.ball_radius)
    with pytest.raises(ValueError, match="must end in"):
        write_vtk(contact, tmp_path / "cup.txt")


def test_a_view_in_three_dimensions(contact, tmp_path):
    pytest.importorskip("pyvista")
    drawing = "import pyvista; pyvista.Plotter(off_screen=True).screenshot(return_img=True)"
    if subprocess.run([sys.executable, "-c", drawing], capture_output=True, check=False).returncode != 0:
        pytest.skip("nothing can be drawn in three dimensions here")
    from matplotlib.image import imread

    save_view(contact, tmp_path / "cup.png")
    assert [path.name for path in tmp_path.iterdir()] == ["cup.png"]
    colours = imread(tmp_path / "cup.png")[..., :3].reshape(-1, 3)
    assert len(np.unique(colours.round(2), axis=0)) > 100


def test_the_colour_bar_of_a_view_has_the_units_of_the_answer(contact, monkeypatch):
    drawn = {}
    monkeypatch.setattr(cup_plots, "_surface", lambda *words: {})
    plotter = SimpleNamespace(add_mesh=lambda bore, **words: drawn.update(words, highest=bore["pressure"].max()))
    for units, unit, factor in ((Units.SI, "[MPa]", 1.0), (Units.IMPERIAL, "[psi]", 1.0 / 0.006894757293168)):
        cup_plots._add_bore(plotter, contact, np.eye(3), units)
        assert unit in drawn["scalar_bar_args"]["title"]
        assert drawn["clim"][1] == pytest.approx(factor * float(contact.max_pressure))
        assert 0.9 * drawn["clim"][1] < drawn["highest"] <= drawn["clim"][1]


@pytest.mark.long
def test_a_preloaded_ball_at_rest_is_drawn_without_a_load():
    joint = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    sphere = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0)), ring_width=WIDE)
    cup_map = cup_figure(bs.Preload(model=sphere, joint=joint).equilibrium).axes[0]
    assert "load" not in labels(cup_map)
    assert "rim" in labels(cup_map)
