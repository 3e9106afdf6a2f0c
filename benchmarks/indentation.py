"""A rigid sphere pressed into a half-space that yields, beside tamaas: 1.5, 3 and 5 times the load of first yield.

tamaas solves contact and plasticity in turn (EPIC, accelerated, to 1e-4, DF-SANE inside from 1e-2 to 1e-5) on even
cells of a periodic volume; ours solves one fixed point, to 1e-3, on a half-space, with graded rows, five for eight of
theirs. Both take each load in one jump from nothing; one thread, process time, operators included. Peak pressures
over the yield stress stand beside; then ours in parts, halved until the peak pressure holds, as users get it. tamaas
runs in the environment that `peers.py` makes; where that fails, a sentence says why.

    python benchmarks/indentation.py            python benchmarks/indentation.py 64 32
"""

import json
import math
import os
import subprocess
import sys

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import time  # noqa: E402

import numpy as np  # noqa: E402
from peers import environment  # noqa: E402

import treadload as tl  # noqa: E402
from treadload.contact import load_steps  # noqa: E402
from treadload.materials import VonMises  # noqa: E402

MODULUS, YIELD, POISSON, RADIUS, HARDENING = 1000.0, 2.0, 0.3, 100.0, 1.0
PEAK = (0.454 + 0.41 * POISSON) * 2.8 * YIELD
DEPTH = (math.pi * PEAK / (2 * MODULUS / (1 - POISSON**2))) ** 2 * RADIUS
LOAD = 2 / 3 * PEAK * math.pi * DEPTH * RADIUS
# Halves of the window over the radius of the elastic contact: tamaas is periodic and needs a wider one.
OURS, THEIRS, DEEP = 1.35, 1.8, 2.0


# Parts of a load at first, and times that they are halved.
PARTS = load_steps._PARTS, load_steps._MOST_HALVINGS


def ours(multiple: float, n: int, layers: int, *, jump: bool) -> tuple[float, float]:
    """Seconds, the shortest of three after one that loads what is loaded when first used; peak over yield stress."""
    load_steps._PARTS, load_steps._MOST_HALVINGS = (1, 0) if jump else PARTS
    radius = math.sqrt(DEPTH * RADIUS) * multiple ** (1 / 3)
    n = max(16, round(n * OURS / THEIRS))
    dx = 2 * OURS * radius / n
    across = (np.arange(n) - (n - 1) / 2) * dx
    gap = (across[None] ** 2 + across[:, None] ** 2) / (2 * RADIUS)
    ball = tl.Tire.from_height_map(gap, dx, material=tl.Elastic(MODULUS * 1e6, 0.3))
    law = VonMises(YIELD, hardening=HARDENING)
    road = tl.Pavement.half_space(tl.materials.ElastoPlastic(tl.Elastic(MODULUS, POISSON), law))

    taken = []
    for _ in range(4):
        began = time.process_time()
        done = tl.contact.solve_indentation(ball, road, [multiple * LOAD], depth=DEEP * radius, layers=layers)
        taken.append(time.process_time() - began)
    return min(taken[1:]), float(done.dataset.peak_pressure[0]) / YIELD


# Run by the environment of tamaas: the argument is JSON; prints seconds and the largest pressure.
TAMAAS = """
import json, sys, time
import numpy as np
import tamaas as tm
from tamaas.nonlinear_solvers import DFSANESolver, ToleranceManager
asked = json.loads(sys.argv[1])
n, side, layers = asked["n"], asked["side"], asked["layers"]
tm.set_log_level(tm.LogLevel.error)
across = (np.arange(n) - (n - 1) / 2) * side / n
surface = -(across[None] ** 2 + across[:, None] ** 2) / (2 * asked["radius"])
began = time.process_time()
model = tm.ModelFactory.createModel(tm.model_type.volume_2d, [asked["deep"], side, side], [layers, n, n])
model.E, model.nu = asked["modulus"], asked["poisson"]
material = tm.materials.IsotropicHardening(model, sigma_y=asked["yields"], hardening=asked["hardening"])
residual = tm.Residual(model, material)
plastic = ToleranceManager(1e-2, 1e-5, 1 / 3)(DFSANESolver)(residual)
contact = tm.PolonskyKeerRey(model, surface, 1e-8)
tm.EPICSolver(contact, plastic, 1e-4, relaxation=0.3).acceleratedSolve(asked["load"] / side**2)
print(time.process_time() - began, float(np.array(model.traction)[..., 2].max()))
"""


def theirs(python: str, multiple: float, n: int, layers: int) -> tuple[float, float]:
    """The same of tamaas, in its environment's Python."""
    radius = math.sqrt(DEPTH * RADIUS) * multiple ** (1 / 3)
    asked = {
        "n": n, "layers": layers, "side": 2 * THEIRS * radius, "deep": DEEP * radius, "radius": RADIUS,
        "modulus": MODULUS, "poisson": POISSON, "yields": YIELD, "hardening": HARDENING, "load": multiple * LOAD,
    }  # fmt: skip
    told = subprocess.run([python, "-c", TAMAAS, json.dumps(asked)], capture_output=True, text=True, check=True)
    seconds, peak = map(float, told.stdout.split()[-2:])
    return seconds, peak / YIELD


def main(n: int = 32, layers: int = 16) -> None:
    print(f"tamaas on {n} x {n} x {layers} cells; ours on cells of that width, {round(5 * layers / 8)} graded rows")
    print(
        f"{'P/Pc':>5} {'ours s':>8} {'tamaas s':>9} {'ratio':>6} {'peak/Y ours':>12} {'tamaas':>8} {'apart %':>8} "
        f"{'in parts s':>11} {'peak/Y':>7}"
    )
    python, why = environment("tamaas")
    if python is None:
        print(why)
    for multiple in (1.5, 3.0, 5.0):
        own, peak = ours(multiple, n, round(5 * layers / 8), jump=True)
        halved, settled = ours(multiple, n, round(5 * layers / 8), jump=False)
        if python is None:
            print(f"{multiple:5.1f} {own:8.2f}   peak/Y {peak:.4f}   in parts {halved:.2f} s, {settled:.4f}")
            continue
        other, value = theirs(python, multiple, n, layers)
        print(
            f"{multiple:5.1f} {own:8.2f} {other:9.2f} {other / own:6.1f} "
            f"{peak:12.4f} {value:8.4f} {100 * (peak / value - 1):8.2f} "
            f"{halved:11.2f} {settled:7.4f}",
            flush=True,
        )


if __name__ == "__main__":
    main(*(int(one) for one in sys.argv[1:3]))
