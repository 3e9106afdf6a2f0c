"""Examples in docstrings of public names hold."""

import ast
import doctest
import importlib
import sys
import time
from types import ModuleType

import pytest

import treadload as tl
from texts import CLONE

SUBPACKAGES = [name for name in tl.__all__ if isinstance(getattr(tl, name), ModuleType)]


def examples():
    """Public objects whose docstrings have an example, by name."""
    found = {}
    for place, module in (("tl", tl), *((f"tl.{name}", getattr(tl, name)) for name in SUBPACKAGES)):
        for name in module.__all__:
            thing = getattr(module, name)
            if not isinstance(thing, ModuleType) and ">>>" in (getattr(thing, "__doc__", None) or ""):
                found.setdefault(id(thing), (f"{place}.{name}", thing))
    return dict(found.values())


@pytest.fixture(scope="module")
def documented():
    return examples()


def test_names_at_the_top_have_examples(documented):
    names = {name for name in documented if name.count(".") == 1}
    assert {"tl.Elastic", "tl.Pavement", "tl.FatigueLine", "tl.solve_response", "tl.assess", "tl.Case"} <= names
    # Of all public names; the number may grow.
    assert len(documented) >= 250


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
