"""A bus stop in July: how deep is the rut after buses that pass, and after buses that stand?

A wheel of 32.5 kN on 12 cm of asphalt at 50 °C (500 MPa) over a base bound by cement. Three laws on the same stress:
Mohr and Coulomb's, which knows no time and comes to rest after a few passes; Perzyna's, whose rut grows with the time
under the wheel, at 30 km/h and at 1 cm/s, which is half a minute on every point, as at a stop; and the power law of
passes of the American guide, which counts three thousand of them, a hot month. Cohesion, friction and fluidity are
assumed: replace them by tests of your mix.

    python examples/rutting/run.py [folder]
"""

import math
import sys
from pathlib import Path

import treadload as tl
from treadload.materials import MohrCoulomb, PassesPowerLaw, Perzyna
from treadload.plots import new_figure, plastic_strain, residual_stress, rut_profile, save, shakedown_map
from treadload.plots.kit.style import headline, styled

HOT = tl.Elastic(500e6, 0.35)
SOFTENED = MohrCoulomb(40e3, math.radians(30), math.radians(3), hardening=20e6)
VISCOUS = Perzyna(SOFTENED, fluidity=3e-3, exponent=2.0)
PASSING, STANDING = 30 / 3.6, 0.01


def road(law: object) -> tl.Pavement:
    """The stop's road, its asphalt yielding by a law."""
    return tl.Pavement(
        [
            tl.Layer(tl.materials.ElastoPlastic(HOT, law), 0.12, name="asphalt at 50 °C"),
            tl.Layer(tl.Elastic(10e9, 0.25), 0.25, name="base bound by cement"),
            tl.Layer(tl.Elastic(80e6, 0.35), name="soil"),
        ]
    )


def main(folder: Path, spacing: float = 9e-3, layers: int = 8) -> dict[str, float]:
    """Solve, print, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=850e3)
    wheel = tl.Rolling(normal_load=32.5e3, tractive_force=-4e3, friction=0.7)
    contact = tl.solve_contact(tire, road(SOFTENED), wheel, spacing=spacing)
    box = {"spacing": 0.012, "layers": layers}

    rest = tl.response.roll_passes(contact, road(SOFTENED), passes=6, **box)
    print(rest.summary(), end="\n\n")
    passing, standing = (
        tl.response.roll_passes(contact, road(VISCOUS), passes=5, speed=speed, **box) for speed in (PASSING, STANDING)
    )
    print(passing.summary(), standing.summary(), sep="\n\n", end="\n\n")
    counted = tl.response.roll_passes(contact, road(PassesPowerLaw.asphalt(50.0)), passes=3000, **box)
    print(counted.summary())

    save(rut_profile(standing), folder / "rut_standing.png")
    save(plastic_strain(standing), folder / "strain_standing.png")
    save(residual_stress(rest, "xx"), folder / "residual.png")
    save(rut_profile(counted), folder / "rut_counted.png")
    save(growth({"30 km/h": passing, "standing": standing, "no time": rest}), folder / "growth.png")

    patch = tl.UniformRectangle(0.2, 0.25, 0.65e6)
    limits = tl.life.shakedown_map(patch, road(SOFTENED), (0.0, 0.2, 0.4), spacing=0.03, layers=5)
    save(shakedown_map(limits), folder / "shakedown.png")
    return {
        "rest": float(rest.dataset.rut_depth[-1]),
        "added": float(rest.dataset.plastic_increment[-1] / rest.dataset.plastic_increment[0]),
        "passing": float(passing.dataset.rut_depth[-1]),
        "standing": float(standing.dataset.rut_depth[-1]),
        "counted": float(counted.dataset.rut_depth[-1]),
        "first": float(counted.dataset.rut_depth[0]),
        "limit": float(limits.dataset.shakedown_load[-1]),
    }


@styled
def growth(several: dict[str, tl.response.Passes]) -> object:
    """Depth of the rut over the passes."""
    figure = new_figure(6.4, 4.0)
    ax = figure.add_subplot()
    for name, passes in several.items():
        ax.plot(passes.dataset["pass"], passes.dataset["rut_depth"] * 1e3, marker="o", label=name)
    ax.set_yscale("log")
    ax.set_xlabel("passes")
    ax.set_ylabel("rut (mm)")
    ax.grid(True)
    ax.legend()
    headline(ax, "Rut over passes", "laws that follow the material step by step come to rest")
    return figure


if __name__ == "__main__":
    found = main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("rutting"))
    # A law without time comes to rest; a stop leaves several times what a passing bus does; passes by the power law
    # grow as N^0.4791.
    assert found["added"] < 1e-3, found
    assert found["standing"] > 3 * found["passing"], found
    assert math.isclose(found["counted"], found["first"] * 3000**0.4791, rel_tol=1e-9), found
    assert 0.5e-3 < found["counted"] < 3e-3, found
    # Shear of 0.4 p takes more than half of the load that comes to rest.
    assert found["limit"] < 0.8, found
