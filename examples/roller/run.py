"""A roller on a fresh course: how hard and how long does its drum press, and when has the course come to rest?

A towed smooth drum of 1.5 m and 2 t on 15 cm of a soft cohesive fill (15 MPa, 50 kPa of undrained shear strength)
over a firm base. The drum's pressure feels the track that it makes: the first pass meets it ahead of the axle, on a
longer contact, and costs work; the passes after it find a track that carries them. Beside it stands the same drum on
a fill that does not yield. Strength, stiffness and hardening are assumed: replace them by tests of your fill. The law
keeps its volume, so the course sinks at the drum's edges, where it can give way; what compaction takes out of the
pores is not in it.

    python examples/roller/run.py [folder]
"""

import sys
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.materials import VonMises
from treadload.plots import drum_contact, new_figure, plastic_strain, rut_profile, save
from treadload.plots.kit.style import headline, styled
from treadload.response import roll_drum
from treadload.tire import TreadProfile

LOAD, WIDTH, RADIUS = 20e3, 1.5, 0.6
COHESION = 50e3


def drum() -> tl.Tire:
    """A smooth steel drum with edges rounded by 2 cm."""
    smooth = TreadProfile(rolling_radius=RADIUS, crown_radius=1e4, width=WIDTH, shoulder_radius=0.02)
    return tl.Tire.from_profile(smooth, material=tl.Elastic(210e9, 0.3), name="drum of 1.5 m")


def road(cohesion: float = COHESION) -> tl.Pavement:
    """The fill on its base; von Mises stress at yield is twice the undrained strength."""
    fill = tl.materials.ElastoPlastic(tl.Elastic(15e6, 0.45), VonMises(2 * cohesion, hardening=2e6))
    return tl.Pavement([tl.Layer(fill, 0.15, name="fill"), tl.Layer(tl.Elastic(100e6, 0.35), name="base")])


def main(folder: Path, passes: int = 6, layers: int = 7) -> dict[str, float]:
    """Solve, print, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    rolled = roll_drum(drum(), road(), LOAD, passes=passes, layers=layers)
    print(rolled.summary(), end="\n\n")
    data = rolled.dataset
    # The same drum on a fill that is too strong to yield, on the same cells.
    far = roll_drum(drum(), road(1e7), LOAD, passes=1, layers=3, spacing=(data.attrs["dx"], data.attrs["dy"]))
    print(far.summary(), end="\n\n")

    save(drum_contact(rolled), folder / "drum.png")
    save(rut_profile(rolled), folder / "rut.png")
    save(plastic_strain(rolled), folder / "strain.png")
    save(pressures(rolled, far), folder / "pressures.png")
    middle = data.residual_displacement_z.sel(across=0.0, method="nearest")
    return {
        "passes": float(data.sizes["pass"]),
        "first": float(data.plastic_increment[0]),
        "last": float(data.plastic_increment[-1]),
        "work_first": float(data.rolling_resistance[0]),
        "work_last": float(data.rolling_resistance[-1]),
        "long_first": float(data.contact_length[0]),
        "long_last": float(data.contact_length[-1]),
        "ahead_first": float(data.pressure_centre_x[0]),
        "peak": float(data.peak_pressure[0]),
        "elastic_peak": float(far.dataset.peak_pressure[0]),
        "rut": float(data.rut_depth[-1]),
        "middle": float(middle[-1]),
    }


@styled
def pressures(rolled: tl.response.Passes, elastic: tl.response.Passes) -> object:
    """Pressure across the drum, the mean over the length of its contact, beside that of the elastic contact."""
    figure = new_figure(7.4, 4.0)
    ax = figure.add_subplot()
    named = {"first pass": rolled.dataset.isel({"pass": 0}), "last pass": rolled.dataset.isel({"pass": -1})}
    for name, data in {**named, "elastic": elastic.dataset.isel({"pass": 0})}.items():
        line = data.pressure.sum("x") * rolled.dataset.attrs["dx"]
        ax.plot(data.y * 1e3, line / 1e3, marker="o", ms=3, label=name)
    ax.set_xlim(-0.55e3 * WIDTH, 0.55e3 * WIDTH)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("y, across travel (mm)")
    ax.set_ylabel("force a width (kN/m)")
    ax.grid(True)
    ax.legend()
    headline(ax, "Force of the drum across its width", "a yielding course takes the peaks off its edges")
    return figure


if __name__ == "__main__":
    found = main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("roller"))
    # Passes come to rest: the last adds a hundredth of the first, and costs next to nothing.
    assert found["last"] < 0.02 * found["first"], found
    assert found["work_last"] < 0.01 * found["work_first"], found
    # The first pass is met ahead of the axle, on a longer contact than the last, and presses less than without yield.
    assert found["ahead_first"] > 0, found
    assert found["long_first"] > found["long_last"], found
    assert found["peak"] < 0.9 * found["elastic_peak"], found
    # What keeps its volume can sink at the edges alone.
    assert found["rut"] > 3 * abs(found["middle"]), found
    assert np.isfinite(list(found.values())).all()
