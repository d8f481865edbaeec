"""Figures of studies show what was asked, and refuse what they cannot show."""

import pytest

import ballsocket as bs
from ballsocket.output import study_plots
from ballsocket.studies.design import Span, grid, sample
from ballsocket.studies.distributions import tolerance
from ballsocket.studies.limits import Limit

HIP = bs.joints["hess-forsbach"]
SHELL = (Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0))


def test_pictures_show_what_was_asked():
    space = bs.study(
        bs.HessForsbach(), HIP, ball_radius=Span(11.0, 23.0, 9), liner_thickness=Span(3.0, 15.0, 9), force=3000.0
    )
    figure = study_plots.design_map(space, SHELL, best={"ball_radius": 19.6, "liner_thickness": 6.3})
    assert [axes.get_title() for axes in figure.axes] == [
        "largest pressure pmax [MPa]",
        "contact area A [mm²]",
        "contact half angle ε [°]",
    ]
    scattered = sample(64, clearance=tolerance(0.1, 0.05)) * grid(force=Span(500.0, 3000.0, 5))
    bands = bs.study(bs.HessForsbach(), HIP, scattered)
    assert "median" in study_plots.band_figure(bands).axes[0].get_legend_handles_labels()[1]
    with pytest.raises(ValueError, match="a map needs two axes"):
        study_plots.design_map(bands.isel(force=0))
    with pytest.raises(ValueError, match="bands need samples"):
        study_plots.band_figure(space)
