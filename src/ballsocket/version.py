"""The version of the package, in the one place that all others read."""

__version__ = "1.0.0"
