"""Figure that notebooks display as an image."""

from __future__ import annotations

import sys
from importlib import import_module
from io import BytesIO
from typing import Any

from matplotlib.figure import Figure


class NotebookFigure(Figure):
    """Matplotlib figure that is displayed once, with and without `%matplotlib inline`.

    A figure that pyplot does not know is plain text in a notebook until that magic registers a formatter for `Figure`.
    The formatter then replaces this method.
    """

    def _repr_png_(self) -> bytes:
        stream = BytesIO()
        self.savefig(stream, format="png", dpi="figure")
        return stream.getvalue()

    def show(self, warn: bool = True) -> None:
        """Display the figure in a notebook.

        Raises RuntimeError: Python runs elsewhere, and pyplot does not know the figure.
        """
        ipython: Any = sys.modules.get("IPython")
        if self.canvas.manager is not None:
            super().show(warn)
        elif ipython is not None and hasattr(ipython.get_ipython(), "kernel"):
            import_module("IPython.display").display(self)
        else:
            raise RuntimeError("a figure is displayed in notebooks only; write it with figure.savefig('contact.png')")
