"""Pages are registered: ours, those of other packages, and a sentence in place of one that is broken."""

from typing import ClassVar

import pytest

pytest.importorskip("nicegui")

from treadload import registry
from treadload.app.page_frame import Page
from treadload.app.pages import BrokenPage, registered_pages
from treadload.registry import PAGES


class TirePage(Page):
    """A page of another package."""

    address: ClassVar[str] = "/tires"
    title: ClassVar[str] = "tires"


class TakenPage(Page):
    """A page at an address of ours."""

    address: ClassVar[str] = "/life"
    title: ClassVar[str] = "another life"


class Point:
    """An entry point of a package."""

    dist = type("Dist", (), {"name": "my-pages", "version": "1.0"})

    def __init__(self, name, target):
        self.name, self.target, self.group, self.value = name, target, PAGES.group, f"my_pages:{name}"

    def load(self):
        if self.target is None:
            raise ModuleNotFoundError("No module named 'gone'")
        return self.target


@pytest.fixture
def brought(monkeypatch):
    """Say which pages packages bring."""
    real = registry.declared_points

    def bring(**targets):
        points = tuple(Point(name, target) for name, target in targets.items())
        monkeypatch.setattr(
            registry, "declared_points", lambda group, path: points if group == PAGES.group else real(group, path)
        )

    return bring


def test_ours_are_registered():
    assert [page.address for page in registered_pages()] == ["/", "/life", "/study", "/network", "/basins"]
    assert [page.command for page in registered_pages()] == ["run", "life", "", "", ""]
    assert set(PAGES.built_in()) == {"bench", "life", "study", "network", "basins"}


def test_a_page_of_another_package_stands_beside_ours(brought):
    brought(tires=TirePage)
    assert [page.title for page in registered_pages()] == ["the bench", "life", "study", "network", "basins", "tires"]


@pytest.mark.parametrize(
    ("target", "words"), [(None, "No module named 'gone'"), (dict, "must be a class"), (TakenPage, "'/life'")]
)
def test_a_broken_page_is_named_and_stops_nothing(brought, target, words):
    brought(tires=TirePage, another=target)
    *pages, broken = registered_pages()
    assert {page.address for page in pages} == {"/", "/life", "/study", "/network", "/basins", "/tires"}
    assert issubclass(broken, BrokenPage)
    assert broken.address == "/broken-another"
    assert "my-pages 1.0" in broken.problem
    assert words in broken.problem


def test_two_packages_with_one_name_are_named(brought):
    brought(life=TirePage)
    *pages, broken = registered_pages()
    assert [page.address for page in pages] == ["/", "/life", "/study", "/network", "/basins"]
    assert "my-pages 1.0" in broken.problem
