"""Name, sources and validity of a model: the properties that catalogue, results, tables and citations read."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from ..core.arrays import Array
from ..core.deprecation import renamed_names
from ..core.sources import Source
from ..core.validity import Promise, Range, Remark
from ..problem import Joint


class ModelInfo(ABC):
    """Base class for the description of a model: name, sources and validity.

    Attributes
    ----------
    name, title : str
        Key in the catalogue; description in one line.
    sources : tuple of Source
        Publications of the formulas.
    validity : tuple of Range
        Closed ranges in which a result is valid.
    promise : Promise or None
        Measured largest difference from the elastic solution inside the validity; None if it was not measured.
    remarks : tuple of Remark
        Ranges outside of which a valid result gets a note.
    reach : str
        Description of the loads that have a result, printed with results that have none; may be empty.
    planar : bool
        True if the contact is a flat circle whose pressure has one direction, False if pressure acts along the radius.
    """

    reach: ClassVar[str] = ""
    planar: ClassVar[bool] = False

    @property
    @abstractmethod
    def name(self) -> str:
        """Key of the model in the catalogue, in files and on the command line."""

    @property
    @abstractmethod
    def title(self) -> str:
        """One-line description of the model."""

    @property
    @abstractmethod
    def sources(self) -> tuple[Source, ...]:
        """Publications of the model's formulas."""

    @property
    @abstractmethod
    def validity(self) -> tuple[Range, ...]:
        """Ranges of contact quantities in which a result is valid."""

    @property
    def promise(self) -> Promise | None:
        """Largest measured relative difference from the elastic solution; None if it was not measured."""
        return None

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """Ranges of contact quantities outside of which a valid result gets a note."""
        return ()

    def numpy_laws(self, joint: Joint, indentation: Array) -> Any:
        """Solve a contact at an indentation in mm with NumPy numbers, and return its formulas or solution.

        These become infinite or NaN where Python floats raise ArithmeticError.
        """
        raise NotImplementedError(f"{self.name} has no laws of a contact")


__getattr__ = renamed_names(__name__, {"Theory": "ModelInfo"})
