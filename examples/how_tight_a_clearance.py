"""
Effect of a clearance tolerance on the largest pressure
=======================================================

How much does a clearance tolerance of ±0.05 mm change the peak pressure of a 32 mm head, compared with the scatter
of the liner's material?

Samples of the tolerances times a row of loads are one study. The bands contain half, nine tenths and nearly all of the
joints. Sobol indices show which number causes them.
"""

import ballsocket as bs
from ballsocket.output.save import save
from ballsocket.studies import (
    Rectangular,
    Span,
    band_figure,
    grid,
    sample,
    sensitivity,
    sensitivity_figure,
    tolerance,
)

hip = bs.Joint(ball_radius=16.0, clearance=0.10, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)
scatter = {
    "clearance": tolerance(0.10, 0.05),
    "liner_thickness": tolerance(6.0, 0.2),
    "liner_young": Rectangular(low=900.0, high=1100.0),
    "liner_poisson": Rectangular(low=0.38, high=0.42),
}

study = bs.study(bs.Tabulated(), hip, sample(1024, **scatter) * grid(force=Span(500.0, 4000.0, 15)))
at_3_kn = study.max_pressure.sel(force=3000.0)
low, middle, high = at_3_kn.quantile([0.005, 0.5, 0.995]).values
print(f"peak pressure at 3 kN: {middle:.2f} MPa, 99 % of the joints between {low:.2f} and {high:.2f} MPa")
save(band_figure(study), "how_tight_a_clearance.png")

# %%
# Which number is to blame? The share of the variance that each makes alone and together with others, and the percent by
# which one percent of each changes the answer.

found = sensitivity(bs.Tabulated(), hip, scatter, quantities=("max_pressure", "half_angle"), load={"force": 3000.0})
for name in scatter:
    here = found.sel(quantity="max_pressure", parameter=name)
    print(f"{name:<16} {float(here.total_order):5.1%} of the scatter; one per cent is {float(here.elasticity):+.2f} %")
save(sensitivity_figure(found), "how_tight_a_clearance_why.png")
