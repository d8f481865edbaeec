"""
Head and liner for a 52 mm shell
================================

A shell of 52 mm leaves 26 mm for head radius, clearance and liner. A larger head distributes the load, a thinner
liner is stiffer. Which head has the smallest peak pressure, and how does a smaller contact area affect it?

The limits are those of a designer. The liner has at least 4 mm. Between the edge of the contact and the rim there are
at least 10 mm of arc under a vertical load, in a cup that opens 20° to the side.
"""

from math import radians

import ballsocket as bs
from ballsocket.output.save import save
from ballsocket.studies import Limit, Span, design_map, front_figure, optimise, pareto

hip = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)
limits = (
    Limit(name="outer_radius", high=26.0),
    Limit(name="liner_thickness", low=4.0),
    Limit(name="edge_distance", low=10.0, cup=bs.Cup(inclination=radians(20.0))),
)
ranges = {"ball_radius": (11.0, 23.0), "liner_thickness": (3.0, 15.0)}

best = optimise(bs.Tabulated(), hip, ranges, load={"force": 3000.0}, limits=limits)
print(f"least peak pressure {best.value:.2f} MPa with a head of {2 * best.point['ball_radius']:.1f} mm")
print(f"in a liner of {best.point['liner_thickness']:.1f} mm; held by {', '.join(best.active)}")
truth = bs.Exact().press(best.joint, force=3000.0)
print(f"the exact answer for that joint: {truth.max_pressure:.2f} MPa")

study = bs.study(
    bs.Tabulated(), hip, ball_radius=Span(11.0, 23.0, 61), liner_thickness=Span(3.0, 15.0, 61), force=3000.0
)
save(design_map(study, limits, best=best.point), "which_head_for_a_shell.png")

# %%
# A small contact area reduces wear, a low peak pressure increases the strength. No head is best in both. These heads
# are those that no other head exceeds in both.

wishes = ("area", "max_pressure")
front = pareto(study, wishes, limits)
for place in (0, front.sizes["point"] // 2, -1):
    design = front.isel(point=place)
    print(
        f"head {2 * design.ball_radius.item():.1f} mm, liner {design.liner_thickness.item():.1f} mm: "
        f"{design.area.item():.0f} mm², {design.max_pressure.item():.1f} MPa"
    )
save(front_figure(study, front, wishes, limits), "which_head_for_a_shell_front.png")
