"""Tables of materials, in a case and in files of published ones: the kind, its numbers, and how its times shift."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, cast

from treadload.materials.kinds import Material, TemperatureDependent
from treadload.materials.temperature import Shiftable, Thermorheological
from treadload.read import Choice, TargetTable, made_by
from treadload.registry import MATERIALS, SHIFTS
from treadload.units import Celsius


def _tested(law: object, table: TargetTable, folder: Path) -> tuple[object, tuple[float, float] | None]:
    """A law of shift, and the temperatures of the tests behind it, °C."""
    return law, getattr(table, "tested", None)


SHIFT = Choice(
    SHIFTS,
    "shift",
    more=lambda _: {"tested": tuple[Celsius, Celsius]},
    finish=_tested,
    about="tested: lowest and highest temperature of the tests behind it.",
)


def shift_of(target: Callable[..., object]) -> Mapping[str, object]:
    """Times of a viscoelastic material may shift with temperature."""
    viscoelastic = any(hasattr(kind, "complex_modulus") for kind in made_by(target) if isinstance(kind, type))
    # A protocol stands for a material of which the maker knows more.
    concrete = not any(getattr(kind, "_is_protocol", False) for kind in made_by(target))
    return {"shift": Annotated[Any, SHIFT]} if viscoelastic and concrete else {}


def shifted(material: Material, table: TargetTable, folder: Path) -> Material | TemperatureDependent:
    """The material, or one that waits for its temperature."""
    shift = getattr(table, "shift", None)
    shifted_material: Material | TemperatureDependent = material
    return (
        shifted_material
        if shift is None
        else Thermorheological(cast("Shiftable", material), *SHIFT.build(shift, folder))
    )


ROAD_MATERIAL = Choice(
    MATERIALS,
    "material of a road",
    more=shift_of,
    finish=shifted,
    about="shift: how its times depend on temperature; without it the material is the same at all temperatures.",
)
