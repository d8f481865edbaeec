"""Tables of every view on screens from a telephone to a wide one: none is cut or scrolls sideways."""

from pathlib import Path

import pytest

from ballsocket.app.state.screen import VIEWS

from .browser import AT_REST, PICTURES, User, opened_profile

WIDTHS = (390, 768, 900, 1100, 1280, 1440, 1920)
SIX = "&".join(f"beside{number}.preset=hip-36" for number in range(1, 7))
LONG_NAME = "Acetabular-Component-With-A-Name-Without-Any-Blank-In-It-0123456789"
OWN = "joint.ball_radius=14&joint.clearance=0.1&joint.liner_thickness=5&liner.material=UHMWPE&liner.young=900"
DESIGNS = {
    "passing": "preset=hip-28&load.force=1000&beside1.preset=hip-36",
    "failing": f"preset=hip-28&load.force=9000&units=imperial&{SIX}",
    "invalid": f"{OWN}&name={LONG_NAME}&load.force=5000&load.tilt=60+deg&beside1.preset=hip-36",
}
MORE = {"map": "&limit=max_pressure<=12&picked=30.5,7.25", "evidence": "&ask.limits=max_pressure+<=+12+MPa"}
CUT = """() => {
  const cut = [];
  for (const table of document.querySelectorAll("section.view:not([hidden]) table")) {
    if (!table.getClientRects().length) continue;
    const place = table.closest(".wide, .narrow, .checks"), { left, right } = table.getBoundingClientRect();
    if (left < 0 || right > innerWidth + 1) cut.push(`beyond the window: ${table.textContent.slice(0, 60)}`);
    for (const box of [place, ...table.querySelectorAll("th, td")])
      if (box.scrollWidth > box.clientWidth + 1) cut.push(`cut or scrolls: ${box.textContent.slice(0, 60)}`);
  }
  return cut;
}"""


def finish_work(page, view):
    """Run the work of a view, and wait for it."""
    buttons = f"[...document.querySelectorAll('section[data-view={view}] .run button')]"
    page.evaluate(  # at once, because a view may begin by itself
        f"{buttons}.filter((one) => one.checkVisibility() && one.innerText != 'Cancel').forEach((one) => one.click())"
    )
    bars = f"[...document.querySelectorAll('section[data-view={view}] .run progress')]"
    page.wait_for_function(f"() => !{bars}.some((bar) => bar.checkVisibility())")


@pytest.mark.long
@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.parametrize("view", VIEWS)
def test_no_table_is_cut_or_scrolls_sideways(browser, address, view, design):
    with opened_profile(browser, address) as profile:
        user = User(profile, address).open(f"?view={view}&{DESIGNS[design]}{MORE.get(view, '')}")
        assert user.page.locator("#trouble").inner_text() == ""
        finish_work(user.page, view)
        for width in WIDTHS:
            user.page.set_viewport_size({"width": width, "height": 900})
            assert user.page.evaluate(AT_REST) == width
            assert user.page.evaluate(CUT) == [], width
            if PICTURES:
                user.page.screenshot(path=Path(PICTURES) / f"{view}_{design}_{width}.png", full_page=True)
        assert not user.errors
