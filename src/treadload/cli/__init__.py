"""The command line: `treadload init | schema | run | life | report | compare | scan | catalogue | demo | …`."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated, NoReturn, ParamSpec

import typer
from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from treadload._version import __version__
from treadload.cli import compare as asked
from treadload.cli.progress import counts, stages
from treadload.errors import ConvergenceError, TreadloadError

DONE, FAILED, WRONG = 0, 1, 2
_P = ParamSpec("_P")

app = typer.Typer(
    help="What a tire does to a road: contact, rolling, strain, cracks and life.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
_out = Console(highlight=False, soft_wrap=True)
_err = Console(stderr=True, highlight=False, soft_wrap=True)

_Output = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="File to write: .nc (NetCDF), .csv or .xlsx.", show_default=False),
]


_Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")]
_Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Set a key of the case, as rolling.friction=0.6 or pavement.layers.0.thickness='8 cm'; without a value "
        "the key is removed. May be given several times.",
        show_default=False,
    ),
]
_Kind = Annotated[str, typer.Argument(help="The command that runs the case: run or life.")]
_DryRun = Annotated[bool, typer.Option("--dry-run", help="Check the case and say what would be solved.")]


def _name() -> Column:
    """A column of names that a case can copy: never broken into lines."""
    return Column("name", no_wrap=True)


def _one_sentence(command: Callable[_P, None]) -> Callable[_P, None]:
    """Turn every expected error of a command into one sentence on stderr and an exit code."""

    @functools.wraps(command)
    def guarded(*args: _P.args, **kwargs: _P.kwargs) -> None:
        try:
            return command(*args, **kwargs)
        except TreadloadError as error:
            _fail(str(error), FAILED if isinstance(error, ConvergenceError) else WRONG)
        except KeyboardInterrupt:
            _fail("interrupted; nothing more was written", FAILED)
        except MemoryError:
            _fail("out of memory: the grid is too fine for this machine; use a larger spacing", FAILED)

    return guarded


def _fail(message: str, code: int) -> NoReturn:
    _err.print(Text("error: ", style="bold red") + Text(message))
    raise typer.Exit(code)


def _planned(plan: str, path: Path) -> None:
    _out.print(plan, markup=False)
    _out.print(f"\nwould be written: {path}", markup=False)


def _written(files: Iterable[Path]) -> None:
    _out.print("\n" + "\n".join(f"written: {file}" for file in files), markup=False)


@app.callback(invoke_without_command=True)
def _root(
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if version:
        _out.print(f"treadload {__version__}")
        raise typer.Exit(DONE)


@app.command()
@_one_sentence
def run(
    case: Annotated[Path, typer.Argument(help="The case, a TOML file.")],
    output: _Output = None,
    changes: _Set = None,
    dry_run: _DryRun = False,
    quiet: _Quiet = False,
) -> None:
    """Compute a case and write its result."""
    from treadload.case import Case
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.study import plan_case, run_case

    path = output or case.with_suffix(".nc")
    # A path that cannot be written is refused before the computation, not after it.
    check_output(path)
    question = Case.from_toml(case, changes=changes or ())
    check_writable(path)
    if dry_run:
        return _planned(plan_case(question), path)
    with stages(_err, quiet=quiet) as tell:
        result = run_case(question, progress=tell)
        tell(f"writing {path}")
        files = write(result.to_tree(), path)
    _out.print(result.summary(), markup=False)
    _written(files)


@app.command()
@_one_sentence
def life(
    design: Annotated[Path, typer.Argument(help="The design case, a TOML file.")],
    output: _Output = None,
    sensitivity: Annotated[bool, typer.Option(help="Find what the life depends on most; doubles the work.")] = True,
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; all cores if left out.")] = None,
    changes: _Set = None,
    dry_run: _DryRun = False,
    quiet: _Quiet = False,
) -> None:
    """Compute the life of a road under its traffic and climate, and write it."""
    from treadload.case import LifeCase
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.study import plan_life, run_life

    path = output or design.with_suffix(".nc")
    check_output(path)
    question = LifeCase.from_toml(design, changes=changes or ())
    check_writable(path)
    if dry_run:
        return _planned(plan_life(question), path)
    with counts(_err, quiet=quiet) as tell:
        result = run_life(question, sensitivity=sensitivity, workers=workers, progress=tell)
    files = write(result.to_tree(), path)
    _out.print(result.summary(), markup=False)
    _written(files)


@app.command()
@_one_sentence
def init(
    kind: _Kind = "run",
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("case.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Write a case that runs as it is, each key with its unit, its default and its reason."""
    from treadload.case.first import first_case
    from treadload.errors import InputError
    from treadload.files import replacing

    text = first_case(kind)
    if output.exists() and not force:
        raise InputError(f"{output} exists already; give another name with -o, or --force to overwrite it")
    with replacing(output) as path:
        path.write_text(text, encoding="utf-8")
    _written([output])
    _out.print(f"next: treadload {kind} {output} --dry-run", markup=False)


@app.command()
@_one_sentence
def schema(
    kind: _Kind = "run",
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write; else it is printed.", show_default=False),
    ] = None,
) -> None:
    """JSON schema of a case, with what other packages bring: an editor then completes and explains its keys."""
    import json

    from treadload.case.schema import json_schema
    from treadload.files import replacing

    text = json.dumps(json_schema(kind), indent=2, ensure_ascii=False)
    if output is None:
        print(text)
        return
    with replacing(output) as path:
        path.write_text(f"{text}\n", encoding="utf-8")
    _written([output])
    _out.print(f"first line of the case, for editors that know Taplo: #:schema ./{output.name}", markup=False)


@app.command()
@_one_sentence
def report(
    results: Annotated[
        list[Path], typer.Argument(help="One or more result files of `treadload run` or `treadload life`.")
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File to write, .html.", show_default=False)
    ] = None,
    title: Annotated[str, typer.Option(help="Heading of the report.")] = "",
    quiet: _Quiet = False,
) -> None:
    """Write a self-contained HTML report with figures; several results stand side by side."""
    from treadload.files import HTML, check_suffix
    from treadload.reporting import write_report
    from treadload.results import open_results

    path = output or results[0].with_suffix(".html")
    check_suffix(path, HTML, "the report")
    with stages(_err, quiet=quiet) as tell:
        tell("reading")
        trees = {}
        for file in results:
            tree = open_results(file).tree
            label = str(tree.attrs.get("title") or file.stem)
            trees[label if label not in trees else f"{label} ({file.stem})"] = tree
        tell("drawing")
        write_report(trees, path, title=title or " and ".join(trees))
    _out.print(f"written: {path}", markup=False)


@app.command()
@_one_sentence
def compare(
    result: Annotated[Path, typer.Argument(help="Result file of `treadload run`, with a contact.")],
    footprint: asked.Footprint,
    output: _Output = None,
    report: Annotated[Path | None, typer.Option(help="Page to write, .html.", show_default=False)] = None,
    units: asked.Units = None,
    spacing: asked.Spacing = None,
    frame: asked.Frame = "peak",
    travel: asked.Travel = "right",
    seen_from: asked.SeenFrom = "above",
    calibration: asked.Calibration = None,
    load: asked.Load = None,
    threshold: asked.Threshold = None,
    saturation: asked.Saturation = None,
    dead: asked.Dead = "leave",
    colours: asked.Colours = None,
    scale: asked.Scale = None,
    registration: asked.Registration = "full",
    load_tolerance: asked.Tolerance = "25 %",
    quiet: _Quiet = False,
) -> None:
    """Lay a measured footprint onto a computed contact, and tell how they agree."""
    from treadload.files import HTML, check_suffix
    from treadload.results import to_tree
    from treadload.results.exports import check_output, write

    if output is not None:
        check_output(output)
    if report is not None:
        check_suffix(report, HTML, "the report")
    files: list[Path] = []
    with stages(_err, quiet=quiet) as tell:
        found = asked.compare_files(
            result, footprint, tell, units=units, spacing=spacing, frame=frame, travel=travel, seen_from=seen_from,
            calibration=calibration, load=load, threshold=threshold, saturation=saturation, dead=dead,
            colours=colours, scale=scale, registration=registration, load_tolerance=load_tolerance,
        )  # fmt: skip
        if output is not None:
            files += write(to_tree(found), output)
        if report is not None:
            from treadload.reporting import report as write_page

            tell("drawing")
            files.append(write_page(found, report, title=f"{result.name} and {footprint.name}"))
    _out.print(found.summary(), markup=False)
    if files:
        _written(files)


@app.command()
@_one_sentence
def scan(
    mesh: Annotated[Path, typer.Argument(help="OBJ, PLY, STL, GLB or OFF file of a tire.")],
    output: _Output = None,
    units: Annotated[str | None, typer.Option(help="Unit of the file: m, cm, mm or inch.")] = None,
    nominal_diameter: Annotated[str | None, typer.Option(help='Outer diameter, e.g. "1076 mm".')] = None,
    rotation: Annotated[str, typer.Option(help="Angle of the wheel about its axle.")] = "0 deg",
    camber: Annotated[str, typer.Option(help="Lean to the right.")] = "0 deg",
    revolve: Annotated[str, typer.Option(help="Revolve the meridian, not the facets: yes, no or auto.")] = "auto",
    smooth: Annotated[str, typer.Option(help='Length to smooth noise over, e.g. "6 mm"; no or auto.')] = "no",
    outliers: Annotated[str, typer.Option(help="Points that stick out: remove, refuse or keep.")] = "remove",
    roundness: Annotated[float, typer.Option(help="Share of the radius by which it may vary.")] = 0.02,
    spacing: Annotated[str, typer.Option(help="Cell size of the height map.")] = "3 mm",
    quiet: _Quiet = False,
) -> None:
    """Read a tire mesh, report its quality, and write its height map."""
    from treadload.results import height_map
    from treadload.results.exports import check_output, write
    from treadload.tire import Tire
    from treadload.tire.scan_options import revolve_choice, smooth_choice
    from treadload.units import quantity

    if output is not None:
        check_output(output)
    with stages(_err, quiet=quiet) as tell:
        tell(f"reading {mesh}")
        tire = Tire.from_scan(
            mesh,
            units=units,
            nominal_diameter=None if nominal_diameter is None else quantity(nominal_diameter, "m"),
            rotation=quantity(rotation, "rad"),
            camber=quantity(camber, "rad"),
            revolve=revolve_choice(revolve),
            smooth=smooth_choice(smooth),
            outliers=outliers,  # type: ignore[arg-type]  # checked where it is used
            roundness=roundness,
        )
        if output is not None:
            tell("casting rays")
            files = write(height_map(tire, quantity(spacing, "m")), output)
    _out.print(str(tire.quality), markup=False)
    if output is not None:
        _written(files)


@app.command()
@_one_sentence
def catalogue(
    kind: Annotated[
        str,
        typer.Argument(help="structures, mixes, materials, tires or belts; all if left out.", show_default=False),
    ] = "",
    name: Annotated[str, typer.Argument(help="One of them, in full.", show_default=False)] = "",
) -> None:
    """Structures, mixes, viscoelastic materials, tires and belts that a case can name, with sources and doubts."""
    from treadload import catalogue as catalogues
    from treadload.errors import InputError, nearest

    kinds = {one: getattr(catalogues, one) for one in ("structures", "mixes", "materials", "tires", "belts")}
    if kind and kind not in kinds:
        raise InputError(f"no catalogue of {kind!r}; {nearest(kind, kinds)}")
    if name:
        return _out.print(kinds[kind].about(name), markup=False)
    notes: dict[str, int] = {}
    for one in kinds.values() if not kind else [kinds[kind]]:
        table = Table(_name(), "what it is", "notes", title=one.use, title_justify="left")
        for item_name, words, item in one.rows():
            told = [text for text in (item.source, *item.doubts) if text]
            marks = " ".join(f"[{notes.setdefault(text, len(notes) + 1)}]" for text in told)
            table.add_row(item_name, Text(words), Text(marks))
        _out.print(table)
    if not kind:
        _out.print(_kinds())
    for text, number in notes.items():
        _out.print(f"[{number}] {text}", markup=False)


def _kinds() -> Table:
    """What a table of a case can be, by its kind, and which package brings it where it is not treadload."""
    import treadload.case  # its rooms register what they have
    import treadload.tire.mesh_file  # noqa: F401
    from treadload.registry import ALL

    table = Table("key", "names", title="what a table of a case can be", title_justify="left")
    for registry in ALL:
        named = ", ".join(f"{name} ({package})" if package else name for name, package in registry.packages().items())
        if named:
            table.add_row(f"{registry.noun}, {registry.key} = …" if registry.key else registry.noun, Text(named))
    return table


@app.command()
@_one_sentence
def demo(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder to write.")] = Path("demo"),
    quiet: _Quiet = False,
) -> None:
    """A real truck tire, rolling freely and driving: results, figures and a report."""
    from treadload.demo import run_demo

    with stages(_err, quiet=quiet) as tell:
        made = run_demo(output, progress=tell)
    heading, *rows = made.table
    table = Table(*heading, title="A 335/65R22.5 truck tire at 32.5 kN on asphalt, friction 0.7")
    for row in rows:
        table.add_row(*row)
    _out.print(table)
    _out.print(f"{len(made.files)} files in {output.resolve()} after {made.seconds:.1f} s", markup=False)
    _out.print(f"open {output / 'report.html'}", markup=False)


@app.command()
@_one_sentence
def validate(
    markdown: Annotated[bool, typer.Option("--markdown", help="Print a table for a document.")] = False,
    quiet: _Quiet = False,
) -> None:
    """Compare the solvers with closed forms and published numbers, row by row."""
    from treadload.validation import format_markdown, format_table, run_checks

    with stages(_err, quiet=quiet) as tell:
        checks = run_checks(progress=tell)
    # The table goes out as it is: a terminal may be narrower than it.
    print(format_markdown(checks) if markdown else format_table(checks))
    failed = [check for check in checks if not check.passed]
    if failed:
        _err.print(f"{len(failed)} of {len(checks)} checks failed", style="bold red")
        raise typer.Exit(FAILED)


def main() -> None:
    """Run the command line."""
    app()


if __name__ == "__main__":
    main()
