"""Draw the figures of the how-to pages into docs/images: python docs/howto_pictures.py [howto_laser ...].

Each function draws the figure of one page; that of the README's validation is drawn, too. Some figures are those of
a gallery script or an example, so that both show the same. Pictures of pages in a browser need the extras app and
dev, and Chromium. All take ten minutes of a processor.
"""

import contextlib
import runpy
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyBboxPatch

import treadload as tl
from treadload.plots.kit.style import styled

DOCS = Path(__file__).parent
CLONE = DOCS.parent
IMAGES = DOCS / "images"
GALLERY = {
    "howto_backcalculate": "gallery/plot_25_backcalculation.py",
    "howto_joint": "gallery/plot_17_joint.py",
    "howto_law_of_your_own": "gallery/plot_20_fatigue_laws.py",
    "howto_rough_road": "gallery/plot_22_texture.py",
    "validation": "validation_gallery/plot_00_overview.py",
}


def of_the_gallery(script: str) -> Figure:
    """The first figure of a gallery script."""
    with contextlib.chdir((DOCS / script).parent):
        names = runpy.run_path(str(DOCS / script))
    return next(value for value in names.values() if isinstance(value, Figure))


def example(name: str) -> Any:
    """The names of the script of an example."""
    return runpy.run_path(str(CLONE / "examples" / name / "run.py"))


def case(*changes: str) -> tl.Case:
    """The case of `examples/study`."""
    return tl.Case.from_toml(CLONE / "examples" / "study" / "study.toml", changes=list(changes))


def command_line(folder: Path) -> Figure:
    """What `treadload init` and `treadload run` compute."""
    command(folder, "init")
    return tl.run(tl.Case.from_toml(folder / "case.toml")).contact.plot.pressure()


def studies(folder: Path) -> Figure:
    """Strain at the base over temperature for three loads."""
    varied = {"pavement.temperature": [5.0, 15.0, 25.0, 35.0], "normal_load": ["25 kN", "32.5 kN", "40 kN"]}
    of, at = "largest_in_plane_extension", {"depth": 0.21}
    return tl.sweep(case(), varied).plot.curve(of, "pavement.temperature", by="rolling.normal_load", at=at)


def sensitivity(folder: Path) -> Figure:
    """The tornado of the page."""
    ranges = {
        "normal_load": ("25 kN", "40 kN"),
        "inflation_pressure": ("7 bar", "9 bar"),
        "friction": (0.4, 0.9),
        "tractive_force": ("0 kN", "9 kN"),
        "pavement.temperature": (5.0, 35.0),
    }
    reading = "largest_in_plane_extension"
    return tl.sweeps.screening.tornado(case(), ranges, reading, at={"depth": 0.21}).plot.tornado()


def surrogate(folder: Path) -> Path:
    """Predicted against solved, from the example with 300 cases."""
    example("study")["main"](folder, 300)
    return folder / "surrogate.png"


def scan_a_tire(folder: Path) -> Path:
    """The scan of the example mesh."""
    command(folder, "scan", str(tl.example_mesh()), "--units", "m", "--figure", "scan.png")
    return folder / "scan.png"


def photographs(folder: Path) -> Path:
    """A cloud of points as a reconstruction leaves it: no unit, noise, and a floor."""
    import trimesh

    rng = np.random.default_rng(5)
    mesh = trimesh.load(tl.example_mesh(), force="mesh")
    points = np.asarray(trimesh.sample.sample_surface(mesh, 900_000, seed=5)[0])
    points += rng.normal(scale=0.15e-3, size=points.shape)
    trimesh.PointCloud(0.8123 * points).export(folder / "fused.ply")
    keys = ("--known-length", "0.8123 = 1000 mm", "--smooth", "auto", "--figure", "scan.png")
    command(folder, "scan", "fused.ply", *keys)
    return folder / "scan.png"


def laser(folder: Path) -> Path:
    """Lines of a laser around a tread that is known, from the tests."""
    sys.path.insert(0, str(CLONE / "tests"))
    import laser_lines

    about = f'encoder = "deg"\naxle = "{1e3 * laser_lines.AXLE:g} mm"'
    path = laser_lines.write_rows(folder, *laser_lines.profiles(), about)
    command(folder, "scan", str(path), "--smooth", "auto", "--figure", "scan.png")
    return folder / "scan.png"


def fringes(folder: Path) -> Path:
    """The measurement of the example."""
    example("fringes")["main"](folder)
    return folder / "fringes.png"


def calibrate(folder: Path) -> Figure:
    """The fit of the page."""
    from treadload.footprint import Measured, Unknown

    belt = tl.tire.Belt.from_library("315/80R22.5")
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=belt)
    data = [
        *Measured.load_deflection([("15 kN", "16.1 mm"), ("30 kN", "27.8 mm"), ("45 kN", "39.0 mm")]),
        Measured(load=35e3, length=0.176, spread_x=0.0375, spread_y=0.0924),
    ]
    errors = {"deflection": "0.2 mm", "length": "2 %", "spread_x": "1 %", "spread_y": "1 %"}
    unknowns = ["foundation", Unknown("crown_radius", low="1 m", high="5 m")]
    return tl.calibrate(tire, unknowns, data, errors=errors).plot.fit()


def network(folder: Path) -> Figure:
    """The network of the example."""
    return example("network")["main"](folder).plot.stations()


def service_life(folder: Path) -> Figure:
    """Years of the first road of the page."""
    page = (DOCS / "howto" / "service_life.md").read_text("utf-8")
    return tl.run(tl.Case.from_text(page.split("```toml\n")[1].partition("```")[0])).life.plot.years()


@styled
def stress_dependent(folder: Path) -> Figure:
    """Moduli over depth of the base of the page under three pressures of a plate."""
    from treadload.materials import StressDependent, Uzan
    from treadload.response import settle

    crushed = StressDependent(Uzan(k1=90e6, k2=0.5, k3=-0.1), poisson=0.35, unit_weight=21e3)
    layers = [
        tl.Layer(tl.Elastic(3e9, 0.35), 0.09, name="asphalt"),
        tl.Layer(crushed, 0.30, name="base"),
        tl.Layer(tl.Elastic(60e6, 0.40), name="soil"),
    ]
    figure = tl.plots.new_figure(6.4, 4.2)
    axes = figure.subplots()
    for pressure in (300e3, 700e3, 1100e3):
        settled = settle(tl.UniformDisc(radius=0.15, pressure=pressure), tl.Pavement(layers))
        parts = settled.road.layers[1:-1]
        depths = 0.09 + np.concatenate([[0.0], np.cumsum([part.thickness for part in parts])])
        moduli = np.array([part.material.modulus for part in parts])
        axes.stairs(
            1e-6 * moduli, 1e3 * depths, orientation="horizontal", baseline=None, label=f"{1e-3 * pressure:g} kPa"
        )
    axes.invert_yaxis()
    axes.set(xlabel="modulus of the base (MPa)", ylabel="depth (mm)")
    axes.legend(title="pressure of the plate", frameon=False)
    return figure


@styled
def export(folder: Path) -> Figure:
    """A contact and the discs that stand for it."""
    solved = tl.run(case('spacing="6 mm"')).contact
    discs = tl.results.equivalent_discs(solved, 5).discs
    figure = solved.plot.pressure()
    for disc in discs:
        figure.axes[0].add_patch(
            Circle((1e3 * disc.x, 1e3 * disc.y), 1e3 * disc.radius, fill=False, color="0.15", lw=1.4)
        )
    figure.axes[0].set(xlim=(-190, 190), ylim=(190, -190))
    return figure


@styled
def behind_a_proxy(folder: Path) -> Figure:
    """Who speaks to whom."""
    figure = tl.plots.new_figure(8.2, 2.3)
    axes = figure.subplots()
    boxes = (
        "browsers",
        "web server\nTLS, passwords",
        "treadload app\nforms, limits",
        "a solving process\nof each user",
    )
    flow(axes, boxes, ("https", "user and secret\nas headers, one machine", "cases and\nresults"))
    return figure


@styled
def interruptions(folder: Path) -> Figure:
    """How a file is written."""
    figure = tl.plots.new_figure(8.2, 2.3)
    axes = figure.subplots()
    boxes = ("made in memory", "written as\n.NAME-….part", "flushed to\nthe disk", "renamed\nto NAME")
    flow(axes, boxes, ("no room: error,\nold file stays", "", "one step"))
    return figure


def flow(axes: Axes, boxes: tuple[str, ...], arrows: tuple[str, ...]) -> None:
    """Boxes in a row with arrows between them, each with words above it."""
    for number, words in enumerate(boxes):
        shape = FancyBboxPatch(
            (2.1 * number, 0), 1.2, 0.7, boxstyle="round,pad=0.06", fc="#eef2f5", ec="#2f5d7c", lw=1.2
        )
        axes.add_patch(shape)
        axes.text(2.1 * number + 0.6, 0.35, words, ha="center", va="center", fontsize=9)
    for number, words in enumerate(arrows):
        start = 2.1 * number + 1.3
        axes.annotate("", (start + 0.7, 0.35), (start, 0.35), arrowprops={"arrowstyle": "->", "color": "#2f5d7c"})
        axes.text(start + 0.35, 0.86, words, ha="center", va="bottom", fontsize=8)
    axes.set(xlim=(-0.15, 2.1 * len(boxes) - 0.75), ylim=(-0.15, 1.45))
    axes.set_axis_off()


def print_a_report(folder: Path) -> Path:
    """The top of a report in a browser."""
    command(folder, "init")
    tl.report(tl.run(tl.Case.from_toml(folder / "case.toml")), folder / "report.html")
    return photographed(folder / "report.html", 900, 1150)


def notebook(folder: Path) -> Path:
    """The linked maps of a contact."""
    tl.run(case('spacing="6 mm"')).contact.plot.interactive().write_html(folder / "contact.html")
    return photographed(folder / "contact.html", 1100, 720)


def photographed(page: Path, width: int, height: int) -> Path:
    """A picture of a file in a browser, pixels."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        view = browser.new_page(viewport={"width": width, "height": height})
        view.goto(page.as_uri())
        view.wait_for_load_state("networkidle")
        view.screenshot(path=str(page.with_suffix(".png")))
        browser.close()
    return page.with_suffix(".png")


def command(folder: Path, *words: str) -> None:
    """Run a command of treadload in a folder."""
    subprocess.run([sys.executable, "-m", "treadload", *words], cwd=folder, check=True)


DRAWN: tuple[Callable[[Path], Figure | Path], ...] = (
    command_line, service_life, studies, sensitivity, surrogate, scan_a_tire, photographs, laser, fringes, calibrate,
    network, stress_dependent, export, behind_a_proxy, interruptions, print_a_report, notebook,
)  # fmt: skip


def main(names: list[str]) -> None:
    """Draw the figures of these pages, or all."""
    drawings = {f"howto_{function.__name__}": function for function in DRAWN}
    for name in names or [*GALLERY, *drawings]:
        path = IMAGES / f"{name}.png"
        with tempfile.TemporaryDirectory() as folder:
            drawn = of_the_gallery(GALLERY[name]) if name in GALLERY else drawings[name](Path(folder))
            if isinstance(drawn, Path):
                shutil.copyfile(drawn, path)
            else:
                drawn.savefig(path, dpi=110, facecolor="white")
        print(path, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
