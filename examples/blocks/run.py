"""A tread of blocks over one pitch: what changes from position to position, and what it does to a road.

`blocks.toml` describes the tread: two circumferential grooves, and lateral grooves every 70 mm, those of the
shoulders half a pitch from those of the middle. Steady rolling does not exist on it: the wheel rolls until a pitch
repeats the one before. Beside it the same tread without lateral grooves, as three ribs in steady rolling.

The mesh `feda_tire_fine.obj` of Project Chrono is not a source of blocks, although a pitch of 70 mm was expected of
it: on each of its 25 circles of vertices, 64 to 77 round the tire, the radius varies by 0.0012 mm at most, so that it
has four ribs and no lugs.

    python examples/blocks/run.py [folder] [--coarse]
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.contact import PitchPassage, solve_pitch
from treadload.damage.pitch import respond_to_pitch
from treadload.plots import pitch_history, pitch_maps, pitch_strains, save
from treadload.tire.tread import ProfileSurface

CASE = Path(__file__).parent / "blocks.toml"
DEPTHS = (0.0, 0.02)


def ribs_of(tire: tl.Tire) -> tl.Tire:
    """The same tread without lateral grooves."""
    assert isinstance(tire.surface, ProfileSurface)
    return tl.Tire.from_profile(
        replace(tire.surface.profile, lateral=()),
        inflation_pressure=tire.inflation_pressure,
        belt=tire.belt,
        tread="ribs",
    )


def asymmetry(passage: PitchPassage) -> float:
    """Largest difference from the mirror image, over the largest pressure: the tread is its own image."""
    data = passage.dataset
    largest = 0.0
    for name, sign in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        field = data[name].transpose("position", "y", "x").to_numpy()
        largest = max(largest, float(np.abs(field - sign * field[:, ::-1]).max()))
    return largest / float(data["largest_pressure"].max())


def main(folder: Path, spacing: float | None = None, positions: int = 12) -> dict[str, float]:
    """Roll, print, draw; returns the numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    case = tl.Case.from_toml(CASE)
    tire, road, wheel = case.build_tire(), case.build_road(), case.build_rolling()
    spacing = case.spacing if spacing is None else spacing
    passage = solve_pitch(tire, road, wheel, spacing=spacing, positions=positions)
    response = respond_to_pitch(passage, road, depths=DEPTHS)
    print(passage.summary(), response.summary(), sep="\n\n")
    save(pitch_history(passage), folder / "history.png")
    save(pitch_maps(passage), folder / "maps.png")
    save(pitch_strains(response), folder / "strains.png")
    ribs = tl.solve_contact(ribs_of(tire), road, wheel, spacing=spacing).dataset
    data = passage.dataset
    numbers = {
        "change": float(data.attrs["change"]),
        "load": float(np.abs(data.normal_load / wheel.normal_load - 1).max()),
        "net_force": float(np.hypot(data.tractive_force, data.lateral_force).max()) / float(wheel.normal_load),
        "asymmetry": asymmetry(passage),
        "area": float(data.contact_area.mean() / (float((ribs.pressure > 0).sum()) * ribs.dx * ribs.dy)),
        "area_range": float((data.contact_area.max() - data.contact_area.min()) / data.contact_area.mean()),
        "strain_worst": float(response.worst("largest_in_plane_extension")[0]),
        "strain_mean": float(response.mean("largest_in_plane_extension")[0]),
        "approach": float(data.approach.mean() / ribs.approach),
    }
    print(
        f"\nfrom a pitch to the next shear changes by {numbers['change']:.2%} at most; load within "
        f"{numbers['load']:.0e}, net horizontal force {numbers['net_force']:.0e} of the load, mirror image within "
        f"{numbers['asymmetry']:.1e} of the largest pressure\n"
        f"contact area {numbers['area']:.0%} and deflection {numbers['approach']:.1%} of those of ribs; the area "
        f"varies by {numbers['area_range']:.1%} over a pitch\n"
        f"strain in the plane of the surface: worst {numbers['strain_worst'] * 1e6:.0f}, mean over the pitch "
        f"{numbers['strain_mean'] * 1e6:.0f} microstrain"
    )
    return numbers


if __name__ == "__main__":
    where = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    coarse = {"spacing": 10e-3, "positions": 4} if "--coarse" in sys.argv else {}
    main(Path(where[0]) if where else Path("blocks"), **coarse)
