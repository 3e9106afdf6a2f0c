"""A data table of a field, and a surrogate of it: 2000 wheels, answered in ten milliseconds, honest about where not.

A driven truck wheel on a structure of the French catalogue: load, inflation pressure, friction, tractive force and
temperature vary together over a Latin hypercube of 2000 cases. They are solved into a store, `study.zarr`, which goes
on where it was interrupted. Of two results a Gaussian process is made: the largest tensile strain 20 mm below the
surface and the largest tensile strain in the plane at the base of the asphalt, 210 mm deep. The surrogate is saved
beside the study, with its error by cross-validation, the box that it was made in, and the versions that made it.

It refuses what it does not know: inputs outside the box, and wheels that would slide as a whole, Q > μP, for which no
case could be solved. Close to sliding it answers with a warning.

    python examples/study/run.py [folder] [--small] [--jobs 2]
"""

import json
import pickle
import platform
import sys
import warnings
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path

import numpy as np
from matplotlib.ticker import FixedLocator, NullLocator
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.model_selection import KFold

import treadload as tl
from treadload.plots import new_figure
from treadload.plots.kit.style import styled
from treadload.sweeps import sampled, table_of

CASE = Path(__file__).parent / "study.toml"
RANGES = {
    "rolling.normal_load": ("15 kN", "45 kN"),
    "tire.inflation_pressure": ("6 bar", "10 bar"),
    "rolling.friction": (0.3, 0.9),
    "rolling.tractive_force": ("0 kN", "12 kN"),
    "pavement.temperature": (0.0, 40.0),
}
LOAD, FRICTION, FORCE = 0, 2, 3
# Reading → depth, m, and what it is in a figure.
READINGS = {
    "largest_extension": (0.02, "largest tensile strain, 20 mm deep"),
    "largest_in_plane_extension": (0.21, "extension at the base, 210 mm deep"),
}
# A wheel that uses more of its friction than this slides nearly everywhere: few cases near it, and a kink.
NEARLY = 0.9
FOLDS = 5
# Scales of the kernel are found on so many cases; the process then has all of them.
SCALED_ON = 400


@dataclass
class Surrogate:
    """Gaussian processes of the logarithms of readings, and where they hold.

    names: of the inputs, in order. low, high: of the box, SI. models: reading → process of inputs scaled to the box.
    errors: reading → relative errors by cross-validation.
    """

    names: list[str]
    low: np.ndarray
    high: np.ndarray
    models: dict = field(default_factory=dict)
    errors: dict = field(default_factory=dict)

    def scaled(self, inputs: np.ndarray) -> np.ndarray:
        return 2 * (np.atleast_2d(inputs) - self.low) / (self.high - self.low) - 1

    def __call__(self, reading: str, **inputs: float) -> tuple[float, float, list[str]]:
        """A reading, its standard deviation and what to know. inputs: by the ends of their keys, SI.

        Raises ValueError outside the box and for a wheel that slides.
        """
        ends = [name.rpartition(".")[2] for name in self.names]
        if set(inputs) != set(ends):
            raise ValueError(f"give {', '.join(ends)}, got {', '.join(inputs)}")
        values = np.array([inputs[end] for end in ends])
        for name, value, low, high in zip(ends, values, self.low, self.high, strict=True):
            if not low <= value <= high:
                raise ValueError(f"{name} {value:g} is outside of {low:g} to {high:g}, where the surrogate was made")
        used = values[FORCE] / (values[FRICTION] * values[LOAD])
        if used >= 1:
            raise ValueError(f"a force of {used:.2f} μP: the whole wheel slides, and no such case was solved")
        near = f"{used:.2f} of the friction is used: close to sliding errors are larger"
        known = [near] if used > NEARLY else []
        mean, deviation = self.models[reading].predict(self.scaled(values), return_std=True)
        return float(np.exp(mean[0])), float(np.exp(mean[0]) * deviation[0]), known


def solve(folder: Path, count: int, spacing: str, jobs: int) -> tl.sweeps.Sweep:
    """The study in its store, solved where it is not."""
    case = tl.Case.from_toml(CASE, changes=[f'spacing="{spacing}"'])
    design = sampled(case, RANGES, count, method="latin", seed=1)
    return tl.sweep(case, design, store=folder / "study.zarr", jobs=jobs, progress=tell)


def tell(done: int, total: int, what: str) -> None:
    if done == total or done % 100 == 0:
        print(f"{done} of {total} {what}s", flush=True)


def data_of(study: tl.sweeps.Sweep) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Inputs (n, 5) and readings of the cases that were solved."""
    data = study.dataset
    good = data["status"].to_numpy() == 1
    inputs = np.stack([data[name].to_numpy()[good] for name in RANGES], axis=1)
    readings = {
        name: data[name].sel(depth=depth, method="nearest").to_numpy()[good] for name, (depth, _) in READINGS.items()
    }
    return inputs, readings


def process(scale: np.ndarray | None = None) -> GaussianProcessRegressor:
    """A Gaussian process with a length for each input. scale: a fitted kernel, which stays as it is."""
    if scale is not None:
        return GaussianProcessRegressor(scale, normalize_y=True, optimizer=None)
    kernel = ConstantKernel(1.0, (1e-2, 1e3)) * RBF(np.ones(len(RANGES)), (0.1, 1e4)) + WhiteKernel(
        1e-4, (1e-9, 1e-1)
    )
    return GaussianProcessRegressor(kernel, normalize_y=True, random_state=0)


def fit(study: tl.sweeps.Sweep) -> tuple[Surrogate, dict[str, np.ndarray], dict[str, np.ndarray], np.ndarray]:
    """The surrogate; readings as solved and as predicted by those who did not see them; the friction that is used."""
    inputs, readings = data_of(study)
    ends = [design.labels for design in study.design.inputs]
    surrogate = Surrogate(list(RANGES), np.array([e.min() for e in ends]), np.array([e.max() for e in ends]))
    scaled = surrogate.scaled(inputs)
    used = inputs[:, FORCE] / (inputs[:, FRICTION] * inputs[:, LOAD])
    unseen = {}
    for name, values in readings.items():
        logarithm = np.log(values)
        with warnings.catch_warnings():
            # An input without influence has a length without end, which stops at its bound.
            warnings.simplefilter("ignore", ConvergenceWarning)
            kernel = process().fit(scaled[:SCALED_ON], logarithm[:SCALED_ON]).kernel_
        predicted = np.empty_like(values)
        for train, test in KFold(FOLDS, shuffle=True, random_state=0).split(scaled):
            predicted[test] = np.exp(process(kernel).fit(scaled[train], logarithm[train]).predict(scaled[test]))
        error = predicted / values - 1
        near = used > NEARLY
        surrogate.errors[name] = {
            "rms": float(np.sqrt(np.mean(error**2))),
            "95 %": float(np.quantile(np.abs(error), 0.95)),
            "largest": float(np.abs(error).max()),
            "rms near sliding": float(np.sqrt(np.mean(error[near] ** 2))) if near.any() else None,
            "of the standard deviation": float(np.std(predicted - values) / np.std(values)),
        }
        surrogate.models[name] = process(kernel).fit(scaled, logarithm)
        unseen[name] = predicted
    return surrogate, readings, unseen, used


def save(surrogate: Surrogate, study: tl.sweeps.Sweep, folder: Path) -> None:
    """The surrogate as a pickle, which only those open who trust who wrote it, and what it is as JSON."""
    # Plain members: a class of a script is found by no other script.
    (folder / "surrogate.pickle").write_bytes(pickle.dumps(vars(surrogate)))
    box = {n: [float(a), float(b)] for n, a, b in zip(surrogate.names, surrogate.low, surrogate.high, strict=True)}
    versions = {name: metadata.version(name) for name in ("treadload", "scikit-learn", "numpy", "scipy")}
    told = {
        "case": study.case.to_toml(),
        "box, SI": box,
        "holds": f"inside the box and for Q < μP; with a warning for Q > {NEARLY} μP",
        "cases": dict(study.stats),
        "relative errors of cases that it did not see": surrogate.errors,
        "folds": FOLDS,
        "versions": {"python": platform.python_version(), **versions},
    }
    (folder / "surrogate.json").write_text(json.dumps(told, indent=2, ensure_ascii=False), encoding="utf-8")


def load(folder: Path) -> Surrogate:
    """The surrogate that `save` wrote. A pickle can run any program: open only your own."""
    return Surrogate(**pickle.loads((folder / "surrogate.pickle").read_bytes()))


@styled
def draw(
    surrogate: Surrogate, solved: dict[str, np.ndarray], unseen: dict[str, np.ndarray], used: np.ndarray, folder: Path
) -> None:
    """Predicted against solved, and the error against the share of friction that is used."""
    figure = new_figure(9.6, 8.2)
    axes = figure.subplots(2, 2)
    for column, (name, (_, words)) in enumerate(READINGS.items()):
        x, y = 1e6 * solved[name], 1e6 * unseen[name]
        error = surrogate.errors[name]
        upper, lower = axes[:, column]
        upper.plot([x.min(), x.max()], [x.min(), x.max()], color="0.4", lw=0.8)
        dots = upper.scatter(x, y, c=used, s=9, cmap="viridis_r", vmin=0, vmax=1)
        upper.set(xscale="log", yscale="log", xlabel="solved (microstrain)")
        for axis in (upper.xaxis, upper.yaxis):
            axis.set_major_locator(FixedLocator([10, 20, 50, 100, 200, 500]))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_locator(NullLocator())
        upper.set_ylabel("predicted, not seen (microstrain)")
        told = f"rms {100 * error['rms']:.2g} %, 95 % within {100 * error['95 %']:.2g} %"
        upper.set_title(f"{words[:1].upper()}{words[1:]}\n{told}", loc="left", fontsize=10)
        lower.axvspan(NEARLY, 1, color="0.9")
        lower.scatter(used, 100 * (y / x - 1), c=used, s=9, cmap="viridis_r", vmin=0, vmax=1)
        lower.axhline(0, color="0.4", lw=0.8)
        lower.set(xlabel="friction that is used, Q/μP (–)", ylabel="error (%)", xlim=(0, 1))
    figure.colorbar(dots, ax=axes, label="friction that is used, Q/μP (–)", aspect=40)
    tl.plots.save(figure, folder / "surrogate.png")


def main(folder: Path, count: int = 2000, spacing: str = "12 mm", jobs: int = 1) -> Surrogate:
    """Solve, fit, save, draw, check; returns the surrogate."""
    folder.mkdir(parents=True, exist_ok=True)
    study = solve(folder, count, spacing, jobs)
    print(study.summary())
    tl.results.write_parquet(table_of(study), folder / "study.parquet")
    surrogate, solved, unseen, used = fit(study)
    save(surrogate, study, folder)
    draw(surrogate, solved, unseen, used, folder)
    for name, error in surrogate.errors.items():
        print(f"{name}: " + ", ".join(f"{what} {value:.2%}" for what, value in error.items() if value is not None))
    # A single case, solved and asked.
    asked = dict(normal_load=32.5e3, inflation_pressure=8.2e5, friction=0.7, tractive_force=6e3, temperature=20.0)
    for name in READINGS:
        value, deviation, _ = surrogate(name, **asked)
        print(f"{name} of the base case: {1e6 * value:.1f} ± {1e6 * deviation:.1f} microstrain")
    for wrong in ({"temperature": 55.0}, {"friction": 0.31, "normal_load": 16e3}):
        try:
            surrogate("largest_extension", **{**asked, **wrong})
        except ValueError as error:
            print(f"refused: {error}")
    return surrogate


if __name__ == "__main__":
    given = sys.argv[1:]
    jobs = int(given.pop(given.index("--jobs") + 1)) if "--jobs" in given else 1
    where = [argument for argument in given if not argument.startswith("-")]
    small = {"count": 60, "spacing": "20 mm"} if "--small" in given else {}
    main(Path(where[0]) if where else Path("study"), jobs=jobs, **small)
