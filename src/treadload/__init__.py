"""treadload: what a tire does to a road."""

from treadload._version import __version__

__all__ = ["__version__"]
