"""Executors of numbered pieces of work: this process, several processes of this machine, or a Dask cluster."""

from .dask import Distributed
from .processes import Engine, Processes, Serial

__all__ = ["Distributed", "Engine", "Processes", "Serial"]
