"""Examples in docstrings of public names hold."""

import ast
import doctest
import importlib
import shutil
import sys
import time
from types import ModuleType

import numpy as np
import pytest

import treadload as tl
from texts import CLONE

DATA = CLONE / "tests" / "data"
SUBPACKAGES = [name for name in tl.__all__ if isinstance(getattr(tl, name), ModuleType)]
# Constants: numbers, texts, tables and unions of classes have no docstring of their own.
CONSTANTS = {
    "tl.__version__",
    "tl.damage.AGGRESSIVENESS",
    "tl.damage.LEUTNER_MINIMUM",
    "tl.damage.RISK",
    "tl.materials.Material",
    "tl.materials.RoadMaterial",
    "tl.materials.Solid",
    "tl.pavement.QUOTED_STIFFNESS",
    "tl.response.MATERIAL_LENGTH",
}
# What takes seconds to solve and cannot be opened from a file of a few kilobytes; pages of the docs show it.
COSTLY = {
    "tl.footprint.FittedFormula": "a fit to forty solves of a tire",
    "tl.footprint.FootprintSet": "eight cases of a study or more",
    "tl.life.predict_sections": "a service life for each section of a table",
    "tl.plots.tir_fit": "a fit to forty solves of a tire",
    "tl.tire.ScanQuality": "a scan of a tire",
}
# Files that examples open: results that take ten seconds to solve (see SOURCE.md there), and a file of a tire.
PREPARED = (
    DATA / "examples" / "field_bench.nc",
    DATA / "examples" / "pitch.nc",
    DATA / "tir" / "invented_6_1.tir",
)


def public_objects():
    """Public objects by name, each once, by the shortest way to it."""
    names = {}
    for place, module in (("tl", tl), *((f"tl.{name}", getattr(tl, name)) for name in SUBPACKAGES)):
        for name in module.__all__:
            thing = getattr(module, name)
            if not isinstance(thing, ModuleType):
                names.setdefault(id(thing), (f"{place}.{name}", thing))
    return dict(names.values())


def examples():
    """Public objects whose docstrings have an example, by name."""
    return {
        name: thing for name, thing in public_objects().items() if ">>>" in (getattr(thing, "__doc__", None) or "")
    }


@pytest.fixture(scope="module")
def documented():
    return examples()


def test_public_names_have_examples(documented):
    assert public_objects().keys() - documented.keys() == CONSTANTS | COSTLY.keys()
    assert all(not callable(public_objects()[name]) for name in CONSTANTS)


class Runner:
    """Runs docstrings as a user would type them, in an empty folder; beginnings that they share run once.

    What is shared are assignments of names: a docstring that changes an object in place is run alone from there on.
    """

    def __init__(self):
        self.report = []
        self.seconds = {}
        self._parser = doctest.DocTestParser()
        self._runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        self._names_after = {}

    def run(self, name, docstring, names):
        """Run a docstring. names: that it may use besides those that it assigns."""
        begun = time.process_time()
        test = self._parser.get_doctest(docstring, names, name, None, 0)
        assert test.examples, f"{name} has no example"
        names, lines, shared = dict(names), (), True
        for example in test.examples:
            lines += (example.source,)
            shared = shared and assigns_names(example.source)
            if shared and lines in self._names_after:
                names = dict(self._names_after[lines])
                continue
            step = doctest.DocTest([example], names, name, None, 0, docstring)
            self._runner.run(step, out=self.report.append, clear_globs=False)
            names = step.globs
            if shared:
                self._names_after[lines] = dict(names)
        self.seconds[name] = time.process_time() - begun


def assigns_names(line):
    """True for a statement that gives values to names, and changes no object in place."""
    (statement,) = ast.parse(line).body
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return True
    if not isinstance(statement, ast.Assign):
        return False
    targets = [leaf for target in statement.targets for leaf in ast.walk(target)]
    return not any(isinstance(leaf, ast.Subscript | ast.Attribute) for leaf in targets)


def test_examples_of_public_names_hold(documented, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in PREPARED:
        shutil.copy(path, tmp_path)
    runner = Runner()
    for name, thing in documented.items():
        runner.run(name, thing.__doc__, {"tl": tl, "folder": tmp_path})
    assert not runner.report, "".join(runner.report)


def test_examples_of_methods_hold(monkeypatch):
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(CLONE / "docs" / "_ext"))
    for name in ("treadload.tire.belt", "treadload.tire.tread", "treadload.tire.grooves", "treadload.us_units"):
        module = importlib.import_module(name)
        assert module is sys.modules[name]
        done = doctest.testmod(module, extraglobs={"tl": tl}, optionflags=doctest.NORMALIZE_WHITESPACE)
        assert done.attempted
        assert not done.failed, name


@pytest.mark.slow
def test_the_prepared_results_are_those_of_today():
    lugs = (tl.tire.LateralGrooves(0.06, 0.006, 0.016),)
    tread = tl.tire.TreadProfile(0.3, 0.4, 0.06, lateral=lugs)
    belt = tl.tire.Belt(tread=tl.Elastic(4e6, 0.49), tread_thickness=0.024, arm=0.024)
    tire = tl.Tire.from_profile(tread, inflation_pressure=300e3, belt=belt)
    road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=500.0, friction=0.7)
    passage = tl.contact.solve_pitch(tire, road, wheel, positions=4, spacing=0.01, periodic=0.05)
    bench = tl.life.field_bench("LTPP")
    for solved, kept in (
        (passage, tl.open_results(PREPARED[1]).pitch),
        (bench, tl.open_results(PREPARED[0]).field_bench),
    ):
        assert set(solved.dataset.data_vars) == set(kept.dataset.data_vars)
        for name, values in solved.dataset.data_vars.items():
            if values.dtype.kind == "f":
                # Fits and iterations end within their tolerances, which another processor may reach elsewhere; forces
                # that balance are round-off of the load of 500 N, of the order of 1e-14 N.
                size = np.nanmax(np.abs(np.where(np.isfinite(values), values, 0.0)), initial=0.0)
                least = max(1e-3 * size, 1e-12)
                np.testing.assert_allclose(values, kept.dataset[name], rtol=1e-3, atol=least, err_msg=name)
