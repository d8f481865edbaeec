"""What a theory is: something published that can be listed, cited and trusted."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

from ..core.sources import Source
from ..core.validity import Promise, Range, Remark


class ModelInfo(ABC):
    """What can be listed, cited, and trusted inside of ranges; how it is asked is up to its kind.

    Attributes
    ----------
    name, title : str
        As in the catalogue; one line for people.
    sources : tuple of Source
        Where the formulas come from.
    validity : tuple of Range
        Closed ranges inside which the answer can be trusted.
    promise : Promise or None
        How close to the elastic answer it is there, as measured; None where there is nothing to measure it by.
    remarks : tuple of Remark
        Where something is to be said of an answer that can be trusted.
    reach : str
        What loads have an answer, in words for those that have none; empty where there is nothing to say.
    """

    reach: ClassVar[str] = ""

    @property
    @abstractmethod
    def name(self) -> str: ...

    @property
    @abstractmethod
    def title(self) -> str: ...

    @property
    @abstractmethod
    def sources(self) -> tuple[Source, ...]: ...

    @property
    @abstractmethod
    def validity(self) -> tuple[Range, ...]: ...

    @property
    def promise(self) -> Promise | None:
        return None

    @property
    def remarks(self) -> tuple[Remark, ...]:
        return ()
