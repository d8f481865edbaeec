"""Files of the page as a browser gets them."""

from __future__ import annotations

from html import escape
from importlib.resources import files

from .view import FILE_KINDS
from .views.registry import VIEW_CLASSES, view_class

_KINDS = {".html": "text/html; charset=UTF-8", ".js": "text/javascript; charset=UTF-8", ".css": "text/css"}


def page_files() -> dict[str, tuple[str, str]]:
    """Read the files of the page: kind and content by name."""
    folder = files("ballsocket") / "app" / "assets"
    contents = {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}
    kinds = {name: view_class(name) for name in VIEW_CLASSES}
    modules = sorted(name for name in contents if name.endswith(".js"))
    parts = {
        "<!--modules-->": "".join(f'<link rel="modulepreload" href="assets/{name}">\n' for name in modules),
        "<!--scripts-->": "".join(f'<script type="module" src="assets/{name}"></script>\n' for name in modules),
        "<!--views-->": _buttons("view", {name: kind.title for name, kind in kinds.items()}),
        "<!--files-->": _buttons("file", {kind: kind for kind in FILE_KINDS}),
        "<!--sections-->": "".join(
            f'<section class="view" data-view="{name}" aria-label="{kind.title}" hidden>{kind.body}</section>\n'
            for name, kind in kinds.items()
        ),
    }
    for mark, html in parts.items():
        contents["page.html"] = contents["page.html"].replace(mark, html)
    return {name: (_KINDS[name[name.rindex(".") :]], content) for name, content in contents.items()}


def _buttons(kind: str, words: dict[str, str]) -> str:
    return "".join(
        f'<button type="button" data-{kind}="{escape(name)}">{escape(label)}</button>' for name, label in words.items()
    )
