"""One way through the house: who may import whom, read from the sources."""

import ast
import functools
import pickle
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import treadload
import treadload as tl
from cases import COARSE_CASE
from texts import code_of, nodes
from treadload import deferred
from treadload.registry import STEPS

ROOT = Path(treadload.__file__).parent

# May be imported by all; import nothing but each other.
LEAVES = (
    "errors",
    "variables",
    "units",
    "labels",
    "tables",
    "plausible",
    "files",
    "describing",
    "spelling",
    "templates",
    "figure_registry",
    "citations",
    "composing",
    "registry",
    "rows",
    "us_units",
    "named",
    "read",
    "metrology",
    "identifiability",
    "_public",
    "deferred",
    "_version",
)
# From left to right: a package imports those before it. Packages of one step do not know each other.
ORDER = (
    ("kernels",),
    ("materials", "grid"),
    ("tire", "pavement"),
    ("catalogue",),
    ("contact",),
    ("response",),
    ("damage",),
    ("footprint", "roads"),
    ("case",),
    ("results",),
    ("life", "calibration"),
    ("steps",),
    ("sweeps",),
    ("validation",),
    ("plots",),
    ("reporting",),
    ("demo", "app"),
    ("cli",),
    ("__main__",),
)
STEP = {name: step for step, names in enumerate(ORDER) for name in names}

# The only module that may import by a name in a text: the public names are loaded when they are first used.
LAZY = "_public.py"

# Third-party package: the only places that may import it.
ONLY_IN = {
    "matplotlib": ("plots", "reporting"),
    "dask": ("sweeps",),
    "distributed": ("sweeps",),
    "zarr": ("sweeps",),
    "SALib": ("sweeps",),
    "pyarrow": ("results",),
    "trimesh": ("tire",),
    "embreex": ("tire",),
    "skimage": ("tire",),
    "SurfaceTopography": (),
    "pint": ("units",),
    "pydantic": ("read", "case", "steps"),
    "openpyxl": ("results",),
    "typer": ("cli",),
    "rich": ("cli",),
    "jinja2": ("reporting",),
    "nicegui": ("app",),
    "plotly": ("app", "plots"),
}
NUMBERS = ("numpy", "scipy", "xarray", "pandas")


def sources():
    return sorted(ROOT.rglob("*.py"))


def containing(*words):
    """Modules in whose text one of some words stands: to parse all of them takes seconds."""
    return [path for path in sources() if any(word in path.read_text(encoding="utf-8") for word in words)]


def name_of(path):
    return path.relative_to(ROOT).as_posix()


def package_of(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


@functools.cache
def imports(path):
    """Dotted names of all that a module imports, now or when a function runs; of ours the modules that are meant."""
    found = []
    for node in code_of(path)[0]:
        if isinstance(node, ast.Import):
            found.extend(alias.name for alias in node.names)
        else:
            assert node.level == 0, f"{name_of(path)}:{node.lineno} imports relatively; write the whole name"
            for alias in node.names:
                if node.module == "treadload.deferred":
                    found.append(alias.name)
                # `from treadload.kernels import fft` names a module in the list.
                whole = f"{node.module}.{alias.name}"
                found.append(whole if whole in PATHS else node.module)
    return found


def own_imports(path):
    """Top-level names of ours that a module imports."""
    return {name.split(".")[1] for name in imports(path) if name.startswith("treadload.")}


def third_party(path):
    return {name.split(".")[0] for name in imports(path)} - {"treadload", "__future__"}


def dotted(path):
    return ".".join(["treadload", *path.relative_to(ROOT).with_suffix("").parts]).removesuffix(".__init__")


def circles(arrows):
    """Sets of nodes of a graph (node → nodes) that all reach each other."""
    reached = {}
    for node in arrows:
        seen, ahead = set(), list(arrows[node])
        while ahead:
            one = ahead.pop()
            if one not in seen:
                seen.add(one)
                ahead.extend(arrows.get(one, ()))
        reached[node] = seen
    return {frozenset(b for b in reached[a] if a in reached.get(b, ())) for a in arrows if a in reached[a]}


PATHS = {dotted(path): path for path in sources()}
MODULES = [path for path in sources() if package_of(path) != "__init__"]


def test_every_module_has_a_place_in_the_order():
    unknown = {package_of(path) for path in MODULES} - set(STEP) - set(LEAVES)
    assert not unknown, f"say in ORDER where {unknown} stand"


def wrong_ways(path):
    """What a module imports against the order, each in a sentence."""
    package = package_of(path)
    for other in sorted(own_imports(path) - {package, *LEAVES}):
        if package in LEAVES:
            yield f"{name_of(path)} is a leaf and imports {other}"
        elif not STEP[other] < STEP[package]:
            yield f"{name_of(path)} reaches back to {other}"


def test_imports_go_one_way():
    """Imports that wait for a call, or for a type checker, go the same way."""
    wrong = [sentence for path in MODULES for sentence in wrong_ways(path)]
    assert not wrong, "\n".join(wrong)


def test_no_module_imports_what_imports_it():
    """Not even when a function runs."""
    arrows = {name: set(imports(path)) & set(PATHS) for name, path in PATHS.items() if name != "treadload"}
    assert not circles(arrows)
    # The public names know every room: none of the rooms may take one from there.
    assert not [name for name in arrows if "treadload" in arrows[name]]


def test_a_circle_would_be_seen():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"d"}}) == {frozenset("bc"), frozenset("d")}
    assert not circles({"a": {"b", "c"}, "b": {"c"}, "c": set()})


INNER = ["kernels", "contact", "damage", "plots", "results", "catalogue", "life", "tire"]


@pytest.mark.parametrize("package", INNER)
def test_inner_rooms_form_no_circle(package):
    """An inner room, or a module beside the inner rooms, is one node."""

    def room(name):
        parts = name.split(".")
        return ".".join(parts[:3])

    arrows = {}
    for path in MODULES:
        if package_of(path) == package and dotted(path) != f"treadload.{package}":
            here = room(dotted(path))
            others = {room(name) for name in imports(path) if name.startswith(f"treadload.{package}.")}
            arrows.setdefault(here, set()).update(others - {here})
    assert not circles(arrows)


# What imports by a text, or runs one.
HIDING = {"import_module", "__import__", "exec", "eval", "spec_from_file_location"}


def hidden_imports(text):
    """Names by which a source imports from a text."""
    tree = ast.parse(text)
    called = {getattr(node.func, "attr", getattr(node.func, "id", "")) for node in calls(tree)}
    taken = {
        alias.name
        for node in nodes(tree)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("importlib")
        for alias in node.names
    }
    return (called | taken) & HIDING


def calls(tree):
    return [node for node in nodes(tree) if isinstance(node, ast.Call)]


def test_no_import_is_hidden_in_a_text():
    hidden = {name_of(path): hidden_imports(path.read_text(encoding="utf-8")) for path in containing(*HIDING)}
    assert {name for name, found in hidden.items() if found} == {LAZY}, hidden


def test_a_hidden_import_would_be_seen():
    assert hidden_imports("import importlib\nx = importlib.import_module('a')") == {"import_module"}
    assert hidden_imports("from importlib import import_module as f\neval('1')") == {"import_module", "eval"}
    assert not hidden_imports("'exec'; executable(model.evaluate())")


def test_one_module_holds_the_fft():
    users = set()
    for path in containing("fft"):
        for node in nodes(ast.parse(path.read_text(encoding="utf-8"))):
            text = ast.unparse(node) if isinstance(node, ast.Import | ast.ImportFrom | ast.Attribute) else ""
            if re.match(r"(from|import)? ?(scipy|numpy|np)(\.fft| import .*\bfft\b)", text):
                users.add(name_of(path))
    assert users == {"kernels/fft.py"}


def modules_of(*packages):
    paths = [path for path in MODULES if package_of(path) in packages]
    assert paths, packages
    return paths


def test_kernels_know_arrays_only():
    for path in modules_of("kernels"):
        assert own_imports(path) <= {"kernels"}, name_of(path)
        # The array library is chosen in one place, and CuPy is one of them where it is installed.
        others = {"cupy"} if name_of(path) == "kernels/fft.py" else set()
        assert third_party(path) - set(sys.stdlib_module_names) <= {"numpy", "scipy"} | others, name_of(path)


def test_heavy_packages_stay_in_their_room():
    wrong = [
        f"{name_of(path)} imports {name}, which belongs to {ONLY_IN[name]}"
        for path in MODULES
        for name in sorted(third_party(path) & set(ONLY_IN))
        if package_of(path) not in ONLY_IN[name]
    ]
    assert not wrong, "\n".join(wrong)


def test_the_command_line_and_the_app_contain_no_mechanics():
    for path in modules_of("cli", "app"):
        assert not third_party(path) & set(NUMBERS), name_of(path)
        assert "kernels" not in own_imports(path), name_of(path)


# Functions with more than eight parameters outside the kernels: options of commands, keys of a law in a case, readers
# of files, and verbs. The number may fall, not rise.
MANY_PARAMETERS, FUNCTIONS_WITH_MANY = 8, 10


def functions_with_many_parameters():
    functions = []
    for path in MODULES:
        if package_of(path) == "kernels":
            continue
        for name, parameters in code_of(path)[1]:
            if len([parameter for parameter in parameters if parameter not in ("self", "cls")]) > MANY_PARAMETERS:
                functions.append(f"{name_of(path)}:{name}")
    return functions


def test_few_functions_have_many_parameters():
    """A function with more lacks an object that means something in the field."""
    assert len(functions_with_many_parameters()) <= FUNCTIONS_WITH_MANY


# How often `Any` stands in a signature outside readers and result files: what comes from packages without types, and
# tables of TOML and JSON that are taken apart by key. The number may fall, not rise.
READERS_AND_FILES, ANY_IN_SIGNATURES = ("read", "results", "metrology"), 7


def any_in_signatures(source):
    """Function and parameter, or "return", for every `Any` in the annotations of a source's signatures."""
    for node in nodes(ast.parse(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            args = node.args
            taken = [*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg]
            hints = [(part.arg, part.annotation) for part in taken if part is not None] + [("return", node.returns)]
            for name, hint in hints:
                for part in ast.walk(hint) if hint is not None else ():
                    if isinstance(part, ast.Name) and part.id == "Any":
                        yield node.name, name


def test_signatures_say_what_they_take():
    """Pass `object` on, take a protocol or a class, and a TypedDict for keywords."""
    found = [
        f"{name_of(path)}:{function}({name})"
        for path in containing("Any")
        if package_of(path) not in READERS_AND_FILES
        for function, name in any_in_signatures(path.read_text(encoding="utf-8"))
    ]
    assert len(found) <= ANY_IN_SIGNATURES, "\n".join(found)


def test_any_in_a_signature_would_be_seen():
    source = "def f(a: Any, *b: int, c: list[tuple[Any, Any]], **d: object) -> dict[str, Any]: ..."
    assert [name for _, name in any_in_signatures(source)] == ["a", "c", "c", "return"]


def loaded_after(statement):
    """Names of the top-level modules in a fresh interpreter after a statement."""
    code = f"import sys; {statement}; print(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_importing_the_package_loads_none_of_the_heavy_ones():
    heavy = {"matplotlib", "trimesh", "embreex", "dask", "pint", "typer", "pydantic", "xarray", "pandas", "scipy"}
    assert not loaded_after("import treadload") & heavy


def test_solving_a_contact_needs_no_figures_no_scan_and_no_units():
    assert not loaded_after("import treadload; treadload.solve_contact") & {"matplotlib", "trimesh", "dask", "pint"}


def test_the_command_line_starts_without_numbers():
    assert not loaded_after("import treadload.cli.commands") & {"matplotlib", "scipy", "xarray", "trimesh"}


def test_xarray_is_loaded_when_it_is_first_used():
    wrong = [
        f"{name_of(path)}:{node.lineno}: write `from treadload.deferred import xarray as xr`"
        for path in containing("import xarray")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.Import) and node.names[0].name == "xarray"
    ]
    assert not wrong, "\n".join(wrong)


def test_the_deferred_xarray_is_xarray():
    assert deferred.xarray.Dataset is xr.Dataset
    assert pickle.loads(pickle.dumps(deferred.xarray)) is deferred.xarray
    with pytest.raises(AttributeError, match="Datasett"):
        _ = deferred.xarray.Datasett


def test_no_public_name_hides_a_module():
    """Importing a submodule sets it on the package: a public function of that name would vanish behind it."""

    modules = {path.stem for path in ROOT.iterdir() if path.suffix == ".py" or path.is_dir()}
    for name in modules & set(treadload.__all__):
        assert getattr(treadload, name).__name__ == f"treadload.{name}"


# Where else than in `steps/` and `variables.py` two or more steps may be named in a list, with the reason.
LISTS_OF_STEPS = {
    "validation/table.py": "groups of checks, four of which have the name of a step",
}


def lists_of_steps(source, names, least=2):
    """Lines of lists, tuples, sets and tables that hold so many names of steps."""
    for node in nodes(ast.parse(source)):
        members = node.elts if isinstance(node, ast.List | ast.Tuple | ast.Set) else getattr(node, "keys", ())
        held = [one for one in members if isinstance(one, ast.Constant) and one.value in names]
        if len(held) >= least:
            yield node.lineno


def test_no_module_lists_the_steps():
    """A step is registered where it is defined; no list outside names two, the page none."""
    names = set(STEPS.built_in())
    quoted = re.compile("|".join(f"[\"']{re.escape(name)}[\"']" for name in sorted(names)))
    for path in MODULES:
        if package_of(path) in ("steps", "variables"):
            continue
        least = 1 if package_of(path) == "app" else 2
        source = path.read_text(encoding="utf-8")
        # Only what names enough of them between quotes is parsed.
        lines = list(lists_of_steps(source, names, least)) if len(set(quoted.findall(source))) >= least else []
        if name_of(path) in LISTS_OF_STEPS:
            assert lines, f"{name_of(path)} lists no steps any more: take it from LISTS_OF_STEPS"
        else:
            assert not lines, f"{name_of(path)} lists steps on lines {lines}"


def test_a_list_of_steps_would_be_seen():
    names = {"contact", "damage"}
    assert list(lists_of_steps("a = 1\nb = ['contact', 'damage']", names)) == [2]
    assert list(lists_of_steps("b = {'contact': 1, 'damage': 2}", names)) == [1]
    assert not list(lists_of_steps("b = ('contact', 'x')", names))


PAGE = Path(__file__).parents[1] / "docs" / "explanation" / "architecture.md"


def section(title):
    return PAGE.read_text(encoding="utf-8").partition(f"## {title}\n")[2].partition("\n## ")[0]


def test_the_picture_of_the_house_shows_every_room():
    picture = section("Subpackages").split("```")[1]
    drawn = set(re.findall(r"[a-z_]+/", picture)) | set(re.findall(r"[a-z_]+", picture))
    rooms = {f"{path.parent.name}/" for path in MODULES if path.parent != ROOT}
    beside = {path.stem for path in MODULES if path.parent == ROOT} - {"_version", "_public", "__main__"}
    assert rooms | beside <= drawn
    for folder in ("kernels", "contact", "damage", "results"):
        modules = {path.stem for path in (ROOT / folder).glob("[a-z]*.py")}
        assert modules <= drawn, f"modules of {folder}/ that are not drawn: {modules - drawn}"
    # And none that is not there.
    assert set(re.findall(r"[a-z_]+/", picture)) <= rooms


def rooms_of_fields(job, shape):
    """Folders of ours in which a function takes or returns a field of this shape, or a dataset, while a job runs."""
    rooms = set()

    def is_field(value):
        if isinstance(value, tuple | list):
            return any(is_field(one) for one in value)
        if isinstance(value, np.ndarray):
            return value.shape[-2:] == shape
        return isinstance(value, xr.Dataset | xr.DataArray | tl.contact.Contact)

    def look(frame, event, value):
        code = frame.f_code
        if not code.co_filename.startswith(str(ROOT)):
            return
        taken = [frame.f_locals.get(name) for name in code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]]
        if is_field(taken) if event == "call" else is_field(value) if event == "return" else False:
            rooms.add(Path(code.co_filename).parent.relative_to(ROOT).as_posix())

    sys.setprofile(look)
    try:
        job()
    finally:
        sys.setprofile(None)
    return rooms


def test_the_walk_of_a_gap_enters_ten_rooms_at_most():
    """From the height map to the figure of the pressure; docs/explanation/architecture.md describes the same way."""
    across = (np.arange(24) - 11.5) * 5e-3
    tire = tl.Tire.from_height_map(across[None, :] ** 2 + across[:, None] ** 2, 5e-3, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    rolling = tl.Rolling(normal_load=300, tractive_force=50, friction=0.7)
    rooms = rooms_of_fields(lambda: tl.solve_contact(tire, road, rolling).plot.pressure(), (24, 24))
    told = re.findall(r"^\d+\. .*?`([a-z_/]+)/`", section("From the gap to the figure"), re.M)
    assert len(told) == len(set(told)) <= 10
    # Leaves are no rooms, those of the kernels neither: the array library transforms and carries what they hand it.
    # The closed forms of a body are of distances, which have a shape of their own.
    assert rooms - {".", "kernels"} == set(told) - {"kernels/half_space"}


def test_a_wheel_goes_through_few_files_from_case_to_figure():
    """The modules in which a function takes or returns `[rolling]`, or the wheel that it describes."""
    text = COARSE_CASE.partition("[response]")[0]
    kinds = (tl.Rolling, type(tl.Case.from_text(text).rolling))
    files = set()

    def look(frame, event, value):
        code = frame.f_code
        if code.co_filename.startswith(str(ROOT)) and event in ("call", "return"):
            taken = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
            values = [frame.f_locals.get(name) for name in taken] if event == "call" else [value]
            if any(isinstance(value, kinds) for value in values):
                files.add(name_of(Path(code.co_filename)))

    sys.setprofile(look)
    try:
        tl.run(tl.Case.from_text(text)).contact.plot.pressure()
    finally:
        sys.setprofile(None)
    assert 4 <= len(files) <= 12, sorted(files)


PARSING = {"split", "splitlines", "partition", "rpartition", "startswith", "endswith", "find", "index", "replace",
           "removeprefix", "removesuffix", "match", "fullmatch", "search", "findall", "finditer", "sub"}  # fmt: skip


def parsed_summaries(tree):
    """Lines on which the text of a summary, or a name that holds one, is cut, searched or indexed."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    for scope in functions or [tree]:
        names = set()
        for node in ast.walk(scope):
            if isinstance(node, ast.Assign) and is_summary(node.value, names):
                names |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        for node in ast.walk(scope):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in PARSING:
                if any(is_summary(part, names) for part in (node.func.value, *node.args)):
                    yield node.lineno
            elif isinstance(node, ast.Subscript) and is_summary(node.value, names):
                yield node.lineno


def is_summary(expression, names):
    """True where an expression makes the text of a summary, or names one."""
    for part in ast.walk(expression):
        if isinstance(part, ast.Call):
            called = getattr(part.func, "attr", getattr(part.func, "id", ""))
            if called in ("summary", "as_text"):
                return True
        if getattr(part, "value", None) == "summary" or getattr(part, "id", "") in names:
            return True
    return False


def test_no_text_of_a_summary_is_parsed():
    """Numbers are taken from `rows()`; a summary is printed, never read."""
    found = [
        f"{name_of(path)}:{line}"
        for path in containing("summary", "as_text")
        for line in parsed_summaries(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert not found, f"take the rows of the result in place of its summary: {', '.join(found)}"


@pytest.mark.parametrize(
    "text",
    ["r.summary().splitlines()[4]", "re.search('x', r.summary())", "text = r.summary()\nline = text.split()",
     "attrs.get('summary').partition(':')"],
)  # fmt: skip
def test_a_summary_that_is_parsed_is_seen(text):
    assert list(parsed_summaries(ast.parse(text)))
