"""Views: one question each."""

from ...core.deprecation import renamed_names
from ..view import View
from .compare import Compare
from .cup import CupView
from .design_map import DesignMap
from .evidence import Evidence
from .gait import Gait
from .judge import Judge
from .press import Press
from .wear import Wear

KINDS: dict[str, type[View]] = {
    "press": Press,
    "cup": CupView,
    "gait": Gait,
    "wear": Wear,
    "map": DesignMap,
    "compare": Compare,
    "judge": Judge,
    "evidence": Evidence,
}
"""All, by the names that links give them, in the order of the page."""

__getattr__ = renamed_names(__name__, {"Cup": "CupView"})
