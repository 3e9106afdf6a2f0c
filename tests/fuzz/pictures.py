"""Pictures of footprints in earnest: formats, modes, palettes, scales, boxes and transparency, and what is wrong.

A picture is made here by colours of known pressures and saved by Pillow as other programs save it. What is accepted
must hold these pressures to what 255 steps of a channel leave.
"""

from __future__ import annotations

import io
import random
import struct
import warnings
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, PngImagePlugin

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from treadload.footprint import read_footprint

_SCALE = [("#000000", 0.0), ("#0000ff", 2e5), ("#00ff00", 5e5), ("#ff0000", 1e6)]
_COLOURS = np.array([[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name, _ in _SCALE], dtype=float)
_PRESSURES = np.array([pressure for _, pressure in _SCALE])
# Half a step of 255 over the longest part of the scale, twice that where a bar of 256 colours is rounded as well.
_SAME, _BAR = 500e3 / 255, 1e6 / 255
_FORMATS = (("png", "RGB"), ("png", "RGBA"), ("png", "P"), ("bmp", "RGB"), ("tif", "RGB"), ("tif", "RGBA"))
_PIXEL = 1e-3


def prepare() -> None:
    """Plug-ins of Pillow are loaded before warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        Image.init()


def attack(rng: random.Random, folder: Path) -> str:
    """Write a picture, perhaps with a colour bar and a frame, or with something wrong, and read it."""
    rows, columns = rng.randrange(3, 12), rng.randrange(3, 12)
    wanted = np.array([[rng.choice((0.0, rng.random(), 1.0)) for _ in range(columns)] for _ in range(rows)]) * 1e6
    wanted[rng.randrange(rows), rng.randrange(columns)] = 7e5
    suffix, mode = rng.choice(_FORMATS)
    if mode == "P":
        # A palette has 256 colours at most: pressures of the scale itself.
        wanted = rng.choice((_PRESSURES[1:].max(), 2e5)) * (wanted > 4e5)
        wanted[0, 0] = 5e5
    pixels = _painted(wanted)
    options: dict[str, Any] = {"colours": _SCALE, "spacing": _PIXEL}
    if mode != "P" and rng.random() < 0.5:
        pixels, options = _framed(rng, pixels, options)
    if mode == "RGBA" and rng.random() < 0.5 and "crop" not in options:
        # What is transparent lies on white, which means no pressure.
        clear = (np.array([rng.random() < 0.2 for _ in wanted.flat])).reshape(wanted.shape) & (wanted < 6e5)
        pixels = np.dstack([pixels, np.where(clear, 0, 255).astype(np.uint8)])
        wanted = np.where(clear, 0.0, wanted)
        options["background"] = "#ffffff"
    image = Image.fromarray(pixels)
    image = image.convert(mode) if image.mode != mode and mode != "P" else image
    image = _of_palette(pixels) if mode == "P" else image
    content = _saved(rng, image, suffix)
    wrong = rng.random() < 0.25
    if wrong:
        content, options = _spoiled(rng, content, options, pixels.shape)
    path = folder / f"print.{suffix}"
    path.write_bytes(content)
    answer = ask(lambda: read_footprint(path, **options))
    if isinstance(answer, Refusal):
        return _refused(answer, wrong, path)
    found = np.asarray(answer.pressure)
    if not (np.isfinite(found).all() and found.min() >= 0 and found.max() <= 1e6 * (1 + 1e-9)):
        raise WrongAnswer(f"pressures of {found.min()} to {found.max()} Pa on a scale from 0 to 1 MPa")
    if wrong:
        return "taken though changed"
    if not np.isclose(answer.grid.dx, _PIXEL) or not np.isclose(answer.grid.dy, _PIXEL):
        raise WrongAnswer(f"pixels of {answer.grid.dx} x {answer.grid.dy} m")
    if found.shape != wanted.shape or np.abs(found - wanted).max() > (_BAR if "bar" in options else _SAME):
        raise WrongAnswer(f"off by {np.abs(found - wanted).max() if found.shape == wanted.shape else found.shape}")
    return TAKEN


def _painted(pressures: np.ndarray) -> np.ndarray:
    """Colours (rows, columns, 3) of pressures."""
    parts = [np.interp(pressures, _PRESSURES, _COLOURS[:, k]) for k in range(3)]
    return np.round(np.stack(parts, axis=-1)).astype(np.uint8)


def _of_palette(pixels: np.ndarray) -> Image.Image:
    """The same picture with a palette of its colours, of 256 or fewer."""
    colours, which = np.unique(pixels[..., :3].reshape(-1, 3), axis=0, return_inverse=True)
    image = Image.fromarray(which.reshape(pixels.shape[:2]).astype(np.uint8), "L")
    image.putpalette(colours.ravel().tolist())
    return image


def _framed(rng: random.Random, pixels: np.ndarray, options: dict[str, Any]) -> tuple[np.ndarray, dict[str, Any]]:
    """The map within a larger picture of grey, with its box, and at times with its colour bar in place of pairs."""
    rows, columns = pixels.shape[:2]
    left, top = rng.randrange(5), rng.randrange(5)
    length = 256
    picture = np.full((top + rows + 12, max(left + columns + 3, length + 4), 3), 128, dtype=np.uint8)
    picture[top : top + rows, left : left + columns] = pixels
    options = options | {"crop": (left, top, left + columns, top + rows)}
    if rng.random() < 0.5:
        # A lying bar of even steps of pressure.
        bar = _painted(np.linspace(0, 1e6, length))
        picture[top + rows + 3 : top + rows + 9, 2 : 2 + length] = bar
        options = options | {"bar": (2, top + rows + 3, 2 + length, top + rows + 9), "scale": (0.0, "1 MPa")}
        del options["colours"]
    return picture, options


def _saved(rng: random.Random, image: Image.Image, suffix: str) -> bytes:
    """A file with tags, resolutions and packings that mean nothing here."""
    stream, options = io.BytesIO(), {}
    if suffix == "png":
        words = PngImagePlugin.PngInfo()
        words.add_text("Title", rng.choice(("a print", "größe", "x" * 5000)))
        options = {"pnginfo": words, "compress_level": rng.randrange(10), "dpi": (rng.choice((0, 72, 10**6)),) * 2}
    elif suffix == "tif":
        options = {"compression": rng.choice((None, "tiff_lzw", "tiff_deflate", "packbits"))}
    image.save(stream, suffix.replace("tif", "tiff"), **options)
    return stream.getvalue()


def _spoiled(
    rng: random.Random, content: bytes, options: dict[str, Any], shape: tuple[int, ...]
) -> tuple[bytes, dict[str, Any]]:
    """Content or options with something wrong."""
    which = rng.randrange(10)
    if which < 3:
        return broken(rng, content), options
    if which == 3:
        return content[: rng.randrange(len(content))], options
    if which == 4:
        # A head of a picture that would fill the memory, with a right checksum.
        size = rng.choice(((2**31 - 1, 2**31 - 1), (60_000, 60_000), (0, 5), (3000, 3000)))
        return _png(size, zlib.compress(bytes(1000))), options
    if which == 5:
        # Rows that unpack to 40 MB where 4 pixels are told of.
        return _png((2, 2), zlib.compress(bytes(4 * 10**7))), options
    if which == 6:
        rows, columns = shape[:2]
        box = rng.choice(((0, 0, columns + 1, rows), (-1, 0, 2, 2), (2, 2, 2, 3), (0, 0, 1e9, 2), (0, 0, 2), "all"))
        return content, options | {"crop": box}
    if which == 7:
        odd = (0, -1e-3, float("nan"), "5", "1 kg", (1e-3,), (1e-3, -1e-3), float("inf"), "0 mm", None)
        return content, options | {"spacing": rng.choice(odd)}
    if which == 8:
        scales: Any = (
            [], [("#000000", 0.0)], [("#00000", 0), ("red", 1)], [((0, 0, 999), 0), ((1, 1, 1), 1)], "no such map",
            [("#000000", 5.0), ("#0000ff", 5.0)], 7, [7, 8], [("#000000", "1 kg")] * 2, {"#000000": 0, "#0000ff": 1},
        )  # fmt: skip
        kept = {key: value for key, value in options.items() if key not in ("bar", "scale")}
        return content, kept | {"colours": rng.choice(scales)}
    frames = [Image.new(rng.choice(("RGB", "1", "CMYK", "I", "F", "LAB")), (3, 3)) for _ in range(2)]
    stream = io.BytesIO()
    frames[0].save(stream, "tiff")
    return rng.choice(
        (stream.getvalue(), b"", b"GIF89a" + bytes(20), b"<svg/>", b"\xff\xd8\xff\xe0" + bytes(50))
    ), options


def _png(size: tuple[int, int], data: bytes) -> bytes:
    """A PNG of RGB with this size in its head and these packed rows."""

    def chunk(name: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    head = struct.pack(">2I5B", *size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
