"""Make pictures of the explorer, by hand from the root.

Without arguments it makes those of these pages. `python docs/make_app_pictures.py FOLDER [VIEW ...]` makes
pictures of all views, or of some, in three sizes and two themes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.app.browser import explorer_process, opened_browser  # noqa: E402

from ballsocket.app.views.registry import VIEW_CLASSES  # noqa: E402

SHELL = "limit=outer_diameter<=52&limit=liner_thickness>=4"
VIEWS = {
    "press": ("?preset=hess-forsbach", 860),
    "map": (f"?view=map&{SHELL}", 800),
    "compare": ("?view=compare&beside1.preset=hip-36&beside2.preset=suspension-ball-joint", 1300),
    "judge": ("?view=judge&preset=hip-28&load.force=3000&cup.arc_of_cover=160&cup.chamfer=1", 960),
}
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


def make_documentation(address: str, browser: Any) -> None:
    """Make the pictures of the documentation."""
    for name, (query, height) in VIEWS.items():
        page = page_of(browser, address + query, (1280, height))
        run(page)
        page.wait_for_timeout(2000)
        page.screenshot(path=ROOT / "docs" / f"app_{name}.png")


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


if __name__ == "__main__":
    main(sys.argv[1:])
