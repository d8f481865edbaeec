"""
From the explorer to a joint file
=================================

A shell of 52 mm and a load of 3 kN: which head and which liner fit, and what does 0.05 mm of clearance change? In the
explorer (``ballsocket app``) this takes two minutes: open the design map, write the limits under it, and click. This
page repeats it step by step, with the link that opens each view and the numbers of that view.
"""

from dataclasses import replace
from math import degrees, radians

import ballsocket as bs
from ballsocket.app.state.screen import START, MapAxis, link_of
from ballsocket.files.joint_file import JointFile
from ballsocket.files.joint_toml import toml_of
from ballsocket.reports.figure_files import save
from ballsocket.reports.section_plots import section_figure
from ballsocket.studies import Span, allowed, design_map, parse_limit

PAGE = "http://127.0.0.1:5006/?"

# %%
# **The map.** Peak pressure over head radius and liner thickness, with two limits: what fits into the shell, and 6 mm
# as the thinnest liner that we would mill. Faded is what breaks one of them.

limits = (parse_limit("outer_radius<=26 mm"), parse_limit("liner_thickness>=6 mm"))
across, up = MapAxis(name="ball_radius", low=11.0, high=23.0), MapAxis(name="liner_thickness", low=3.0, high=15.0)
seen = replace(START, view="map", across=across, up=up, limits=limits)
print(PAGE + link_of(seen))

axes = {axis.name: Span(axis.low, axis.high, 61) for axis in (across, up)}
found = bs.study(bs.Tabulated(), START.file.joint, force=3000.0, **axes)
save(design_map(found, limits, ["max_pressure"]), "from_the_explorer.png")

# %%
# **The choice.** The least pressure that the limits leave lies on the shell's edge. Heads come in steps: 36 mm is the
# largest that leaves 6 mm and a rest, so take that and all the plastic there is room for.

best = found.max_pressure.where(allowed(found, limits))
place = best.argmin(...)
radius, thickness = (float(found[axis].isel({axis: place[axis]})) for axis in axes)
print(f"least {float(best.min()):.2f} MPa: head {2 * radius:.1f} mm, liner {thickness:.1f} mm")

head = 18.0
chosen = replace(
    START.file.joint,
    ball_radius=head,
    liner_thickness=round(26.0 - head - 0.1, 6),
    name="52 mm shell, 36 mm head",
    source="",
)
print(bs.compare(chosen, force=3000.0))

# %%
# **The clearance.** In the explorer one slider; here the joint on both ends of ±0.05 mm, beside each other.

for clearance in (0.05, 0.10, 0.15):
    contact = bs.Exact().press(replace(chosen, clearance=clearance), force=3000.0)
    print(f"{clearance:.2f} mm: {contact.max_pressure:.2f} MPa, half angle {degrees(contact.half_angle):.1f}°")

# %%
# **The judge.** A real cup ends at a rim. Finite elements compute the change for a rim 5° short of the equator with a
# chamfer.

cup = bs.Cup(arc_of_cover=radians(170.0), chamfer=1.0)
contact = bs.FiniteElement(cup=cup).press(chosen, force=3000.0)
print(f"{contact.max_pressure:.2f} MPa ± {100 * contact.error['max_pressure']:.2f} %")
save(section_figure(contact, bs.Exact().press(chosen, force=3000.0)), "from_the_explorer_section.png")

# %%
# **To keep.** The joint as a file that every command reads, and the link that shows it to a colleague.

file = JointFile(chosen, {"force": 3000.0}, cup)
print(toml_of(file))
print(PAGE + link_of(replace(START, file=file, beside=(START.file,), view="compare")))
