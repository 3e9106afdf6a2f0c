"""Which libraries a command loads before it solves anything: the cost of a cold start."""

import itertools
import json
import subprocess
import sys

import pytest

HEAVY = {
    "h5py",
    "h5netcdf",
    "matplotlib",
    "numpy",
    "pandas",
    "pint",
    "plotly",
    "scipy.optimize",
    "scipy.stats",
    "trimesh",
    "xarray",
}

# In the order of what they may load, so that what a command loads may be seen by those after it, too.
COMMANDS = (
    (["--help"], set()),
    (["--version"], set()),
    (["init"], set()),
    (["init", "life", "-o", "life.toml"], set()),
    (["catalogue"], set()),
    (["criteria"], set()),
    (["schema"], set()),
    (["run", "case.toml", "--dry-run"], {"numpy", "scipy.optimize"}),
)
# One after the other in one process, which writes after each what is loaded.
DRIVER = """
import json, sys
from treadload.cli import main

commands, heavy = json.loads(sys.argv[1])
loaded = []
for arguments in commands:
    sys.argv = ["treadload", *arguments]
    try:
        main()
    except SystemExit as end:
        assert not end.code, end.code
    loaded.append([name for name in heavy if name in sys.modules])
print(json.dumps(loaded), file=sys.stderr)
"""


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    """Heavy modules that are loaded after each command and those before it."""
    commands = json.dumps([[arguments for arguments, _ in COMMANDS], sorted(HEAVY)])
    ran = subprocess.run(
        [sys.executable, "-c", DRIVER, commands],
        cwd=tmp_path_factory.mktemp("commands"),
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    assert ran.returncode == 0, ran.stderr
    return [set(names) for names in json.loads(ran.stderr.splitlines()[-1])]


@pytest.mark.parametrize("number", range(len(COMMANDS)), ids=[" ".join(arguments) for arguments, _ in COMMANDS])
def test_a_command_loads_what_it_needs(number, loaded):
    assert loaded[number] <= COMMANDS[number][1]


def test_commands_that_may_load_less_run_first():
    allowed = [may for _, may in COMMANDS]
    assert all(before <= after for before, after in itertools.pairwise(allowed))


def test_a_loaded_module_is_seen(loaded):
    """The last command reads a case, for which numbers are needed."""
    assert "numpy" in loaded[-1]
