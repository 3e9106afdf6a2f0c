"""treadload: what a tire does to a road.

The public names are those of `__init__.pyi`, each loaded when it is first used, so that importing the package stays
quick. The subpackages hold the rest: `materials`, `damage`, `life`, `catalogue`, `plots`, ...
"""

from treadload import _public

__all__ = _public.NAMES
__getattr__ = _public.named
__dir__ = _public.names
