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


@pytest.fixture
def another_package(monkeypatch):
    """One with an entry point of a group that no registry reads and keeps."""
    points = metadata.EntryPoints([metadata.EntryPoint("stribeck", "my_laws:Stribeck", "treadload.trials")])
    monkeypatch.setattr(metadata, "entry_points", lambda **group: points.select(**group))


@pytest.mark.parametrize(
    ("name", "computes", "found"),
    [
        ("criteria", "_criteria", "computed"),
        ("catalogue", "_shelf", ["computed"] * len(listings.SHELVES)),
        ("tables", "_tables", "computed"),
    ],
)
def test_all_is_computed_where_another_package_brings_something(name, computes, found, monkeypatch, another_package):
    monkeypatch.setattr(listings, computes, lambda *_: "computed")
    assert getattr(listings, name)() == found


def test_of_several_packages_only_those_that_are_asked_for_are_loaded(monkeypatch, another_package):
    asked = []
    monkeypatch.setattr(listings, "_shelf", asked.append)
    listings.catalogue(["mixes"])
    assert asked == ["mixes"]
    for name in ("_shelf", "_criteria"):
        monkeypatch.setattr(listings, name, lambda *_: pytest.fail("loaded"))
    assert "source" in listings.about("mixes", "BBSG3")
    assert listings.criterion("limit").splitlines()[0] == "limit"
