"""The array library: transforms, and where arrays live. The one place that names its backends; another goes in here.

NumPy arrays are transformed by SciPy. Any other array that follows the array API standard is transformed by its own
library, and a loop written in nothing but the standard runs on it: `namespace` of an array gives its functions.
TREADLOAD_DEVICE=cuda puts the arrays of such loops on a GPU by CuPy.

Source: Python array API standard (2023.12), data-apis.org/array-api.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from types import ModuleType
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray
from scipy import fft as _scipy
from scipy.fft import fftfreq, next_fast_len, rfftfreq

from treadload.kernels.arrays import Array, ComplexArray, Numbers

__all__ = [
    "cosine2", "cosines", "device", "fft", "fftfreq", "ifft", "irfft", "irfft2", "mirrored_waves", "namespace",
    "next_fast_len", "on", "portions", "rfft", "rfft2", "rfftfreq", "sine2", "sines", "to_device", "to_host",
]  # fmt: skip

# Numbers that are transformed at once: what a processor's cache holds, what a GPU keeps busy with.
_AT_ONCE, _AT_ONCE_ELSEWHERE = 2**17, 2**27

Kind = TypeVar("Kind", bound=NDArray[np.generic])
Floats = TypeVar("Floats", bound=Numbers)

_chosen: ContextVar[ModuleType | None] = ContextVar("treadload_array_library", default=None)


def namespace(array: NDArray[np.generic]) -> ModuleType:
    """The functions of the library that an array belongs to."""
    # NumPy 1.26 has what the loops use, but not the method.
    return np if isinstance(array, np.ndarray) else array.__array_namespace__()


def device() -> ModuleType:
    """The library whose arrays the loops run on: NumPy, or that of TREADLOAD_DEVICE, or that of `on`.

    Raises ValueError for a device that there is not.
    """
    chosen = _chosen.get()
    if chosen is not None:
        return chosen
    name = os.environ.get("TREADLOAD_DEVICE") or "cpu"
    if name == "cpu":
        return np
    if name != "cuda":
        raise ValueError(f"TREADLOAD_DEVICE is {name!r}; it can be cpu or cuda")
    try:
        import cupy
    except ImportError as missing:
        raise ValueError(
            "TREADLOAD_DEVICE is 'cuda', and CuPy is not installed; install cupy-cuda12x or leave the variable out"
        ) from missing
    library: ModuleType = cupy
    return library


@contextmanager
def on(library: ModuleType) -> Iterator[None]:
    """Loops inside run on the arrays of a library that follows the standard, whatever TREADLOAD_DEVICE is."""
    token = _chosen.set(library)
    try:
        yield
    finally:
        _chosen.reset(token)


def to_device(array: Kind) -> Kind:
    """An array of `device`."""
    placed: Kind = device().asarray(array)
    return placed


def to_host(array: Kind) -> Kind:
    """A NumPy array."""
    if isinstance(array, np.ndarray):
        return array
    return cast("Kind", array.get() if hasattr(array, "get") else np.array(np.from_dlpack(array)))


def portions(array: NDArray[np.generic], lines: int, length: int) -> Iterator[slice]:
    """Slices that share out some lines, so many at a time as are best transformed at once, each of some length."""
    step = max(1, (_AT_ONCE if isinstance(array, np.ndarray) else _AT_ONCE_ELSEWHERE) // length)
    for first in range(0, lines, step):
        yield slice(first, min(first + step, lines))


def fft(x: Numbers, n: int | None = None, axis: int = -1, overwrite_x: bool = False) -> ComplexArray:
    """As SciPy's; arrays of other libraries are not overwritten."""
    if isinstance(x, np.ndarray):
        waves: ComplexArray = _scipy.fft(x, n=n, axis=axis, overwrite_x=overwrite_x)
    else:
        waves = namespace(x).fft.fft(x, n=n, axis=axis)
    return waves


def ifft(x: Numbers, n: int | None = None, axis: int = -1, overwrite_x: bool = False) -> ComplexArray:
    """As SciPy's; arrays of other libraries are not overwritten."""
    if isinstance(x, np.ndarray):
        values: ComplexArray = _scipy.ifft(x, n=n, axis=axis, overwrite_x=overwrite_x)
    else:
        values = namespace(x).fft.ifft(x, n=n, axis=axis)
    return values


def rfft(x: Array, n: int | None = None, axis: int = -1) -> ComplexArray:
    """As SciPy's."""
    waves: ComplexArray = (_scipy if isinstance(x, np.ndarray) else namespace(x).fft).rfft(x, n=n, axis=axis)
    return waves


def irfft(x: Numbers, n: int | None = None, axis: int = -1) -> Array:
    """As SciPy's."""
    values: Array = (_scipy if isinstance(x, np.ndarray) else namespace(x).fft).irfft(x, n=n, axis=axis)
    return values


def rfft2(x: Array, s: tuple[int, int] | None = None) -> ComplexArray:
    """As SciPy's, over the last two axes."""
    if isinstance(x, np.ndarray):
        waves: ComplexArray = _scipy.rfft2(x, s=s)
    else:
        waves = namespace(x).fft.rfftn(x, s=x.shape[-2:] if s is None else s, axes=(-2, -1))
    return waves


def irfft2(x: ComplexArray, s: tuple[int, int]) -> Array:
    """As SciPy's, over the last two axes."""
    if isinstance(x, np.ndarray):
        values: Array = _scipy.irfft2(x, s=s)
    else:
        values = namespace(x).fft.irfftn(x, s=s, axes=(-2, -1))
    return values


def cosine2(quadrant: Floats) -> Floats:
    """The transform (ny, nx) of what is even both ways about both ends of a quadrant (ny, nx), of which it is one."""
    waves: Floats = _scipy.dctn(quadrant, type=1)
    return waves


def sine2(quadrant: Numbers) -> Numbers:
    """The transform (ny, nx) of what is odd both ways about both ends of a quadrant (ny, nx), of which it is one."""
    result = np.zeros_like(quadrant)
    if min(quadrant.shape) > 2:
        result[1:-1, 1:-1] = -_scipy.dstn(quadrant[1:-1, 1:-1], type=1)
    return result


def mirrored_waves(field: Floats, *, back: bool = False) -> Floats:
    """The cosine waves (ny, nx) of a field (ny, nx) that is mirrored in the borders of its cells; back: the field."""
    turned: Floats = _scipy.idctn(field, type=2) if back else _scipy.dctn(field, type=2)
    return turned


def cosines(half: Floats, n: int, axis: int = -1) -> Floats:
    """The transform (n + 1 numbers) of what is even about 0, zero from n on, and repeats after 2 n, from its half."""
    waves: Floats = _scipy.dct(half, type=1, n=n + 1, axis=axis)
    return waves


def sines(half: Numbers, n: int, axis: int = -1) -> Numbers:
    """As `cosines`, of what is odd, times i: the number at 0 is not read."""
    values = np.moveaxis(half, axis, -1)
    result = np.zeros((*values.shape[:-1], n + 1), half.dtype)
    if n > 1 and values.shape[-1] > 1:
        result[..., 1:n] = _scipy.dst(values[..., 1:], type=1, n=n - 1, axis=-1)
    return np.moveaxis(result, -1, axis)


def cosines_between(half: Numbers, n: int, axis: int = -1) -> Numbers:
    """The transform (n + 1 numbers) of what is even about 0, known at 1/2, 3/2, ..., zero from n on, period 2 n."""
    values = np.moveaxis(_scipy.dct(half, type=2, n=n, axis=axis), axis, -1)
    result = np.zeros((*values.shape[:-1], n + 1), half.dtype)
    result[..., :n] = values
    return np.moveaxis(result, -1, axis)


def sines_between(half: Numbers, n: int, axis: int = -1) -> Numbers:
    """As `cosines_between`, of what is odd, times i."""
    values = np.moveaxis(_scipy.dst(half, type=2, n=n, axis=axis), axis, -1)
    result = np.zeros((*values.shape[:-1], n + 1), half.dtype)
    result[..., 1:] = values
    return np.moveaxis(result, -1, axis)
