"""What later rooms offer of a result: found when it is asked for, and not before."""

import pytest

from treadload import accessors
from treadload.accessors import found_in, offered, offers


class Slab:
    pass


class Thick(Slab):
    pass


@pytest.fixture(autouse=True)
def _nothing_stays(monkeypatch):
    monkeypatch.setattr(accessors, "_OFFERS", dict(accessors._OFFERS))
    monkeypatch.setattr(accessors, "_ROOMS", dict(accessors._ROOMS))


def test_an_offer_is_made_of_the_result_that_asks_and_of_its_subclasses():
    offers("weight", "Slab")(lambda slab: ("weight of", slab))
    slab, thick = Slab(), Thick()
    assert offered("weight", slab) == ("weight of", slab)
    assert offered("weight", thick) == ("weight of", thick)
    # The nearest class counts, whichever was offered first.
    offers("weight", "Thick")(lambda slab: "more")
    assert offered("weight", thick) == "more"
    assert offered("weight", slab) == ("weight of", slab)


def test_the_room_is_entered_when_it_is_first_asked_for():
    entered = []

    def enter():
        entered.append("weight")
        offers("weight", "Slab")(lambda slab: 1)

    found_in("weight", enter)
    assert not entered
    assert [offered("weight", Slab()) for _ in range(3)] == [1, 1, 1]
    assert entered == ["weight"]


def test_what_nobody_offers_is_no_attribute():
    with pytest.raises(AttributeError, match="'Slab' has no 'weight'"):
        offered("weight", Slab())
    offers("weight", "Slab")(lambda slab: 1)
    with pytest.raises(AttributeError, match="'int' has no 'weight'"):
        offered("weight", 3)


def test_one_offer_may_serve_several_kinds():
    @offers("weight", "Slab", "int")
    def weigh(thing):
        return type(thing).__name__

    assert (offered("weight", Slab()), offered("weight", 3)) == ("Slab", "int")
