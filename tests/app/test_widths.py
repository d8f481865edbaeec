"""Tables of every view on screens from a telephone to a wide one: none is cut or scrolls sideways."""

from pathlib import Path

import pytest

from ballsocket.app.state.screen import VIEWS

from .browser import PICTURES, script

WIDTHS = (390, 768, 900, 1100, 1280, 1440, 1920)
SIX = "&".join(f"beside{number}.preset=hip-36" for number in range(1, 7))
LONG_NAME = "Acetabular-Component-With-A-Name-Without-Any-Blank-In-It-0123456789"
OWN = "joint.ball_radius=14&joint.clearance=0.1&joint.liner_thickness=5&liner.material=UHMWPE&liner.young=900"
DESIGNS = {
    "passing": "preset=hip-28&load.force=1000&beside1.preset=hip-36",
    "failing": f"preset=hip-28&load.force=9000&units=imperial&{SIX}",
    "invalid": f"{OWN}&name={LONG_NAME}&load.force=5000&load.tilt=60+deg&beside1.preset=hip-36",
}
MORE = {
    "map": "&limit=max_pressure<=12&picked=30.5,7.25",
    "evidence": "&ask.limits=max_pressure+<=+12+MPa",
    "wear": "&use.millions=0.1",
}
FITTED = """async (width) => {
  for (let frames = 0; frames < 3; frames += innerWidth === width) await new Promise(requestAnimationFrame);
  return document.documentElement.scrollWidth;
}"""
"""The width of what is on the page two frames after it has fitted its tables to a window; nothing else follows."""

CUT = script("cut.js")


def finish_work(page, view):
    """Run the work of a view, and wait for it, but not for the map of orientations, which has no table."""
    run = f"section[data-view={view}] [data-name$='.run']:not([data-name='cup-stood.run'])"
    buttons = f'[...document.querySelectorAll("{run} button")]'
    page.evaluate(  # at once, because a view may begin by itself
        f"{buttons}.filter((one) => one.checkVisibility() && one.innerText != 'Cancel').forEach((one) => one.click())"
    )
    bars = f'[...document.querySelectorAll("{run} progress")]'
    page.wait_for_function(f"() => !{bars}.some((bar) => bar.checkVisibility())")


@pytest.mark.long
@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.parametrize("view", VIEWS)
def test_no_table_is_cut_or_scrolls_sideways(reader, view, design):
    page = reader.open(f"?view={view}&{DESIGNS[design]}{MORE.get(view, '')}").page
    assert page.locator("#trouble").inner_text() == ""
    finish_work(page, view)
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(FITTED, width) == width
        assert page.evaluate(CUT) == [], width
        if PICTURES:
            page.screenshot(path=Path(PICTURES) / f"{view}_{design}_{width}.png", full_page=True)
