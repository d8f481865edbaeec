"""How the pages are made: `sphinx-build -W -b html docs site`. Nothing is fetched from a network, then or later."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

import ballsocket  # noqa: E402

project = "ballsocket"
author = "The ballsocket developers"
project_copyright = author
version = release = ballsocket.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.intersphinx",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "generated",
    "mathml",
    "offline",
    "palettes",
    "rooms",
    "used",
]
exclude_patterns = ["_build", "_generated", "inventories/README.md", "paper/paper.md"]
nitpicky = True
nitpick_ignore_regex = [("py:(class|obj|data|exc)", ".*")]  # words of a docstring: linked where they are names

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_dmath_double_inline = True

suppress_warnings = ["ref.python"]  # a quantity is an attribute of several answers
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "exclude-members": "__init__"}
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

intersphinx_mapping = {  # names are looked up here, in files: docs/inventories/README.md
    "python": ("https://docs.python.org/3", "inventories/python.inv"),
    "scipy": ("https://docs.scipy.org/doc/scipy", "inventories/scipy.inv"),
    "pandas": ("https://pandas.pydata.org/docs", "inventories/pandas.inv"),
}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

html_theme = "furo"
html_logo = "_static/logo.svg"
html_favicon = "_static/logo.svg"
html_title = f"ballsocket {release}"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_css_files = ["ballsocket.css"]
html_extra_path = ["_generated/report"]
html_show_sphinx = False
pygments_dark_style = "github-dark"

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "backreferences_dir": "_generated/used",
    "doc_module": ("ballsocket",),
    "image_scrapers": ("pictures.moved_pictures",),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 3600,
}


def setup(app):
    app.connect("autodoc-process-signature", _short_defaults)


def _short_defaults(app, what, name, thing, options, signature, returned):
    """Defaults as one would write them, not as they print themselves."""
    if signature is None:
        return None
    for printed, written in (
        (r"<class '[\w.]*?(\w+)'>", r"\1"),
        (r"<function (\w+)[^>]*>", r"\1"),
        (r"<(\w+\.\w+): [^>]*>", r"\1"),
        (r"(Cup|Adapted)\([^()]*\)", r"\1()"),
        ("3.141592653589793", "π"),
        ("1.5707963267948966", "π/2"),
    ):
        signature = re.sub(printed, written, signature)
    return signature, returned
