"""From two scans of a worn truck tire, one a third of the turn and holed, to its wear and its contact.

The scans are made here from a tread that is known, as a scanner would leave it: in an arbitrary pose, in
millimetres, with noise, flipped triangles and half of the groove cells missing; the contact is solved on what was
read.
`python examples/scan_to_contact/run.py` writes scan.png, contact.png and the numbers.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.plots import save
from treadload.plots.scan import scan as scan_figure
from treadload.results.scanned import scan_fields, scan_wear
from treadload.tire import TreadProfile, equal_ribs

WIDTH, WORN = 0.2, 4e-3
NEW = TreadProfile(0.5, 2.0, WIDTH, 0.010, equal_ribs(WIDTH, 3, 0.012, 0.012))
NOW = TreadProfile(0.5 - WORN, 2.0, WIDTH, 0.010, equal_ribs(WIDTH, 3, 0.012, 0.012 - WORN))


def scanned(
    path: Path, tread: TreadProfile, degrees: float, seed: int, holes: float = 0.0, noise: float = 0.2e-3
) -> Path:
    """A PLY mesh in mm of a tread, as a scanner leaves it."""
    random = np.random.default_rng(seed)
    edges = [
        g.centre + side * 0.5 * g.width + nudge for g in tread.grooves for side in (-1, 1) for nudge in (-1e-4, 1e-4)
    ]
    y = np.union1d(np.linspace(-0.5 * WIDTH + 1e-4, 0.5 * WIDTH - 1e-4, 90), edges)
    drop = tread.drop(y)
    theta = np.linspace(-0.5, 0.5, round(2.2 * degrees)) * math.radians(degrees)
    r = np.repeat((tread.rolling_radius - drop)[:, None], len(theta), 1)
    r += random.normal(scale=noise, size=r.shape)
    at = np.stack([r * np.sin(theta), np.repeat(y[:, None], len(theta), 1), r * np.cos(theta)], axis=-1).reshape(
        -1, 3
    )
    row, column = (a.ravel() for a in np.meshgrid(np.arange(len(y) - 1), np.arange(len(theta) - 1), indexing="ij"))
    a = row * len(theta) + column
    faces = np.concatenate(
        [np.stack([a, a + 1, a + len(theta)], 1), np.stack([a + 1, a + 1 + len(theta), a + len(theta)], 1)]
    )
    deep = np.array([np.abs(y - g.centre) < 0.5 * g.width for g in tread.grooves]).any(axis=0)
    cell = (row // 3) * 10_000 + column // 3
    gone = (random.random(cell.max() + 1) < holes)[cell] & deep[row]
    faces = faces[~np.tile(gone, 2)]
    flipped = random.random(len(faces)) < 0.3
    faces[flipped] = faces[flipped][:, ::-1]
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    at = 1e3 * (at @ turn.T + random.normal(size=3))
    head = f"ply\nformat ascii 1.0\nelement vertex {len(at)}\nproperty float x\nproperty float y\nproperty float z\n"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    with path.open("w") as file:
        file.write(head)
        np.savetxt(file, at, fmt="%.4f")
        np.savetxt(file, np.column_stack([np.full(len(faces), 3), faces]), fmt="%d")
    return path


def main(folder: Path, spacing: float = 4e-3) -> dict[str, float]:
    """Scans, wear, contact; returns the numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    old = tl.Tire.from_scan(scanned(folder / "new.ply", NEW, 360, 1), units="mm")
    tire = tl.Tire.from_scan(
        scanned(folder / "worn.ply", NOW, 120, 2, holes=0.5), units="mm", smooth="auto", inflation_pressure=820e3
    )
    gone = scan_wear(tire, old)
    save(scan_figure(scan_fields(tire, old)), folder / "scan.png")
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    rolling = tl.Rolling(normal_load=20e3, friction=0.7)
    contact = tl.solve_contact(tire, road, rolling, spacing=spacing)
    known = tl.solve_contact(tl.Tire.from_profile(NOW, inflation_pressure=820e3), road, rolling, spacing=spacing)
    save(contact.plot.pressure(), folder / "contact.png")
    peaks = [float(np.nanmax(one.dataset.pressure)) for one in (contact, known)]
    numbers = {"worn": gone.mean, "radius": tire.outer_radius, "peak": peaks[0], "known": peaks[1]}
    print(tire.quality)
    print(gone)
    print(f"peak pressure {peaks[0] / 1e3:.0f} kPa of the scan, {peaks[1] / 1e3:.0f} kPa of the tread behind it")
    return numbers


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", "-o", type=Path, default=Path("scan_to_contact"))
    main(parser.parse_args().output)
