"""The fatigue line of old cores, fitted and cross-validated: prints what `AgedLine` and `AgedSurface` state.

    python benchmarks/aged_cores.py cores.csv

cores.csv has the columns age, voids (%), sig_b (strength, MPa), sig_cyc (stress, MPa), E_ini (MPa) and N; the table
of dikes (github amavrits/asphalt-db, the first 37 rows) has no licence and is not part of this repository.
"""

import sys
from pathlib import Path

import numpy as np

from treadload.damage import fit_fatigue_line

RUN_OUT = 50_000


def read(path):
    """Columns of numbers; lines that start with # are left out."""
    text = Path(path).read_text("utf-8")
    lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    rows = [[float(cell) if cell else np.nan for cell in row] for row in lines[1:]]
    return dict(zip(lines[0], np.array(rows).T, strict=True))


def main(path):
    """The table."""
    every = read(path)
    broken = every["N"] < RUN_OUT
    cores = {name: values[broken] for name, values in every.items()}
    stress, strain, voids = cores["sig_cyc"], cores["sig_cyc"] / cores["E_ini"], cores["voids"]
    print(f"{len(every['N'])} cores, {broken.sum()} without run-outs, ages {np.unique(cores['age'])}")
    by_strain, by_stress = fit_fatigue_line(strain, cores["N"]), fit_fatigue_line(stress, cores["N"])
    by_voids = fit_fatigue_line(stress, cores["N"], covariates=voids)
    strong = fit_fatigue_line(stress, cores["N"], covariates=np.log10(cores["sig_b"]))
    print(f"strain:          e6 = {by_strain.at_a_million * 1e6:.1f} microstrain, {by_strain}")
    print(f"stress:          N = 10^{by_stress.intercept:.2f} (s/MPa)^{by_stress.exponent:.2f}, {by_stress}")
    print(f"stress, voids:   {by_voids.covariates[0]:.3f} of log10 N per % of voids, {by_voids}")
    print(f"stress, strength: {strong}")
    fresh = fit_fatigue_line(strain, cores["N"], slope=-0.2)
    fresh_stress = fit_fatigue_line(stress, cores["N"], slope=-0.2)
    fresh_voids = fit_fatigue_line(stress, cores["N"], slope=-0.2, covariates=voids)
    print(
        f"fresh line, level fitted, strain: {fresh.unseen_scatter:.3f} unseen; "
        f"stress {fresh_stress.unseen_scatter:.3f}"
    )
    print(f"gain of the strain line over it: {by_strain.gain(fresh):.2f} standard errors")
    print(
        f"gain of the line with voids: {by_voids.gain(fresh):.2f}, "
        f"over b = -0.2 with voids {by_voids.gain(fresh_voids):.2f}"
    )
    for epsilon_6 in (80, 100, 130):
        residual = np.log10(cores["N"]) - 6 + 5 * np.log10(strain / (epsilon_6 * 1e-6))
        apart = residual**2 - by_strain.unseen**2
        gain = apart.mean() / apart.std(ddof=1) * np.sqrt(len(apart))
        print(
            f"fresh line as it stands, e6 = {epsilon_6}: {np.sqrt(np.mean(residual**2)):.2f} unseen, gain {gain:.1f}"
        )
    design = np.stack([np.ones(len(every["voids"])), every["voids"]], axis=1)
    for name in ("sig_b", "E_ini"):
        found, rest, *_ = np.linalg.lstsq(design, np.log(every[name]), rcond=None)
        scatter = np.sqrt(rest[0] / (len(design) - 2))
        print(f"{name} = {np.exp(found[0]):.4g} MPa exp({found[1]:.3f} per % of voids), ln scatter {scatter:.2f}")


if __name__ == "__main__":
    main(sys.argv[1])
