"""Examples in docstrings of public names hold."""

import doctest
import importlib
import sys
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


def test_examples_of_public_names_hold(documented, tmp_path):
    report = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    for name, thing in documented.items():
        test = doctest.DocTestParser().get_doctest(thing.__doc__, {"tl": tl, "folder": tmp_path}, name, None, 0)
        assert test.examples
        runner.run(test, out=report.append)
    assert not report, "".join(report)


def test_examples_of_methods_hold(monkeypatch):
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(CLONE / "docs" / "_ext"))
    for name in ("treadload.tire.belt", "treadload.tire.tread", "treadload.tire.grooves", "treadload.us_units"):
        module = importlib.import_module(name)
        assert module is sys.modules[name]
        done = doctest.testmod(module, extraglobs={"tl": tl}, optionflags=doctest.NORMALIZE_WHITESPACE)
        assert done.attempted
        assert not done.failed, name
