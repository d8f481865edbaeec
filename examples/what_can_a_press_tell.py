"""
Clearance and modulus from contact areas
========================================

A hip was pressed, and its contact areas were measured with a film. Can clearance and modulus be identified from the
areas?

They cannot, because areas and pressures depend on clearance times modulus. The identification reports that neither is
identifiable, gives the product with its band, and names the measurement that separates the two. The data are synthetic,
drawn from a model for a joint with a clearance of 0.1 mm and a liner of 1000 MPa.
"""

import numpy as np

import ballsocket as bs
from ballsocket.identification import Measured
from ballsocket.reports.figure_files import save
from ballsocket.reports.identify_results import corner_figure, experiment_figure, fit_figure

hip = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.Material(young=1000.0, poisson=0.4))
free = {"clearance": (0.05, 0.2), "liner.young": (500.0, 2000.0)}
force = np.linspace(500.0, 3000.0, 8)
truth = bs.Tabulated().press(hip, force=force)
random = np.random.default_rng(7)


def read(quantity: str, share: float) -> Measured:
    """Readings that scatter about the truth."""
    values = getattr(truth, quantity)
    scattered = values * (1 + share * random.standard_normal(len(values)))
    return Measured(quantity=quantity, values=scattered, uncertainty=share * values, force=force, name=quantity)


areas = read("area", 0.02)
result = bs.identify(bs.Tabulated(), hip, areas, free)
print(result)
save(experiment_figure(result.next), "what_can_a_press_tell_1_next.png")

# %%
# So indentations are measured as well, and both numbers have a band. What is left of their dependence shows where one
# is drawn against the other.

both = bs.identify(bs.Tabulated(), hip, [areas, read("indentation", 0.02)], free)
print(both)
save(fit_figure(both), "what_can_a_press_tell_2_fit.png")
save(corner_figure(both), "what_can_a_press_tell_3_corner.png")
