"""Draw the figures of the docs that no page draws when the site is built: python docs/figures_of_pages.py [NAME ...].

Without a name all are drawn. The pictures of reports need Chromium.
"""

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from importlib import resources
from pathlib import Path

from matplotlib.figure import Figure

import treadload as tl
from treadload.case import Case
from treadload.demo.run import CASES
from treadload.plots import compare_strain, tir_fit
from treadload.reporting import write_report
from treadload.steps import Result, run
from treadload.us_units import display_units

IMAGES = Path(__file__).parent / "images"
# Pixels across.
WIDE = 1400


def strain_side_by_side() -> None:
    """The strain map of README: the demo's free and tractive wheel."""
    results = _demo()
    drawn = compare_strain([result.response for result in results], [result.case.title for result in results])
    _save(drawn, "strain_side_by_side")


def tir_fit_of_a_truck_tire() -> None:
    """The fit of `howto/tir_files.md`, with the numbers of its block of Python."""
    belt = tl.tire.Belt.from_library("315/80R22.5")
    truck = tl.Tire.from_profile("315/80R22.5", inflation_pressure=800e3, belt=belt)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    rolling = tl.Rolling(normal_load=35e3, friction=0.75)
    loads, pressures = [20e3, 27.5e3, 35e3, 42.5e3], [700e3, 900e3]
    fit = tl.footprint.magic_formula(truck, road, rolling, loads=loads, pressures=pressures, spacing=6e-3)
    print(fit.summary())
    _save(tir_fit(fit), "tir_fit")


def report_us() -> None:
    """The first screen of the demo's report, in US units."""
    trees = {result.case.title: result.to_tree() for result in _demo()}
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "report.html"
        with display_units("us"):
            write_report(trees, page, title="What a truck tire does to a road")
        options = ("--headless", "--no-sandbox", "--hide-scrollbars", "--window-size=1180,1500",
                   f"--user-data-dir={folder}/browser")  # fmt: skip
        target = IMAGES / "report_us.png"
        subprocess.run([str(chromium), *options, f"--screenshot={target}", page.as_uri()], check=True, timeout=300)


def _demo() -> list[Result]:
    texts = [resources.files("treadload.demo").joinpath(f"{name}.toml").read_text(encoding="utf-8") for name in CASES]
    return [run(Case.from_text(text)) for text in texts]


def _save(figure: Figure, name: str) -> None:
    figure.savefig(IMAGES / f"{name}.png", dpi=WIDE / figure.get_figwidth())


FIGURES: dict[str, Callable[[], None]] = {
    "strain_side_by_side": strain_side_by_side, "tir_fit": tir_fit_of_a_truck_tire, "report_us": report_us,
}  # fmt: skip

if __name__ == "__main__":
    for wanted in sys.argv[1:] or FIGURES:
        FIGURES[wanted]()
