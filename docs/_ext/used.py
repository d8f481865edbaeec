"""Under each name that the reference explains: the examples of the gallery that use it."""

import re
from pathlib import Path

SHOWN = 6


def setup(app):
    app.connect("autodoc-process-docstring", _used)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _used(app, what, name, thing, options, lines):
    """Appends the list to a docstring; the gallery is made before the pages are read."""
    found = Path(app.srcdir, app.config.sphinx_gallery_conf["backreferences_dir"], f"{name}.examples")
    if found.is_file():
        examples = sorted(set(re.findall(r":doc:`(/gallery/\w+)`", found.read_text(encoding="utf-8"))))
        more = f" and {len(examples) - SHOWN} more" if len(examples) > SHOWN else ""
        if examples:
            shown = ", ".join(f":doc:`{example}`" for example in examples[:SHOWN])
            lines += ["", f"*Used in the gallery:* {shown}{more}.", ""]
