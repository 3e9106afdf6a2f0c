"""Changes of the road by one step: a thicker layer, another mix, an interface that is bonded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from treadload.damage.criterion import Criterion
from treadload.errors import InputError, nearest
from treadload.life.design import Design
from treadload.life.remedy.changes import Change, NotApplicable, Remedy
from treadload.life.remedy.steps import RemedySteps
from treadload.life.stiffer import names_of, stiffer
from treadload.materials import HydraulicMix, Mix, StressDependent, Unbound, UnboundByStress
from treadload.materials.kinds import AnyElastic
from treadload.materials.library import mixes
from treadload.materials.mixture import RoadMaterial
from treadload.pavement import BONDED, Pavement

# Temperature at which moduli of mixes are compared, °C: that at which the French method classes them.
_COMPARED = 15.0
# First letters of the French names of mixes: of wearing courses, of bases; of platforms and of graded aggregate.
_USES = (("BB",), ("GB", "EME"), ("PF",), ("GNT",))


def thicker_layers(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Every layer that has a thickness, thicker by the step."""
    for number, (name, layer) in enumerate(zip(names_of(design.road), design.road.layers, strict=True)):
        if layer.thickness is None:
            continue
        title = f"{steps.thickness * 1e2:g} cm more {name}"
        try:
            thicker = design.with_thickness(number, layer.thickness + steps.thickness)
        except InputError as error:
            yield NotApplicable(title, str(error))
            continue
        yield Remedy(title, "thickness", thicker, number)


def other_mixes(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Every layer of the catalogue of a neighbouring mix; every other one stiffer, asphalt softer, too."""
    names = names_of(design.road)
    stray = next((name for name in steps.mixes if name not in names), None)
    if stray is not None:
        raise InputError(f"mixes names the layer {stray!r}; {nearest(stray, names)}")
    for number, (name, layer) in enumerate(zip(names, design.road.layers, strict=True)):
        material = layer.material
        if name in steps.mixes:
            yield _with_material(design, number, mixes[steps.mixes[name]])
        elif isinstance(material, Mix | HydraulicMix | Unbound) and material.name in mixes:
            for neighbour in neighbours(material):
                yield _with_material(design, number, neighbour)
        elif isinstance(material, Mix | AnyElastic | StressDependent):
            soil = number == len(names) - 1 or isinstance(material, Unbound | StressDependent)
            for sign, word in ((1.0, "stiffer"), (-1.0, "softer"))[: 1 if soil else 2]:
                road = stiffer(design.road, number, 1 + sign * steps.modulus)
                yield _on_road(design, road, number, f"{name} {100 * steps.modulus:g} % {word}")
        else:
            yield NotApplicable(f"another mix for {name}", "it is viscoelastic or plastic, and has no one modulus")


def neighbours(material: RoadMaterial) -> tuple[RoadMaterial, ...]:
    """The next stiffer material of the catalogue with the same use and, for mixes, the next softer one.

    By modulus at 15 °C, among equals by ε₆. A use is a wearing course (BB...), a bituminous base (GB, EME), treated
    material, a platform or graded aggregate. One that has a fatigue line has only neighbours that have one. A softer
    subgrade or aggregate is not a remedy and is left out.
    """
    use, rank = _use(material), _rank(material)
    alike = [candidate for candidate in mixes.values() if _use(candidate) == use]
    if getattr(material, "epsilon_6", None) is not None:
        alike = [candidate for candidate in alike if getattr(candidate, "epsilon_6", None) is not None]
    above = [candidate for candidate in alike if _rank(candidate) > rank]
    below = [candidate for candidate in alike if _rank(candidate) < rank and not isinstance(material, Unbound)]
    next_stiffer, next_softer = (
        [choose(candidates, key=_rank)] if candidates else [] for choose, candidates in ((min, above), (max, below))
    )
    return (*next_stiffer, *next_softer)


def bonded_interfaces(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Every interface that is not fully bonded, bonded."""
    road, names = design.road, names_of(design.road)
    loose = [k for k, layer in enumerate(road.layers[:-1]) if layer.bond != BONDED]
    if not loose:
        yield NotApplicable("bonding an interface", "every interface of the road is fully bonded already")
    for number in loose:
        layers = list(road.layers)
        layers[number] = replace(layers[number], bond=BONDED)
        changed = Pavement(layers, rigid_base=road.rigid_base)
        yield _on_road(
            design, changed, number, f"{names[number]} bonded to {names[number + 1]}", "bond", compare_laws=False
        )


def _use(material: RoadMaterial) -> str:
    if isinstance(material, HydraulicMix):
        return "treated"
    short = material.name.removeprefix("EB-")
    words = next((first for first in _USES if short.startswith(first)), None)
    return f"{type(material).__name__} {words or short}"


def _rank(material: RoadMaterial) -> tuple[float, float]:
    solid = material.nominal if isinstance(material, UnboundByStress) else material
    modulus = solid.modulus(_COMPARED) if isinstance(solid, Mix) else solid.modulus
    strength: float | None = getattr(material, "epsilon_6", getattr(material, "sigma_6", None))
    return round(float(modulus)), 0.0 if strength is None else float(strength)


def _with_material(design: Design, number: int, material: RoadMaterial) -> Change:
    """The design with another material in a layer, which keeps its name: criteria name layers by it."""
    layers = list(design.road.layers)
    name, before = names_of(design.road)[number], layers[number].material
    layers[number] = replace(layers[number], material=material)
    title = f"{material.name} in place of {getattr(before, 'name', '') or name}"
    return _on_road(design, Pavement(layers, rigid_base=design.road.rigid_base), number, title)


def _on_road(
    design: Design, road: Pavement, number: int, title: str, kind: str = "mix", *, compare_laws: bool = True
) -> Change:
    try:
        changed = design.on_road(road)
        for criterion in changed.criteria:
            criterion.depth(road)
    except InputError as error:
        return NotApplicable(title, str(error))
    alike = _with_the_same_law(design, changed, number) if compare_laws else []
    remark = (
        f"{title}: the law of {' and '.join(alike)} is the same as before, so that the stiffness of the layer alone "
        "counts"
        if alike
        else ""
    )
    return Remedy(title, "bond" if kind == "bond" else "mix", changed, number, remark=remark)


def _with_the_same_law(before: Design, after: Design, number: int) -> list[str]:
    """Names of criteria of a layer whose law did not change with its material."""

    def law(criterion: Criterion) -> object:
        return criterion.law_at(_COMPARED)

    pairs = zip(before.criteria, after.criteria, strict=True)
    return [old.name for old, new in pairs if new.number(after.road) == number and law(old) == law(new)]
