"""Pictures of fringes from files: PNG, TIFF and other grey pictures, or an array of NumPy."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from treadload.errors import InputError, how_to_install, one_line
from treadload.kernels.arrays import Array

# Pixels of one picture, and of all pictures of one pattern.
LARGEST, LARGEST_STACK = 25_000_000, 400_000_000
# Modes of Pillow for one grey channel.
_GREY = ("L", "I", "F", "I;16", "I;16L", "I;16B", "I;16N")
_NUMBER = re.compile(r"(\d+)(?!.*\d)")


def read_pictures(names: str | Sequence[str], folder: Path, what: str, steps: int | None = None) -> Array:
    """Grey levels (n, rows, columns) of the pictures of one pattern.

    names: files from the folder, one a step, in order; or one text: a pattern with "*", whose files are numbered, or
    an array of shape (n, rows, columns) as .npy. what: they are, for errors. steps: how many there must be. Raises
    InputError for a missing file or step, a colour picture, several sizes, and more pixels than are taken, which the
    header of a file states before it is decoded.
    """
    files = _files(names, folder, what)
    if len(files) == 1 and files[0].suffix.lower() == ".npy":
        stack = _array(files[0])
        if stack.ndim != 3:
            raise InputError(f"{files[0]} must hold an array (steps, rows, columns), got shape {stack.shape}")
    else:
        first: Array | None = None
        pictures: list[Array] = []
        for file in files:
            picture = _array(file) if file.suffix.lower() == ".npy" else _picture(file)
            if picture.ndim != 2:
                raise InputError(f"{file} must hold one grey picture (rows, columns), got shape {picture.shape}")
            first = picture if first is None else first
            if picture.shape != first.shape or picture.dtype != first.dtype:
                raise InputError(
                    f"{what}: {file.name} has {picture.shape[1]} x {picture.shape[0]} pixels of {picture.dtype}, "
                    f"{files[0].name} {first.shape[1]} x {first.shape[0]} of {first.dtype}; all steps need one "
                    "camera and one size"
                )
            pictures.append(picture)
            _check_size(len(files) * picture.size, LARGEST_STACK, what)
        stack = np.stack(pictures)
    if steps is not None and len(stack) != steps:
        raise InputError(
            f"{what}: {len(stack)} pictures where steps = {steps} states so many; a step is missing or twice"
        )
    return stack


def _files(names: str | Sequence[str], folder: Path, what: str) -> list[Path]:
    if not isinstance(names, str):
        listed = [folder / name for name in names]
    elif "*" in names:
        listed = sorted(folder.glob(names), key=_in_order)
        numbers = [match[0] for match in map(_number, listed) if match is not None]
        if not listed:
            raise InputError(f"{what}: no file is called {str(folder / names)!r}; check the folder and the name")
        if len(numbers) == len(listed):
            counted = [int(number) for number in numbers]
            missing = sorted(set(range(counted[0], counted[-1] + 1)) - set(counted))
            if missing:
                raise InputError(
                    f"{what}: step {missing[0]} of {names!r} is missing; take it again, or list the files"
                )
    else:
        listed = [folder / names]
    for file in listed:
        if not file.is_file():
            raise InputError(f"{what}: no picture {str(file)!r}; a step is missing, or its name is not this")
    return listed


def _number(file: Path) -> re.Match[str] | None:
    return _NUMBER.search(file.stem)


def _in_order(file: Path) -> tuple[str, int, str]:
    match = _number(file)
    return ("", int(match[0]), file.name) if match else (file.name, 0, file.name)


def _picture(file: Path) -> Array:
    # Pillow comes with matplotlib; nothing but pictures needs it.
    try:
        from PIL import Image
    except ImportError as error:
        raise InputError(
            f"pictures are read by Pillow, which is not installed: {how_to_install('fringes')}"
        ) from error

    try:
        with warnings.catch_warnings():
            # Our own bound follows at once.
            warnings.simplefilter("ignore")
            with Image.open(file) as image:
                _check_size(image.width * image.height, LARGEST, str(file))
                frames = getattr(image, "n_frames", 1)
                if frames > 1:
                    raise InputError(f"{file} holds {frames} pictures; save each as a file of its own")
                if image.mode in ("RGB", "RGBA", "LA"):
                    bands = image.split()
                    values = [np.asarray(band) for band in bands[: 1 if image.mode == "LA" else 3]]
                    if any((values[0] != row_value).any() for row_value in values[1:]):
                        raise InputError(f"{file} is a colour picture; save it in grey, of one channel of the camera")
                    return values[0]
                if image.mode not in _GREY:
                    raise InputError(f"{file} has pixels of kind {image.mode!r}; save it as a grey PNG or TIFF")
                return np.array(image)
    except InputError:
        raise
    # What a picture breaks in Pillow is of every kind.
    except Exception as error:
        raise InputError(f"cannot read {file} as a picture: {one_line(str(error))}; take or copy it again") from error


def _array(file: Path) -> Array:
    try:
        # The head tells shape and kind; a file shorter than they say is refused when it is mapped.
        mapped = np.load(file, mmap_mode="r", allow_pickle=False)
    except Exception as error:
        raise InputError(f"cannot read {file} as an array of NumPy: {one_line(str(error))}") from error
    if mapped.dtype.kind not in "uif":
        raise InputError(f"{file} must hold numbers, got {mapped.dtype}")
    _check_size(mapped.size, LARGEST_STACK, str(file))
    values = np.array(mapped)
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise InputError(f"{file} has {int((~np.isfinite(values)).sum())} grey levels that are no finite numbers")
    return values


def _check_size(pixels: int, most: int, what: str) -> None:
    if pixels > most:
        raise InputError(f"{what} has {pixels} pixels, more than {most}; make the pictures smaller")
