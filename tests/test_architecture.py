"""One way through the house: who may import whom, read from the sources."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import treadload

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
    "_version",
)
# From left to right: a package imports those before it. Packages of one step do not know each other.
ORDER = (
    ("kernels", "catalogue"),
    ("materials", "grid"),
    ("tire", "pavement"),
    ("contact",),
    ("response",),
    ("damage",),
    ("footprint",),
    ("case",),
    ("results",),
    ("study",),
    ("validation",),
    ("plots",),
    ("reporting",),
    ("demo", "app"),
    ("cli",),
    ("__main__",),
)
STEP = {name: step for step, names in enumerate(ORDER) for name in names}

# (module, package it reaches forward to): why. Each must be lazy: under TYPE_CHECKING or inside a function.
EXCEPTIONS = {
    ("contact/solution.py", "plots"): "the accessor contact.plot loads the figures when it is asked for",
    ("response/solution.py", "plots"): "the accessor response.plot loads the figures when it is asked for",
    ("damage/verdict.py", "plots"): "the accessor verdict.plot loads the figures when it is asked for",
}

# Third-party package: the only places that may import it.
ONLY_IN = {
    "matplotlib": ("plots", "reporting"),
    "dask": ("study",),
    "trimesh": ("tire",),
    "embreex": ("tire",),
    "pint": ("units",),
    "openpyxl": ("results",),
    "typer": ("cli",),
    "rich": ("cli",),
    "jinja2": ("reporting",),
    "nicegui": ("app",),
    "plotly": ("app",),
}
NUMBERS = ("numpy", "scipy", "xarray", "pandas")


def sources():
    return sorted(ROOT.rglob("*.py"))


def name_of(path):
    return path.relative_to(ROOT).as_posix()


def package_of(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imports(path):
    """(dotted name, True if it runs only when asked for) of every import, importlib's with a literal included."""
    found = []

    def visit(node, lazy):
        if isinstance(node, ast.Import):
            found.extend((alias.name, lazy) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name_of(path)}:{node.lineno} imports relatively; write the whole name"
            # `from treadload import kernels` names the package in the list.
            names = [f"treadload.{a.name}" for a in node.names] if node.module == "treadload" else [node.module]
            found.extend((name, lazy) for name in names)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            found.extend((arg.value, True) for arg in node.args if isinstance(arg, ast.Constant))
        deferred = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            deferred = True
        for child in ast.iter_child_nodes(node):
            visit(child, lazy or deferred)

    visit(ast.parse(path.read_text(encoding="utf-8")), False)
    return found


def own_imports(path):
    return [(name.split(".")[1], lazy) for name, lazy in imports(path) if name.startswith("treadload.")]


def third_party(path):
    return {name.split(".")[0] for name, _ in imports(path)} - {"treadload", "__future__"}


MODULES = [path for path in sources() if package_of(path) != "__init__"]


def test_every_module_has_a_place_in_the_order():
    unknown = {package_of(path) for path in MODULES} - set(STEP) - set(LEAVES)
    assert not unknown, f"say in ORDER where {unknown} stand"


@pytest.mark.parametrize("path", MODULES, ids=name_of)
def test_imports_go_one_way(path):
    package = package_of(path)
    for other, lazy in own_imports(path):
        if other == package or other in LEAVES:
            continue
        assert package not in LEAVES, f"{name_of(path)} is a leaf and imports {other}"
        if STEP[other] < STEP[package]:
            continue
        assert (name_of(path), other) in EXCEPTIONS, f"{name_of(path)} reaches forward to {other}"
        assert lazy, f"{name_of(path)} must import {other} inside the function that needs it"


def test_every_exception_is_still_needed():
    used = {(name_of(path), other) for path in MODULES for other, _ in own_imports(path)}
    assert set(EXCEPTIONS) <= used


@pytest.mark.parametrize("path", [p for p in MODULES if package_of(p) == "kernels"], ids=name_of)
def test_kernels_know_arrays_only(path):
    assert {other for other, _ in own_imports(path)} <= {"kernels"}
    assert third_party(path) - set(sys.stdlib_module_names) <= {"numpy", "scipy"}


@pytest.mark.parametrize("path", MODULES, ids=name_of)
def test_heavy_packages_stay_in_their_room(path):
    for name in third_party(path) & set(ONLY_IN):
        assert package_of(path) in ONLY_IN[name], f"{name_of(path)} imports {name}, which belongs to {ONLY_IN[name]}"


@pytest.mark.parametrize("path", [p for p in MODULES if package_of(p) in ("cli", "app")], ids=name_of)
def test_the_command_line_and_the_app_contain_no_mechanics(path):
    assert not third_party(path) & set(NUMBERS)
    assert not {other for other, _ in own_imports(path)} & {"kernels"}


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
    assert not loaded_after("import treadload.cli") & {"matplotlib", "scipy", "xarray", "trimesh"}


def test_no_public_name_hides_a_module():
    """Importing a submodule sets it on the package: a public function of that name would vanish behind it."""

    modules = {path.stem for path in ROOT.iterdir() if path.suffix == ".py" or path.is_dir()}
    assert not modules & set(treadload.__all__)
