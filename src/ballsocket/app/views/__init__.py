"""Views: one question each."""

from .compare import Compare
from .cup import Cup
from .design_map import DesignMap
from .gait import Gait
from .judge import Judge
from .press import Press
from .wear import Wear

KINDS: dict[str, type[Press] | type[Cup] | type[Gait] | type[Wear] | type[DesignMap] | type[Compare] | type[Judge]] = {
    "press": Press,
    "cup": Cup,
    "gait": Gait,
    "wear": Wear,
    "map": DesignMap,
    "compare": Compare,
    "judge": Judge,
}
"""All, by the names that links give them, in the order of the page."""
