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
# Standard errors of a paired difference below which it is no gain.
ENOUGH = 2.0


def read(path):
    """Columns of numbers; lines that start with # are left out."""
    text = Path(path).read_text("utf-8")
    lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    rows = [[float(cell) if cell else np.nan for cell in row] for row in lines[1:]]
    return dict(zip(lines[0], np.array(rows).T, strict=True))


def gained(name, line, reference):
    """A line of the table: what a fitted line is worth over another on cores that neither has seen."""
    nats, error = line.score_gain(reference)
    enough = min(line.gain(reference), nats / error) >= ENOUGH
    print(
        f"  {name}: squares {line.gain(reference):.2f}; {nats:.1f} nats ± {error:.1f} ({nats / error:.2f}): "
        f"{'gain' if enough else 'no gain'}"
    )


def by_place(age, strain, passes):
    """The same with all cores of one age, which are those of one dike, left out at a time."""
    squares = {}
    for slope in (None, -0.2):
        unseen = np.empty(len(passes))
        for number in np.unique(age):
            rest = age != number
            line = fit_fatigue_line(strain[rest], passes[rest], slope=slope)
            predicted = line.intercept + line.exponent * np.log10(strain)
            unseen[~rest] = (np.log10(passes) - predicted)[~rest]
        squares[slope] = unseen**2
    apart = squares[-0.2] - squares[None]
    gain = apart.mean() / apart.std(ddof=1) * np.sqrt(len(apart))
    scatter = [np.sqrt(values.mean()) for values in squares.values()]
    print(f"  one age left out at a time: {scatter[0]:.2f} unseen, {scatter[1]:.2f} by -0.2, squares {gain:.2f}")


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
    fresh_strong = fit_fatigue_line(stress, cores["N"], slope=-0.2, covariates=np.log10(cores["sig_b"]))
    print(
        f"fresh line, level fitted, strain: {fresh.unseen_scatter:.3f} unseen; "
        f"stress {fresh_stress.unseen_scatter:.3f}"
    )
    print("gains unseen, of squares in standard errors, and of log scores; below 2 standard errors it is no gain")
    gained("slope, strain", by_strain, fresh)
    gained("slope, stress", by_stress, fresh_stress)
    gained("slope beside voids, stress", by_voids, fresh_voids)
    gained("slope beside strength, stress", strong, fresh_strong)
    gained("slope and voids by stress, over -0.2 by strain", by_voids, fresh)
    by_place(cores["age"], strain, cores["N"])
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
