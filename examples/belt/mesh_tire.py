"""Tread and belt of one tire, a 335/65R22.5: its drawn mesh gives the tread, its load-deflection curve the sidewalls.

The corners of the mesh's meridian are measured: crown arc, widths, depths and walls of the grooves, shoulders. With
the free radius of the measured tire they are the catalogue's tread "335/65R22.5 tread". The hold of the sidewalls, κ,
of its belt is then fitted to Calspan's points at 40, 70 and 95 psi, with ribs and with a layer, and compared with the
vertical stiffnesses that the tire's files state.

    python examples/belt/mesh_tire.py [folder]
"""

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import least_squares

import treadload as tl
from treadload.calibration import Calibration
from treadload.calibration.fit import STEEL
from treadload.catalogue import tires
from treadload.footprint import Measured
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, INK, MUTED, headline, open_axes, styled
from treadload.tire.scan.mesh_file import read_mesh

HERE = Path(__file__).parent
DEFLECTIONS = HERE / "load_deflection_335_65R22_5_G275MSA.csv"
STIFFNESSES = HERE / "vertical_stiffness_335_65R22_5_G275MSA.csv"
PSI = 6894.757
# Below this radius lies no tread, m; corners nearer than this to each other are one, m.
TREAD, SAME = 0.483, 0.1e-3
LARGEST = 0.08  # m; the point beyond, at 40 psi and 40 kN, is predicted, not fitted
# A layer's ν stands for the grooves as well; see docs/explanation/belt.md.
LAYER = tl.Elastic(5.5e6, 0.47)


@dataclass(frozen=True)
class Meridian:
    """The tread of the mesh, right half. Lengths in m.

    corners: (n, 2) distance from the middle and radius, from the middle out. widest: radius where the tire is widest.
    """

    corners: np.ndarray
    widest: float

    @property
    def ribs(self) -> np.ndarray:
        """(ribs, 2, 2) ends of the faces of ribs: those corners that no floor of a groove lies above."""
        radius = self.corners[:, 1]
        high = radius > radius.max() - 0.009
        return self.corners[high].reshape(-1, 2, 2)

    def arc(self) -> tuple[float, float]:
        """Radius of the arc across through the ends of the ribs, and the largest distance of one from it."""
        out, radius = self.ribs.reshape(-1, 2).T

        def off(numbers: np.ndarray) -> np.ndarray:
            crown, across = numbers
            return crown - (across - np.sqrt(across**2 - out**2)) - radius

        fitted = least_squares(off, [radius.max(), 1.0], x_scale=[1e-3, 0.1])
        return float(fitted.x[1]), float(np.abs(fitted.fun).max())

    def grooves(self) -> dict[str, tuple[float, float, float, float]]:
        """Centre, width at the face, depth below the ribs beside it, and mean tangent of the walls, by name."""
        out, radius = self.corners.T
        inner, outer = self.ribs[0, 0], self.ribs[0, 1]
        following = self.ribs[1, 0]
        floor = (radius < radius.max() - 0.009) & (out < inner[0])
        middle = float(inner[1] - radius[floor].mean())
        wall = (inner[0] - out[floor].max()) / (inner[1] - radius[floor].min())
        beside = (radius < radius.max() - 0.009) & (out > outer[0]) & (out < following[0])
        low = self.corners[beside]
        side = float(0.5 * (outer[1] + following[1]) - low[:, 1].mean())
        walls = [
            (low[0, 0] - outer[0]) / (outer[1] - low[0, 1]),
            (following[0] - low[-1, 0]) / (following[1] - low[-1, 1]),
        ]
        return {
            "middle": (0.0, 2 * float(inner[0]), middle, float(wall)),
            "side": (
                0.5 * float(outer[0] + following[0]), float(following[0] - outer[0]), side, float(np.mean(walls)),
            ),
        }  # fmt: skip


def meridian_of(path: Path) -> Meridian:
    """Corners of the meridian of the example mesh, whose axle lies along y."""
    vertices = read_mesh(path).vertices
    out, radius = vertices[:, 1], np.hypot(vertices[:, 0], vertices[:, 2])
    widest = float(radius[np.abs(out) > np.abs(out).max() - 2e-3].mean())
    tread = (radius > TREAD) & (out > -SAME)
    places = np.unique(np.round(np.stack([out[tread], radius[tread]], axis=1) / SAME) * SAME, axis=0)
    return Meridian(places[places[:, 1] > TREAD], widest)


def measured() -> np.ndarray:
    """Rows of inflation pressure, Pa, deflection, m, and load, N; 60 psi is derived from the others and left out."""
    rows = np.loadtxt(DEFLECTIONS, delimiter=",", skiprows=2)
    rows = rows[(rows[:, 0] != 60) & (rows[:, 1] > 0)]
    rows[:, 0] *= PSI
    return rows


def tire(tread: str = "ribs") -> tl.Tire:
    """The catalogue's tire with ribs, or with a layer of the rubber that stands for one."""
    belt = tl.tire.Belt.from_library("335/65R22.5")
    if tread == "layer":
        belt = replace(belt, tread=LAYER)
    return tl.Tire.from_profile("335/65R22.5 tread", inflation_pressure=95 * PSI, belt=belt, tread=tread)


def fit(rows: np.ndarray, tread: str, spacing: float) -> Calibration:
    """κ of the sidewalls from measured deflections, with its standard deviation."""
    data = [Measured(load=force, deflection=w, inflation_pressure=p) for p, w, force in rows.tolist()]
    return tl.calibrate(tire(tread), ["foundation"], data, spacing=spacing, tolerance=1e-6)


def load(fitted: tl.Tire, pressure: float, deflection: float, spacing: float) -> float:
    """Load, N, of the standing tire at an inflation pressure, Pa, and a deflection, m."""
    road, state = tl.Pavement.half_space(STEEL), tl.Rolling(approach=deflection, friction=0.0)
    stood = replace(fitted, inflation_pressure=pressure)
    return float(tl.solve_contact(stood, road, state, spacing=spacing, tolerance=1e-4).dataset.normal_load)


@styled
def draw(shape: Meridian, fitted: tl.Tire, rows: np.ndarray, spacing: float) -> Figure:
    """The meridian of the mesh and the tread measured from it; measured points and the fitted tire."""
    figure = new_figure(10.2, 4.2)
    left, right = figure.subplots(1, 2, width_ratios=[1.35, 1])
    profile = fitted.surface.profile
    y = np.linspace(0, 0.5 * profile.width, 2000)
    out, radius = shape.corners.T
    left.plot(1e3 * out, 1e3 * (radius.max() - radius), "o-", ms=4, color=MUTED, lw=1.0, label="corners of the mesh")
    left.plot(1e3 * y, 1e3 * profile.drop(y), color=CASES[0], lw=1.5, label="tread of the catalogue")
    left.invert_yaxis()
    left.set_xlabel("from the middle of the tread (mm)")
    left.set_ylabel("below the crown (mm)")
    left.legend(loc="lower left")
    headline(left, "Meridian", "right half")
    for colour, p in zip(CASES, np.unique(rows[:, 0]), strict=False):
        own = rows[rows[:, 0] == p]
        deflections = np.linspace(0, own[:, 1].max(), 6)
        loads = [0.0, *(load(fitted, p, w, spacing) for w in deflections[1:])]
        right.plot(1e3 * deflections, np.array(loads) / 1e3, color=colour, label=f"{p / PSI:.0f} psi")
        for part, face in ((own[:, 1] < LARGEST, colour), (own[:, 1] >= LARGEST, "none")):
            right.plot(1e3 * own[part, 1], own[part, 2] / 1e3, "o", color=colour, mfc=face)
    right.plot([], [], "o", color=INK, label="measured; open: not fitted")
    right.set_xlabel("deflection (mm)")
    right.set_ylabel("load (kN)")
    right.legend(loc="upper left")
    headline(right, "Load and deflection", "lines: the catalogue's tire with ribs")
    open_axes(left, right)
    return figure


def main(folder: Path, spacing: float = 6e-3, treads: tuple[str, ...] = ("ribs", "layer")) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    shape = meridian_of(tl.example_mesh())
    across, off = shape.arc()
    found: dict[str, Any] = {"arc": across, "off_arc": off, "width": 2 * float(shape.ribs[-1, 1, 0])}
    found |= {"grooves": shape.grooves(), "widest": shape.widest, "crown": float(shape.corners[:, 1].max())}
    print(f"mesh: crown {1e3 * found['crown']:.1f} mm, arc across {1e3 * across:.0f} mm (ribs within "
          f"{1e3 * off:.2f} mm), tread {1e3 * found['width']:.1f} mm, widest at "
          f"{1e3 * shape.widest:.0f} mm")  # fmt: skip
    for name, (centre, width, depth, wall) in found["grooves"].items():
        print(f"  {name} groove: at {1e3 * centre:.2f} mm, {1e3 * width:.2f} mm wide, {1e3 * depth:.2f} mm deep, "
              f"walls {math.degrees(math.atan(wall)):.1f}° from the vertical")  # fmt: skip
    catalogued = tires["335/65R22.5 tread"]
    print(f"catalogue: {catalogued}")
    rows = measured()
    fitted = rows[:, 1] < LARGEST
    found |= {"foundation": {}, "deviation": {}, "alone": {}, "rms": {}, "beyond": {}}
    for tread in treads:
        calibration = fit(rows[fitted], tread, spacing)
        tire_of = calibration.tire
        loads = np.array([load(tire_of, p, w, spacing) for p, w, _ in rows])
        found["foundation"][tread] = calibration.value("foundation")
        found["deviation"][tread] = calibration.standard_deviation("foundation")
        found["rms"][tread] = float(np.sqrt(np.mean((loads / rows[:, 2] - 1)[fitted] ** 2)))
        found["beyond"][tread] = float((loads / rows[:, 2])[~fitted][0] - 1)
        found["alone"][tread] = {
            round(p / PSI): fit(rows[fitted & (rows[:, 0] == p)], tread, spacing).value("foundation")
            for p in np.unique(rows[:, 0])
        }
        alone = ", ".join(f"{value:.2f} at {p} psi" for p, value in found["alone"][tread].items())
        print(
            f"{tread}: κ = {found['foundation'][tread]:.2f} ± {found['deviation'][tread]:.2f} /m, load within "
            f"{100 * found['rms'][tread]:.1f} % (rms); each pressure alone: {alone}; the point that is not fitted "
            f"{100 * found['beyond'][tread]:+.0f} %"
        )
    found["stiffness"] = stiffnesses(tire(), spacing)
    print(CAVEAT)
    save(draw(shape, tire(), rows, spacing), folder / "mesh_tire.png")
    return found


def stiffnesses(fitted: tl.Tire, spacing: float) -> dict[int, tuple[float, float]]:
    """Load over deflection and its slope near the nominal load, over the stiffness that the tire's files state.

    The files do not say which of both it is.
    """
    found = {}
    print("vertical stiffness near the nominal load (kN/mm): stated; computed as load over deflection, and as slope")
    for psi, _, _, stated, nominal, *_ in np.loadtxt(STIFFNESSES, delimiter=",", skiprows=2):
        low, high = 0.8 * nominal / stated, 1.2 * nominal / stated
        loads = np.array([load(fitted, psi * PSI, w, spacing) for w in (low, high)])
        computed = float(loads.sum() / (low + high)), float(np.diff(loads)[0] / (high - low))
        found[round(psi)] = computed[0] / stated, computed[1] / stated
        print(f"  {psi:.0f} psi: {stated / 1e6:.3f}; {computed[0] / 1e6:.3f}, {computed[1] / 1e6:.3f}")
    return found


CAVEAT = """
What this is and is not. The mesh is drawn, not scanned, and its maker is not named; edges and shoulders are sharp as
drawn. Radius and deflections are of the tire that Calspan pressed (free radius 498.7 mm; the mesh has 504.6 mm), 5.5
MPa of its rubber is assumed, 5 mm of undertread below the deepest groove too, and bending is estimated. The points
contradict
themselves by pressure, as load_deflection.py shows: κ is known to about a tenth."""


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("mesh_tire"))
