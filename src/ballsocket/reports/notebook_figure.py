"""Figure that notebooks display as an image."""

from __future__ import annotations

from io import BytesIO

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
