"""Texts of a profile laser for tests, made from a tread that is known."""

import math

import numpy as np

from treadload.tire import TreadProfile, equal_ribs

TREAD = TreadProfile(0.5, 2.0, 0.2, 0.010, equal_ribs(0.2, 3, 0.012, 0.012, math.radians(8)))
AXLE = 0.31


def profiles(
    *, degrees=360.0, lines=900, columns=401, noise=0.1e-3, jitter=0.2, dropouts=0.03, tilt=0.0, bump=None, seed=1
):
    """Encoder (n,) rad, x (m,) m and heights (n, m) above the laser's zero, m, NaN where nothing came back.

    jitter: of the encoder's reading, in steps. tilt: of the laser in its plane, rad. bump: (angle, rad, y, m) of a
    knob of 4 mm and 8 mm width on the tread.
    """
    random = np.random.default_rng(seed)
    step = math.radians(degrees) / lines
    true = step * np.arange(lines)
    x = np.linspace(-0.115, 0.115, columns)
    # What the laser sees at x of its own: the tread, looked at along its tilted rays.
    y = np.broadcast_to(x, (lines, columns)).copy()
    for _ in range(30):
        height = _radius(y, true, bump) - AXLE
        if not tilt:
            break
        y = math.cos(tilt) * x - math.sin(tilt) * (height - math.sin(tilt) * x) / math.cos(tilt)
    z = (height - math.sin(tilt) * x) / math.cos(tilt) + random.normal(scale=noise, size=height.shape)
    z[random.random(z.shape) < dropouts] = np.nan
    reading = true + step * jitter * random.normal(size=lines)
    return reading, x, z


def _radius(y, angle, bump):
    drop = TREAD.drop(np.clip(y, -0.0999, 0.0999))
    r = TREAD.rolling_radius - drop - 2 * np.maximum(np.abs(y) - 0.0999, 0)
    if bump is not None:
        away = np.maximum(np.abs((angle[:, None] - bump[0]) * 0.5), np.abs(y - bump[1]))
        r = r + 4e-3 * (away < 4e-3)
    return r


def write_rows(folder, encoder, x, z, about, *, name="lines.csv", unit=180 / math.pi, mark=",", missing=""):
    """A text of rows in mm and its TOML; returns the path of this."""
    head = mark.join(["encoder", *(f"{1e3 * one:.4f}" for one in x)])
    cell = np.where(np.isfinite(z), np.char.mod("%.4f", 1e3 * z), missing)
    body = [mark.join([f"{unit * one:.6f}", *row]) for one, row in zip(encoder, cell, strict=True)]
    (folder / name).write_text("\n".join(["# made for a test", head, *body]) + "\n")
    path = folder / name.replace(".csv", ".toml")
    path.write_text(f'[laser]\nfile = "{name}"\nlayout = "rows"\nx = "mm"\nz = "mm"\n{about}\n')
    return path


def write_points(folder, encoder, x, z, about, *, unit=180 / math.pi):
    """A text of points in mm, tabs between them, and its TOML; returns the path of this."""
    lines = ["encoder\tx\tz"]
    for one, row in zip(encoder, z, strict=True):
        lines += [f"{unit * one:.6f}\t{1e3 * a:.4f}\t{1e3 * b:.4f}" for a, b in zip(x, row, strict=True)]
    (folder / "points.txt").write_text("\n".join(lines) + "\n")
    path = folder / "points.toml"
    path.write_text(f'[laser]\nfile = "points.txt"\nlayout = "points"\nx = "mm"\nz = "mm"\n{about}\n')
    return path
