"""How much of a truck tire really touches a rough road, under what pressure, and what do the layers feel of it?

A laser profile of chip seal (profile.dat, CAPTIF, MIT licence beside) is cleaned and measured as ISO 13473-1 asks. A
patch of asphalt is made from a spectrum. The wheel is solved on a plane; rubber is pressed on the patch under
the wheel's own pressures. A small wheel is solved on resolved bumps, and its peaks are enveloped for the layers
below.

    python examples/rough_road/run.py [folder]
"""

import sys
import time
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.contact import envelop, solve_texture
from treadload.pavement import texture as tx
from treadload.plots import save

HERE = Path(__file__).parent
RUBBER = tl.Elastic(6e6, 0.5)  # of a truck tread at rolling frequencies, assumed
ASPHALT = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
TREAD = 0.015  # m of rubber on the belt


def chip_seal() -> tx.Texture:
    """The measured profile: outliers out, drop-outs filled, levelled, waves below 2.4 mm filtered."""
    raw = tx.read_texture(HERE / "profile.dat")
    whole = tx.level(tx.fill_dropouts(tx.remove_outliers(raw, slope=6)))
    depth = tx.mean_profile_depth(raw, spike_slope=6)
    print(f"chip seal: {raw}\n           {depth}, texture depth {tx.mean_texture_depth(whole) * 1e3:.2f} mm")
    return tx.band_pass(whole, shortest=2.4e-3)


def asphalt(points: int) -> tx.Texture:
    """100 mm of an asphalt concrete: waves of 3 mm and more, flat beyond 12 mm, as fine stones make it."""
    made = tx.self_affine(0.1, 0.1 / points, hurst=0.8, shortest=3.2e-3, roll_off=12e-3, rms_height=0.3e-3, seed=1)
    lines, squares = tx.mean_profile_depth(made).mean, tx.map_profile_depth(made)
    print(f"asphalt:   MPD of lines {lines * 1e3:.2f} mm, of squares {squares * 1e3:.2f} mm, texture depth "
          f"{tx.mean_texture_depth(made) * 1e3:.2f} mm")  # fmt: skip
    return made


def main(folder: Path, points: int = 256, spacing: float = 6e-3) -> dict[str, float]:
    folder.mkdir(parents=True, exist_ok=True)
    stones, patch = chip_seal(), asphalt(points)
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    wheel = tl.solve_contact(tire, ASPHALT, tl.Rolling(normal_load=32.5e3, friction=0.7), spacing=spacing)
    began = time.process_time()
    rough = solve_texture(patch, RUBBER, wheel, thickness=TREAD)
    print(f"\n{rough.summary()}\nin {time.process_time() - began:.1f} s\n")
    law = rough.friction_law(shear_strength=2e6)
    print(f"friction of 2 MPa on the real area: {law}")
    save(rough.plot.patch(), folder / "rough_road.png")
    ridges = solve_texture(stones, RUBBER, [2e5, 7e5], thickness=TREAD)
    save(ridges.plot.patch(), folder / "chip_seal.png")

    # Bumps that the cells of a contact resolve: a small wheel on the patch's longer waves.
    coarse = tx.band_pass(patch, shortest=12e-3)
    at = 2e-3 * (np.arange(61) - 30)
    ball = tl.Tire.from_height_map((at[None] ** 2 + at[:, None] ** 2) / 0.5, 2e-3, material=tl.Elastic(3e6, 0.5))
    small = tl.solve_contact(ball, ASPHALT, tl.Rolling(normal_load=600, friction=0.7), relief=coarse)
    layers = envelop(small, 20e-3)
    print(layers.summary())
    save(layers.plot.pressure(small), folder / "enveloped.png")
    tl.save_results({"texture": rough, "chip_seal": ridges, "enveloped": layers}, folder / "rough_road.nc")
    deep = [
        tl.solve_response(load, ASPHALT, depths=[0.04], x=[0.0], y=[0.0]).dataset.stress_zz.item()
        for load in (small, layers)
    ]
    print(
        f"40 mm deep: {deep[0] / 1e3:.1f} kPa below the peaks, {deep[1] / 1e3:.1f} kPa below the enveloped pressure"
    )
    opened = tl.open_results(folder / "rough_road.nc")
    data = opened["texture"].dataset
    part = float(data.real_area / data.contact_area)
    # What this example is held to.
    assert 0.2 < part < 0.9
    assert abs(float(layers.dataset.normal_load) / 600 - 1) < 1e-9
    assert abs(deep[1] / deep[0] - 1) < 0.03
    return {"touches": part, "deep": deep[1] / deep[0], "reference": law.reference}


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("rough_road"))
