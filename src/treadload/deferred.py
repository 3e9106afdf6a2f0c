"""xarray, loaded when it is first used: it brings pandas, and the start of a command would wait for both."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xarray
else:

    class _Deferred(ModuleType):
        """In place of xarray until one of its names is used."""

        def __getattr__(self, name: str) -> object:
            import xarray

            value = getattr(xarray, name)
            setattr(self, name, value)
            return value

        def __reduce__(self) -> str:
            return "xarray"

    xarray = _Deferred("xarray")
