"""Makes the pictures of the explorer in these pages: `python docs/make_app_pictures.py`, from the root, by hand."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.app.browser import opened_browser, served_explorer  # noqa: E402

SHELL = "limit=outer_diameter<=52&limit=liner_thickness>=4"
VIEWS = {
    "press": ("?preset=hess-forsbach", 860),
    "map": (f"?view=map&{SHELL}", 800),
    "compare": ("?view=compare&beside1.preset=hip-36&beside2.preset=suspension-ball-joint", 1300),
    "judge": ("?view=judge&preset=hip-28&load.force=3000&cup.arc_of_cover=160&cup.chamfer=1", 960),
}


def main() -> None:
    with served_explorer() as address, opened_browser() as browser:
        for name, (query, height) in VIEWS.items():
            page = browser.new_page(viewport={"width": 1280, "height": height})
            page.goto(address + query)
            page.locator(".app[data-idle=yes][data-shown]").wait_for()
            if name == "judge":
                page.locator(".bk-btn", has_text="Run finite elements").click()
                page.locator("img[alt^='mesh, von Mises']").wait_for()
            page.wait_for_timeout(2000)
            page.screenshot(path=ROOT / "docs" / f"app_{name}.png")


if __name__ == "__main__":
    main()
