"""Registry of the views of the page."""

from ..view import View
from .compare.view import Compare
from .contact.view import Press
from .cup.view import CupView
from .design_map.view import DesignMap
from .evidence.view import Evidence
from .finite_elements.view import Judge
from .gait.view import Gait
from .wear.view import Wear

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
