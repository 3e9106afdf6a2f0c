"""A tread under fringes: how well must one see, and in how many pictures, for heights to a tenth of a millimetre?

Nobody's pictures are at hand, so the camera is computed: two ribs' edges of a truck tread, 12 and 8 mm deep grooves,
a camera half a metre above, a projector 20 cm beside it, pixels of 0.5 mm that gather their light from nine rays, a
projector of gamma 1.4, noise of 2 grey levels of 255, and an exposure that saturates the brightest fringes. The
pictures are written as PNG with the file that names them; `treadload scan fringes.toml -o tread.nc` does what this
script does with them. Put your own pictures in their place.

    python examples/fringes/run.py [folder]
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

import treadload as tl
from treadload.plots import fringe_scan, new_figure, save
from treadload.plots.kit.style import headline, open_axes, styled
from treadload.tire import Groove, TreadProfile
from treadload.tire.fringes import Rig, look, pictures_of, planned_deviation, read_fringes

PIXEL, DISTANCE, BASELINE = 0.5e-3, 0.5, 0.2
TOP = 0.020  # of the crown above the reference plane, m
FRINGES, STEPS = (1, 6, 30), 8
TREAD = TreadProfile(
    rolling_radius=0.52,
    crown_radius=1.2,
    width=0.3,
    grooves=(Groove(centre=-0.018, width=0.012, depth=0.012), Groove(centre=0.024, width=0.010, depth=0.008)),
)

CASE = """title = "A tread under fringes"
spacing = "1 mm"
travel = "right"
gamma = "auto"

# Pictures, one a step, of the tread and of the empty reference plane.
[[patterns]]
fringes = 1
tread = "tread_1_step*.png"
reference = "plane_1_step*.png"
steps = 8

[[patterns]]
fringes = 6
tread = "tread_6_step*.png"
reference = "plane_6_step*.png"
steps = 8

[[patterns]]
fringes = 30
tread = "tread_30_step*.png"
reference = "plane_30_step*.png"
steps = 8

# Both lenses half a metre above the plane, 20 cm apart; the finest fringe is 3 mm wide there.
[reference_plane]
pixel = "0.5 mm"
distance = "0.5 m"
baseline = "0.2 m"
period = "{period} mm"
"""


def surface(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height of the tread above the reference plane, m."""
    at = np.arange(-0.08, 0.0801, 1e-4)
    map_of = surface.__dict__.setdefault("map", TOP - TREAD.gap(at, at))
    return ndimage.map_coordinates(map_of, [(y - at[0]) / 1e-4, (x - at[0]) / 1e-4], order=1, mode="nearest")


def take(folder: Path, rows: int, columns: int) -> tuple[Rig, np.ndarray]:
    """Write the pictures and the file that names them; returns the camera and the heights that its pixels see."""
    rng = np.random.default_rng(7)
    rig = Rig.above(PIXEL, rows, columns, distance=DISTANCE, baseline=BASELINE)
    rig = rig.with_(samples=3, gain=350.0, gamma=1.4, noise=2.0)
    tread = look(rig, surface, TOP - 0.025, TOP)
    plane = look(rig, lambda x, y: np.zeros_like(x), -1e-3, 1e-3)
    for name, seen in (("tread", tread), ("plane", plane)):
        for fringes in FRINGES:
            for step, grey in enumerate(pictures_of(rig, seen, fringes, STEPS, rng), 1):
                Image.fromarray(grey).save(folder / f"{name}_{fringes}_step{step}.png")
    period = 1.2 * columns * PIXEL / FRINGES[-1]
    (folder / "fringes.toml").write_text(CASE.format(period=f"{period * 1e3:.9g}"), encoding="utf-8")
    # The ray in the middle of each pixel.
    return rig, tread.height[1::3, 1::3]


@styled
def beside_truth(scan: object, truth: np.ndarray) -> object:
    """Measured and true height across the tread through the middle of the picture, and their difference."""
    found = scan.pixels.fringe_height.to_numpy()
    column = found.shape[1] // 2
    figure = new_figure(7.2, 4.6)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    across = np.arange(found.shape[0])
    upper.plot(across, truth[:, column] * 1e3, color="0.6", lw=3, label="the tread")
    upper.plot(across, found[:, column] * 1e3, label="measured")
    upper.set_ylabel("height (mm)")
    upper.legend()
    lower.plot(across, (found - truth)[:, column] * 1e3, ".", ms=3)
    lower.set_ylim(-0.2, 0.2)
    lower.set_ylabel("difference (mm)")
    lower.set_xlabel("row of the picture")
    open_axes(upper, lower)
    headline(upper, "Across the tread", "pixels in shadow and at walls are given up, not guessed")
    return figure


def main(folder: Path, rows: int = 120, columns: int = 150) -> dict[str, float]:
    """Take, evaluate, compare, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    rig, truth = take(folder, rows, columns)
    modulation = 0.5 * rig.gain * 0.8
    print(f"planned: {planned_deviation(modulation, rig.noise, STEPS):.3g} rad of noise in the phase", end="\n\n")
    scan = read_fringes(folder / "fringes.toml")
    print(scan.summary(), end="\n\n")
    save(fringe_scan(scan.pixels), folder / "fringes.png")
    save(beside_truth(scan, truth), folder / "beside_truth.png")
    scan.dataset.to_netcdf(folder / "tread.nc", engine="h5netcdf")
    tire = tl.Tire.from_height_map(folder / "tread.nc", inflation_pressure=820e3)
    print(tire)
    error = scan.pixels.fringe_height.to_numpy() - truth
    known = np.isfinite(error)
    rms = float(np.sqrt(np.mean(error[known] ** 2)))
    print(f"{rms * 1e3:.3f} mm rms from the tread over {known.mean():.1%} of the pixels")
    return {
        "rms": rms,
        "kept": float(known.mean()),
        "typical": float(np.median(np.abs(error[known]))),
        "deviation": scan.quality.deviation,
        "gamma": scan.quality.gamma,
        "spared": scan.quality.spared,
    }


if __name__ == "__main__":
    found = main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("fringes"))
    # A tenth of a millimetre, pixels that see both sides of a wall included; two thirds of the others lie within one
    # standard deviation, so that the median lies near 0.67 of it.
    assert found["rms"] < 0.1e-3, found
    assert found["kept"] > 0.9, found
    assert found["typical"] < found["deviation"], found
    # A pixel is a sixth of a fringe: gathering its light takes the second harmonic from 0.118 of the first to 0.102,
    # which is that of a gamma of 1.34.
    assert abs(found["gamma"] - 1.34) < 0.03, found
    assert found["spared"] > 0.1, found
