"""Make pictures of the explorer, by hand from the root.

Without arguments it makes those of these pages. `python docs/make_app_pictures.py FOLDER [VIEW ...]` makes
pictures of all views, or of some, in three sizes and two themes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.app.browser import User, explorer_process, opened_browser, opened_profile  # noqa: E402

from ballsocket.app.views.registry import VIEW_CLASSES  # noqa: E402

SHELL = "limit=outer_diameter<=52&limit=liner_thickness>=4"
VIEWS = {
    "press": ("?preset=hess-forsbach", 860),
    "map": (f"?view=map&{SHELL}", 800),
    "compare": ("?view=compare&beside1.preset=hip-36&beside2.preset=suspension-ball-joint", 1300),
    "judge": ("?view=judge&preset=hip-28&load.force=3000&cup.arc_of_cover=160&cup.chamfer=1", 960),
}
SCROLLED = {"judge": 500}  # px to the pictures below the tables
SIZES = ((390, 844), (900, 900), (1440, 900))
RUN = ("judge", "wear", "evidence", "cup")
"""Views that show more after a run."""


def page_of(browser: Any, address: str, size: tuple[int, int]) -> Any:
    """Open a page and wait for its first result."""
    page = browser.new_page(viewport={"width": size[0], "height": size[1]})
    page.goto(address)
    page.locator(".app[data-idle=yes][data-shown]").wait_for()
    page.wait_for_function(
        "() => !document.querySelector('section.view:not([hidden])').textContent.toLowerCase().includes('preparing')",
        timeout=120_000,
    )
    return page


def run(page: Any) -> None:
    """Press the button of the view's long work, if it has one, and wait for the end."""
    button = page.locator("section.view:visible [data-name$='.run'] button:visible")
    if button.count() and "Cancel" not in button.first.inner_text():
        button.first.click()
        page.wait_for_timeout(1000)
    page.wait_for_function(
        "() => ![...document.querySelectorAll('section.view:not([hidden]) [data-name$=\".run\"] button')]"
        ".some((button) => button.textContent.includes('Cancel'))",
        timeout=300_000,
    )


def save(page: Any, name: str) -> None:
    """Save what a page shows as a small picture of the documentation."""
    page.wait_for_timeout(2000)
    colours = Image.Quantize.FASTOCTREE
    picture = Image.open(BytesIO(page.screenshot())).convert("RGB").quantize(256, colours, dither=Image.Dither.NONE)
    picture.save(ROOT / "docs" / f"app_{name}.png", optimize=True)


def make_documentation(address: str, browser: Any) -> None:
    """Make the pictures of the page on the explorer."""
    for name, (query, height) in VIEWS.items():
        page = page_of(browser, address + query, (1280, height))
        run(page)
        page.mouse.move(700, 400)
        page.mouse.wheel(0, SCROLLED.get(name, 0))
        save(page, name)


def make_story(address: str, browser: Any) -> None:
    """Make the pictures of the tutorial, in which a designer and a client look at one page."""
    with opened_profile(browser, address, width=1180) as profile:
        user = User(profile, address).open("?preset=hip-28&load.force=3000")
        page = user.page
        page.set_viewport_size({"width": 1180, "height": 720})
        page.get_by_role("button", name="Client view").click()
        save(page, "client_1")
        user.enters("load", "9000")
        save(page, "client_2")
        page.locator("#steps summary").click()
        user.enters("ball_radius", "36")
        save(page, "client_3")
        page.locator("#steps summary").click()
        user.view("One input")
        user.enters("curve.tolerances", "clearance = 0.1 +- 0.02 mm; force = 9 +- 0.9 kN")
        page.locator("#curve-effects tr").last.wait_for()
        page.locator("#curve-effects").scroll_into_view_if_needed()
        save(page, "client_4")
        page.set_viewport_size({"width": 1180, "height": 800})
        user.view("Wear")
        page.locator("[data-name='wear.beside'] select").select_option("hip-28")
        run(page)
        page.locator("#wear-maps svg").last.wait_for()
        save(page, "client_5")


def make_all(address: str, browser: Any, folder: Path, views: Sequence[str]) -> None:
    """Make pictures of views in every size and theme, with the results of their long work."""
    folder.mkdir(parents=True, exist_ok=True)
    for view in views:
        for size in SIZES:
            page = page_of(browser, f"{address}?view={view}&beside1.preset=hip-36&{SHELL}&theme=light", size)
            if view in RUN:
                run(page)
            for theme in ("light", "dark"):
                page.wait_for_timeout(1500)
                page.screenshot(path=folder / f"{view}_{size[0]}_{theme}.png", full_page=True)
                page.locator("#theme").click()
            page.close()


def main(words: Sequence[str]) -> None:
    with explorer_process() as (address, _), opened_browser() as browser:
        if words:
            make_all(address, browser, Path(words[0]), words[1:] or list(VIEW_CLASSES))
        else:
            make_documentation(address, browser)
            make_story(address, browser)


if __name__ == "__main__":
    main(sys.argv[1:])
