"""What commands list from files of the package is what they would compute."""

import subprocess
import sys
from importlib import metadata

import pytest

from treadload.cli import listings

# In a process of its own: tests of this one register laws of theirs.
COMPARE = """
from treadload.cli.listings import FOLDER, computed, text_of

files = {path.stem: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.json")}
contents = computed()
assert set(files) == set(contents), set(files) ^ set(contents)
stale = [name for name, content in contents.items() if files[name] != text_of(content)]
assert not stale, f"{stale} out of date; run: python -m treadload.cli.listings"
"""


def test_files_are_what_is_computed():
    ran = subprocess.run([sys.executable, "-c", COMPARE], capture_output=True, text=True, encoding="utf-8")
    assert ran.returncode == 0, ran.stderr.splitlines()[-1]


@pytest.mark.parametrize("name", ["criteria", "catalogue", "tables"])
def test_all_is_computed_where_another_package_brings_something(name, monkeypatch):
    point = metadata.EntryPoint("stribeck", "my_laws:Stribeck", "treadload.friction")
    monkeypatch.setattr(metadata, "entry_points", lambda: metadata.EntryPoints([point]))
    monkeypatch.setattr(listings, f"_{name}", lambda: f"computed {name}")
    assert getattr(listings, name)() == f"computed {name}"
