"""Errors that say what was wrong, the number, the bound and the remedy."""


class TreadloadError(Exception):
    """Base of every error that treadload raises on purpose."""


class InputError(TreadloadError, ValueError):
    """A value from the user is outside its bounds, missing, or cannot be read."""


class GeometryError(TreadloadError, ValueError):
    """A mesh, cloud or height map does not describe a usable tire surface."""


class ConvergenceError(TreadloadError, RuntimeError):
    """A solver stopped before it reached its tolerance; carries the residual reached."""

    def __init__(self, message: str, residual: float = float("nan")) -> None:
        super().__init__(message)
        self.residual = residual


def how_to_install(extra: str) -> str:
    """What to run for a package of an extra, such as "scan"; it works in a clone, which is all there is so far."""
    return f"in the folder of the clone, run  pip install '.[{extra}]'"
