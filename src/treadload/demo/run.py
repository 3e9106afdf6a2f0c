"""Run the demonstration cases and write everything that they give."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

from treadload.case import Case
from treadload.errors import InputError
from treadload.files import write_whole
from treadload.plots import compare_pressure, compare_strain, fatigue_line, save
from treadload.reporting import write_report
from treadload.results import save_results
from treadload.steps import Result, run
from treadload.us_units import check_system, display_units

CASES = ("free", "tractive")
# Rows of the table, as contacts and verdicts state them.
_COMPARED = (
    "normal_load", "tractive_force", "net_area", "largest_pressure", "largest_traction", "creepage_x",
    "slip_fraction", "evaluation", "largest_principal_strain", "largest_in_plane_strain", "worst_strain",
    "worst_passes", "worst_crack_orientation",
)  # fmt: skip

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Demo:
    """What the demonstration made.

    results: by name of the case. files: written, in order. seconds: from the start to the last file.
    """

    results: dict[str, Result]
    files: tuple[Path, ...]
    seconds: float

    @property
    def table(self) -> list[tuple[str, ...]]:
        """Rows (quantity, value of every case) for a reader; the first row is the heading."""
        return comparison(list(self.results.values()))


def run_demo(folder: Path, progress: Progress | None = None, units: str = "si") -> Demo:
    """Free and tractive rolling of the example tire: results, figures and a report in a folder.

    folder: made if it is not there; files in it with the same names are replaced.
    progress: called with a line of text at every stage. units: of figures and report, "si" or "us"; the result files
    stay in SI units. Raises InputError if the folder cannot be written, or for another word of units.
    """
    began = time.perf_counter()
    check_system(units)
    tell = progress or (lambda text: None)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {folder}: {error.strerror}; choose one you may write to") from error
    results: dict[str, Result] = {}
    files: list[Path] = []
    for name in CASES:
        text = resources.files("treadload.demo").joinpath(f"{name}.toml").read_text(encoding="utf-8")
        write_whole(folder / f"{name}.toml", text)
        case = Case.from_text(text, name=f"{name}.toml")
        result = run(case, progress=lambda stage, title=case.title: tell(f"{title}: {stage}"))  # type: ignore[misc]
        results[name] = result
        files += [folder / f"{name}.toml", save_results(result, folder / f"{name}.nc")]
    tell("figures")
    with display_units(units):
        files += _figures(results, folder)
        tell("report")
        trees = {result.case.title: result.to_tree() for result in results.values()}
        files.append(write_report(trees, folder / "report.html", title="What a truck tire does to a road"))
    return Demo(results, tuple(files), time.perf_counter() - began)


def _figures(results: dict[str, Result], folder: Path) -> list[Path]:
    titles = [result.case.title for result in results.values()]
    figures = {
        "pressure_side_by_side": compare_pressure(
            [r.contact for r in results.values() if r.contact is not None], titles
        ),
        "strain_side_by_side": compare_strain([r.response for r in results.values()], titles),
        "fatigue_line": fatigue_line([r.verdict for r in results.values() if r.verdict is not None], titles),
    }
    for name, result in results.items():
        assert result.contact is not None
        figures |= {
            f"{name}_shear": result.contact.plot.shear(),
            f"{name}_strain_directions": result.response.plot.strain_directions(),
            f"{name}_slice_across": result.slice_across.plot.depth_slice(),
        }
    return [save(figure, folder / f"{name}.png") for name, figure in figures.items()]


def comparison(results: list[Result]) -> list[tuple[str, ...]]:
    """Rows (quantity, value of every result), heading first: what the results state of themselves by these keys."""
    parts = [(result.contact, result.verdict) for result in results]
    stated = [{row.key: row for part in both if part is not None for row in part.rows()} for both in parts]
    heading = ("", *(result.case.title for result in results))
    return [heading, *((stated[0][key].label, *(table[key].text for table in stated)) for key in _COMPARED)]
