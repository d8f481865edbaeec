from collections.abc import Callable
from typing import Any

from .axes import Span as Span
from .derivatives import elasticities as elasticities
from .design import Design as Design
from .design import grid as grid
from .design import sample as sample
from .design import table as table
from .distributions import LogNormal as LogNormal
from .distributions import Method as Method
from .distributions import Normal as Normal
from .distributions import Rectangular as Rectangular
from .distributions import tolerance as tolerance
from .expressions import parse_limit as parse_limit
from .file import read_study as read_study
from .file_formats import export as export
from .limits import Limit as Limit
from .limits import allowed as allowed
from .optimisation import Optimum as Optimum
from .optimisation import optimise as optimise
from .optimisation import pareto as pareto
from .parameters import PARAMETERS as PARAMETERS
from .run import Progress as Progress
from .run import study as study
from .store import read as read
from .variance_shares import sensitivity as sensitivity

band_figure: Callable[..., Any]
design_map: Callable[..., Any]
front_figure: Callable[..., Any]
sensitivity_figure: Callable[..., Any]
