"""Design criteria in a case: a layer, a law by its name, and what the law's numbers are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from treadload.damage.criterion import Criterion as Judge
from treadload.damage.laws.of_layer import Law, OnLayer, law_of_layer
from treadload.damage.quantity import Place, Quantity, Reading
from treadload.errors import InputError, nearest
from treadload.pavement import Pavement
from treadload.pavement.roles import ROLES, lacks_role, layer_of_role
from treadload.read import As, Choice, TargetTable, guarded, made_by, parameters
from treadload.registry import CRITERIA
from treadload.response import MATERIAL_LENGTH
from treadload.units import Length

_READS = As(Quantity)


class CriterionTable(TargetTable):
    """`[[criteria]]`: name, law, and the layer that it assesses.

    name: for tables and figures. layer: its name, or its number from the surface, 1 the top one, or its role, "top
    layer", "lowest asphalt layer", "lowest cement-bound layer" or "subgrade", whichever layer has it on a road; left
    out, the last one for laws of the subgrade and the top one for top-down cracking. place: "top" or "bottom", or
    "interface" for the bond below the layer; left out, the usual one of what is read: "top" for both of these, else
    "bottom". reads: a quantity by its name, or a table with its numbers, for laws with the user's numbers; those of
    published laws hold for what they read. strain: of a tensile strain, "principal" or "in-plane", the
    default. mean_over: side of the cube of road that an extension near the surface is a mean over; 10 mm if left out.
    search_to: how far below the top of its layer the largest reading is looked for; only at the top if left out. The
    rest are parameters of the law; those left out are taken from the layer where it is one of the catalogue: ε₆,
    slope, SN, k_c and E(θ) of a mix, A and b of a platform.
    """

    @property
    def waits(self) -> bool:
        """True: it is built on a road."""
        return True

    def on(self, road: Pavement) -> Judge:
        """The criterion on a road. Raises InputError."""
        table: Any = self
        assert self.entry is not None
        name, quantity = str(table.name), self.quantity
        number = _number(name, table.layer, road, None if quantity is None else quantity.where.layer)
        law = self._law(OnLayer(name, road, number))
        if isinstance(law, Judge):
            return law
        length = MATERIAL_LENGTH if table.mean_over is None else table.mean_over
        # A law that leaves open what it reads has taken `reads` itself.
        reads = None if "reads" in self.hints else quantity if self.states_quantity else None
        return Judge(name, law, number, table.place, table.strain, length, reads, table.search_to)

    @property
    def states_quantity(self) -> bool:
        """True if the table states the quantity that the law reads."""
        table: Any = self
        return table.reads is not None

    @property
    def quantity(self) -> Quantity | None:
        """What is read: as the table states it, or its law; None where only the built law determines it."""
        table: Any = self
        if self.states_quantity:
            quantity: Quantity = _READS.build(table.reads)
            return quantity
        reads = (getattr(kind, "reads", None) for kind in made_by(type(self).target))
        return next((quantity for quantity in reads if isinstance(quantity, Quantity)), None)

    def _law(self, at: OnLayer) -> Judge | Law:
        target = type(self).target
        arguments = {name: value for name, value in self.arguments().items() if value is not None}
        taken = parameters(target)
        layer = [name for name, (hint, _) in taken.items() if hint is OnLayer]
        if layer:
            law: Judge | Law = guarded(self.entry, target, **{layer[0]: at}, **arguments)
            return law
        needed = tuple(name for name, (_, default) in taken.items() if default is ...)
        law = guarded(self.entry, law_of_layer, target, at, arguments, needed)
        return law


CRITERION = Choice(
    CRITERIA,
    "criterion",
    more=lambda _: {
        "name": str,
        "layer": int | str,
        "place": Place,
        "strain": Reading,
        "reads": Quantity,
        "mean_over": Length,
        "search_to": Length,
    },
    needed=("name",),
    lenient=True,
    hidden=(OnLayer,),
    about=CriterionTable.__doc__ or "",
    base=CriterionTable,
)
Criterion = Annotated[Any, CRITERION]


def is_of_absent(criterion: CriterionTable, road: Pavement, absent: Mapping[int, str]) -> bool:
    """True of a criterion whose layer a road does not have because it is absent.

    absent: names of the absent layers by their numbers in the table of the case, from 0.
    """
    table: Any = criterion
    if not absent or table.layer is None:
        return False
    if isinstance(table.layer, int):
        return table.layer - 1 in absent
    wanted = table.layer.casefold().strip()
    if any(wanted == layer.name.casefold() for layer in road.layers):
        return False
    return wanted in {name.casefold() for name in absent.values()} or lacks_role(road, wanted)


def without_absent(criterion: CriterionTable, absent: Mapping[int, str]) -> CriterionTable:
    """The criterion with its layer's number, if it has one, counted without the absent layers above."""
    table: Any = criterion
    if not absent or not isinstance(table.layer, int):
        return criterion
    above = sum(number < table.layer - 1 for number in absent)
    return criterion.model_copy(update={"layer": table.layer - above})


def quantity_of(table: Mapping[str, object]) -> Quantity | None:
    """What a table of criteria reads; None where it does not state it."""
    kind = CRITERION.table_for(table)
    if kind is None:
        return None
    try:
        read: Any = kind.model_validate({key: table[key] for key in ("name", "law", "reads") if key in table})
        quantity: Quantity | None = read.quantity
    except ValueError:
        return None
    return quantity


def _number(criterion: str, wanted: int | str | None, road: Pavement, usual: int | None) -> int:
    """Number of the layer from 0 at the surface."""
    names = [layer.name for layer in road.layers]
    listed = ", ".join(f"{number} {name!r}" for number, name in enumerate(names, start=1))
    if wanted is None:
        if usual is None:
            raise InputError(f"{criterion!r}: layer is missing; the road has {listed}")
        return usual % len(names)
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(names):
            raise InputError(f"{criterion!r}: no layer {wanted}; the road has {listed}")
        return wanted - 1
    matches = [k for k, name in enumerate(names) if wanted.casefold() == name.casefold()]
    if len(matches) != 1:
        if matches:
            raise InputError(f"{criterion!r}: several layers have the name {wanted!r}; the road has {listed}")
        role = layer_of_role(road, wanted)
        if role is not None:
            return role
        raise InputError(
            f"{criterion!r}: no layer has the name {wanted!r}; {nearest(wanted, [*names, *ROLES])}; the road has "
            f"{listed}"
        )
    return matches[0]
