"""Who computes: this process, several on this machine, or a Dask cluster; the pieces of work are the same."""

from .dask import Distributed
from .local import Engine, Processes, Serial

__all__ = ["Distributed", "Engine", "Processes", "Serial"]
