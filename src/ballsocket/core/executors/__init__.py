"""Executors of numbered pieces of work: this process, several processes of this machine, or a Dask cluster (`dask`)."""

from .processes import Engine, Processes, Serial

__all__ = ["Engine", "Processes", "Serial"]
