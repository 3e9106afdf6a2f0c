"""Criteria of design in a case: a layer, a law by its name, and what the law's numbers are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from treadload.damage.criteria.design import Criterion as Judge
from treadload.damage.criteria.design import DesignCriterion, Place, usual_layer, usual_place
from treadload.damage.laws.of_layer import OnLayer, law_of_layer
from treadload.errors import InputError, nearest
from treadload.pavement import Pavement
from treadload.read import Choice, Made, guarded, made_by, parameters
from treadload.registry import CRITERIA
from treadload.response import MATERIAL_LENGTH
from treadload.units import Length

STRAIN: Literal["in-plane"] = "in-plane"


class CriterionTable(Made):
    """`[[criteria]]`: name, law, and the layer that it judges.

    name: for tables and figures. layer: its name, or its number from the surface, 1 the top one; left out, the last
    one for laws of the subgrade and the top one for top-down cracking. place: "top" or "bottom"; left out, "top" for
    both of these, else "bottom". strain: "principal" or "in-plane", which it is if left out. mean_over: side of the
    cube of road that an extension near the surface is a mean over; 10 mm if left out. The rest are parameters of the
    law; those left out are taken from the layer where it is one of the catalogue: ε₆, slope, SN, k_c and E(θ) of a
    mix, A and b of a platform.
    """

    @property
    def waits(self) -> bool:
        """True: it is built on a road."""
        return True

    def on(self, road: Pavement) -> Judge:
        """The criterion on a road. Raises InputError."""
        table: Any = self
        assert self.entry is not None
        name, quantity = str(table.name), quantity_of(type(self))
        number = _number(name, table.layer, road, None if quantity is None else usual_layer(quantity))
        law = self._law(OnLayer(name, road, number))
        if hasattr(law, "read"):
            judge: Judge = law
            return judge
        quantity = quantity or law.quantity
        return DesignCriterion(
            name,
            law,
            number,
            table.place or usual_place(quantity),
            table.strain or STRAIN,
            MATERIAL_LENGTH if table.mean_over is None else table.mean_over,
        )

    def _law(self, at: OnLayer) -> Any:
        target = type(self).target
        given = {name: value for name, value in self.given().items() if value is not None}
        taken = parameters(target)
        layer = [name for name, (hint, _) in taken.items() if hint is OnLayer]
        if layer:
            return guarded(self.entry, target, **{layer[0]: at}, **given)
        needed = tuple(name for name, (_, default) in taken.items() if default is ...)
        return guarded(self.entry, law_of_layer, target, at, given, needed)


CRITERION = Choice(
    CRITERIA,
    "criterion",
    more=lambda _: {
        "name": str,
        "layer": int | str,
        "place": Place,
        "strain": Literal["principal", "in-plane"],
        "mean_over": Length,
    },
    needed=("name",),
    lenient=True,
    hidden=(OnLayer,),
    about=CriterionTable.__doc__ or "",
    base=CriterionTable,
)
Criterion = Annotated[Any, CRITERION]


def quantity_of(table: type[Made]) -> str | None:
    """What the law of a criterion reads; None where only the built law can tell."""
    found = (getattr(one, "quantity", None) for one in made_by(table.target))
    return next((one for one in found if isinstance(one, str)), None)


def usual_of(table: Mapping[str, Any]) -> tuple[str | None, int | None]:
    """Place and layer, 0 the top one, that the law of a table of criteria reads; None where it does not tell."""
    kind = CRITERION.table_for(table)
    quantity = None if kind is None else quantity_of(kind)
    return (None, None) if quantity is None else (usual_place(quantity), usual_layer(quantity))


def _number(who: str, asked: int | str | None, road: Pavement, usual: int | None) -> int:
    """Number of the layer from 0 at the surface."""
    names = [layer.name for layer in road.layers]
    listed = ", ".join(f"{number} {name!r}" for number, name in enumerate(names, start=1))
    if asked is None:
        if usual is None:
            raise InputError(f"{who!r}: layer is missing; the road has {listed}")
        return usual % len(names)
    if isinstance(asked, int):
        if not 1 <= asked <= len(names):
            raise InputError(f"{who!r}: no layer {asked}; the road has {listed}")
        return asked - 1
    found = [k for k, name in enumerate(names) if asked.casefold() == name.casefold()]
    if len(found) != 1:
        if found:
            raise InputError(f"{who!r}: several layers have the name {asked!r}; the road has {listed}")
        raise InputError(f"{who!r}: no layer has the name {asked!r}; {nearest(asked, names)}; the road has {listed}")
    return found[0]
