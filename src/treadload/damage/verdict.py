"""The assessment: where a road cracks first, in which direction, and after how many passes."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Columns, Holds, Source
from treadload.damage.answer import Answer, fatigue_answer
from treadload.damage.border import border_in_words, evaluated_further
from treadload.damage.cracks import (
    OBLIQUE_TOLERANCE,
    ORIENTATIONS,
    check_tolerance,
    in_a_cell,
    opens_down,
    orientation,
)
from treadload.damage.laws.conditions import conditions_of
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.laws.validity import warnings_of
from treadload.damage.quantity import READINGS, Reading, check_reading
from treadload.damage.reading import Field, check_law, local_field, mean_field, under_both
from treadload.damage.rib_sides import filled_ribs
from treadload.damage.two_grids import COARSER, cell_of, coarser, shifted_loads
from treadload.damage.unevaluated import bottoms_without_depth, bright_spot
from treadload.damage.worst_point import closer, unsearched
from treadload.deferred import xarray as xr
from treadload.response import MATERIAL_LENGTH
from treadload.response.loads import Load, gather
from treadload.rows import Place, Row, row
from treadload.units import repetitions_in_words

# A local reading less deep than this, m, feels the cells of the contact.
_FELT = 2 * MATERIAL_LENGTH
# An extension this many times the one that is read is worth a sentence.
_NOTABLE = 1.1
_LARGEST = ("largest_principal_strain", "largest_in_plane_strain")


@dataclass(frozen=True, eq=False)
class Verdict(BaseResult, group="damage"):
    """The assessment of a strain field by a fatigue law.

    dataset: fields (y, x) extension_strain, allowable_passes, crack_angle, crack_dip, crack_orientation at the worst
    depth; extension_by_depth (depth), the largest reading of each; scalars worst_*, which stand between the points of
    the fields where the reading is largest there; NaN angle and dip where no crack opens. line: the fatigue law.
    strain: the strain that the assessment reads, "principal" (three-dimensional) or "in-plane" (horizontal plane).

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[-0.05, 0.0, 0.05], y=[0.0])
    >>> result = tl.assess(response, tl.FatigueLine(120e-6, -0.2), depth=0.15)
    >>> f"{float(result.dataset.worst_passes):.2g} load repetitions, then a {result.orientation} crack"
    '1.8e+04 load repetitions, then a transverse crack'
    """

    columns: ClassVar[Columns] = Columns("Fatigue and cracks")
    title: ClassVar[str] = "Fatigue"
    holds: ClassVar[Holds] = Holds(
        {"depth": "depth", "worst_x worst_y worst_depth worst_strain worst_passes": "",
         "worst_crack_angle worst_crack_dip worst_crack_orientation": ""},
        maybe={"extension_strain allowable_passes crack_angle crack_dip crack_orientation": "y x"},
        finite="worst_x worst_y worst_depth worst_strain",
        bounded="extension_strain",
        above_zero="allowable_passes worst_passes",
        positive="epsilon_6",
        codes={"crack_orientation": 5, "worst_crack_orientation": 5},
        tree="x y worst_strain worst_passes worst_x worst_y worst_depth worst_crack_orientation",
        numbers="largest_principal_strain largest_in_plane_strain largest_unread",
        texts="reading",
        lists="warnings",
        maybe_numbers="coarse_strain coarse_spacing spacing lattices epsilon_6 slope depth oblique_tolerance",
        together=("coarse_strain coarse_spacing spacing",),
    )  # fmt: skip

    dataset: xr.Dataset
    line: PowerLaw
    strain: str

    def __post_init__(self) -> None:
        check_reading(self.strain)

    @property
    def orientation(self) -> str:
        """Orientation of the crack at the worst point, in a word of `ORIENTATIONS`."""
        return ORIENTATIONS[int(self.dataset["worst_crack_orientation"])]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user: what is not read, numbers of the law without a source, extrapolation."""
        return tuple(json.loads(self.dataset.attrs["warnings"]))

    def rows(self) -> tuple[Row, ...]:
        """The evaluated value, both tensile strains, the worst point and its crack, load repetitions, the result."""
        line = self.line
        *before, verdict = rows_of(self.dataset, str(line), self.strain, line.at_a_million)
        return (*before, *self._error_estimate(), row("law_conditions", conditions_of(line)), verdict)

    @property
    def answer(self) -> Answer:
        """Allowable load repetitions, or that the law does not govern; the worst point, direction and cause."""
        return fatigue_answer(self.dataset, self.rows())

    def _error_estimate(self) -> list[Row]:
        """What coarser cells change, where that was asked for, see `treadload.assess`."""
        about, strain = self.dataset.attrs, float(self.dataset["worst_strain"])
        if "coarse_strain" not in about or not strain > 0:
            return []
        cells, wide = (1e3 * float(about[name]) for name in ("spacing", "coarse_spacing"))
        coarse = float(about["coarse_strain"])
        error = abs(coarse - strain)
        fewest, most = (repetitions_in_words(self.line.allowable_passes(strain + part)) for part in (error, -error))
        note = (
            f"cells of {wide:g} mm in place of {cells:g} mm, a difference of {100 * error / strain:.2g} %; no bound: "
            f"the grid offset may change more, see `shifted` of `assess`; load repetitions: {fewest} to {most}"
        )
        return [row("coarse_strain", coarse, note=note)]


def rows_of(data: xr.Dataset, law: str, strain_read: str, at_a_million: float) -> tuple[Row, ...]:
    """Rows of an assessment.

    data: its dataset, or the group of a file. law: in words. strain_read: "principal" or "in-plane". at_a_million:
    strain that the law allows a million times.
    """
    about, strain = data.attrs, float(data["worst_strain"])
    depths = ", ".join(f"{1e3 * float(z):g}" for z in np.atleast_1d(data["depth"].to_numpy()))
    what = f"{READINGS[strain_read]} strain, {about.get('reading', 'local')}, at depth {depths} mm"
    rows = [
        row("law", law),
        row("evaluation", what),
        row("contacts_evaluated", under(data)),
        *(row(name, float(about.get(name, math.nan))) for name in _LARGEST),
    ]
    if strain > 0:
        rows += _worst_rows(data, strain, at_a_million)
    return (*rows, row("verdict", fatigue_answer(data, rows).sentence))


def _worst_rows(data: xr.Dataset, strain: float, at_a_million: float) -> list[Row]:
    """Rows of the worst point and its crack."""
    x, y, depth, passes = (float(data[f"worst_{name}"]) for name in ("x", "y", "depth", "passes"))
    word = ORIENTATIONS[int(data["worst_crack_orientation"])]
    return [
        row("worst_strain", strain, place=Place(x, y, depth)),
        row("strain_ratio", strain / at_a_million),
        row("worst_crack_orientation", in_a_cell(word), label="" if opens_down(word) else "plane"),
        *_plane(word, float(data["worst_crack_angle"]), float(data["worst_crack_dip"])),
        row("worst_passes", passes),
    ]


def _plane(word: str, angle: float, dip: float) -> list[Row]:
    """How a crack lies. angle: of its trace, dip: of its plane, rad."""
    trace = [row("worst_crack_angle", angle, note="positive to the right")] if opens_down(word) else []
    return [*trace, row("worst_crack_dip", dip, note="from the horizontal")]


def assess(
    response: Source,
    line: PowerLaw,
    *,
    shifted: Load | Sequence[Load] | Literal[True] | None = None,
    error_estimate: bool = False,
    depth: float | None = None,
    strain: Reading | None = None,
    mean_over: float = MATERIAL_LENGTH,
    oblique_tolerance: float = OBLIQUE_TOLERANCE,
) -> Verdict:
    """Where and in which direction a road cracks under repeated passes of a load.

    A crack opens across the largest extension: its plane is perpendicular to that direction, and its trace
    on the surface is perpendicular to the direction's horizontal projection. None opens where no principal stress is
    tensile; such points are not read.

    response: of `solve_response` on a grid. Its road is solved again for means over a cube of `mean_over`, m, at each
    of its depths that lies in the top layer, to which the line applies, and around the worst of them on points and at
    depths closer to each other; the worst of all is the result, with its depth. Points further apart than `mean_over`
    get others between them first, up to 50 000; a warning states where they stay further apart. A response that
    already is a mean is read as it is. Within 50 mm of the surface the basin around the loads is evaluated as well,
    on few points and as far as it reaches; deeper down the field is solved further where the largest of the map
    lies at its end, or no crack opens in it, until the largest lies inside. The larger of map and basin is the
    result; a
    warning states the place if it is beyond the map, or that the largest still lies at the end.
    line: fatigue line or another law that reads an extension; one of the surface reads depth 0 only, one of the
    bottom needs `depth`.
    shifted: True solves the contacts of the response once more, on cells half a cell beside, and reads both; where
    they are not its own, those contacts, solved with `offset=(0.5, 0.5)`, of several wheels all. A
    cell is in contact as a whole or not at all, so that the edge of a rib stands up to half a cell from its place:
    outwards on one of two such lattices, inwards on the other. The mean of both loads is read then, which hardly
    depends on where the cells lie.
    error_estimate: True also solves the contacts on cells twice as large, and the summary states by how much the
    reading differs: the error of the finer ones where that is of first order, three times that where it is of second.
    Both are left out by default: each solves a contact again, which takes longer than all that an assessment does
    besides, and a response that was opened from a file or measured has no contact to solve.
    depth: one of the response's depths, m, whose points are read as they are; a response from elsewhere, with
    principal_strain_1, principal_direction_1, in_plane_strain_1 and in_plane_angle_1 over (depth, y, x), needs it.
    Such a local reading has no limit under finer cells near the surface: at the edges of ribs and at the rear of the
    slip zone the exact field has roots and logarithms.
    strain: "in-plane" reads the largest extension in the horizontal plane, whose cracks are vertical; "principal"
    that in space, whose cracks near the surface are usually vertical where the road bends, and otherwise split the
    road parallel to its surface; left out, what the line reads, by custom the plane.
    oblique_tolerance: rad, in (0, π/4]. A trace within it of the direction of travel is longitudinal, within
    it of across transverse, else oblique; a plane nearer to the horizontal than 45° is horizontal.
    Returns a Verdict. Raises InputError for an unknown depth, strain or tolerance, for a law that reads something
    else, for a response without its road, and for a shifted contact of a response that is local or a mean already.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> at = [-0.05, 0.0, 0.05]
    >>> plate = tl.UniformDisc(0.15, 700e3)
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=at, y=at, side="above")
    >>> result = tl.assess(response, tl.FatigueLine(epsilon_6=120e-6, slope=-0.2), depth=0.15)
    >>> f"{float(result.dataset.worst_strain) * 1e6:.0f} microstrain"
    '269 microstrain'
    """
    if strain is not None:
        check_reading(strain)
    check_tolerance(oblique_tolerance)
    check_law(line)
    coarse = None
    if error_estimate:
        both: Literal[True] | None = None if shifted is None else True
        coarse = assess(coarser(response), line, shifted=both, depth=depth, strain=strain, mean_over=mean_over)
    alone = response
    if shifted is True:
        shifted = shifted_loads(response)
    if shifted is not None:
        response = under_both(response, gather(shifted), depth)
    if depth is None:
        data, caveats, means = mean_field(response, line, mean_over, alone)
        reading = f"mean over {float(data.attrs['mean_over']) * 1e3:g} mm"
    else:
        data, caveats, means = local_field(response, line, depth), [], None
        reading = "local, depends on the cells" if depth < _FELT else "local"
    quantity = line.reads if strain is None else line.reads.with_strain(strain)
    field = Field(data, quantity)
    level = field.worst[0]
    deep = float(data["depth"][level])
    closer_values = None if means is None else closer(means, field)
    near, around = (field, field.largest) if closer_values is None else closer_values
    further, beyond = evaluated_further(response, field, means)
    near = near if further is None or not further.most > near.most else further
    at = near.worst
    if near is not field:
        deep = float(near.data["depth"][at[0]])
        # Fields are drawn at the depth of the response that is nearest to it.
        level = int(np.abs(data["depth"].to_numpy() - deep).argmin())
    opens = bool(near.value[at] > 0)
    angle, dip = (part[0] for part in field.crack_at(slice(level, level + 1)))
    worst_angle, worst_dip = (float(part[at]) for part in near.crack)
    codes = orientation(np.append(angle, worst_angle), np.append(dip, worst_dip), oblique_tolerance)
    dims, none = ("y", "x"), ()
    by_depth = field.value.max(axis=(1, 2))
    passes = line.allowable_passes(field.value[level])
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "extension_strain": (dims, field.extension[level]),
        "allowable_passes": (dims, passes),
        "crack_angle": (dims, angle),
        "crack_dip": (dims, dip),
        "crack_orientation": (dims, codes[:-1].reshape(dip.shape)),
        "extension_by_depth": (("depth",), by_depth if beyond is None else np.fmax(by_depth, beyond.by_depth)),
        "worst_x": (none, float(near.data["x"][at[2]])),
        "worst_y": (none, float(near.data["y"][at[1]])),
        "worst_depth": (none, deep),
        "worst_strain": (none, float(near.value[at])),
        "worst_passes": (none, float(line.allowable_passes(float(near.value[at])))),
        "worst_crack_angle": (none, worst_angle),
        "worst_crack_dip": (none, worst_dip),
        "worst_crack_orientation": (none, codes[-1]),
    }
    largest = {name: max(value, around[name]) for name, value in field.largest.items()}
    unread = float(field.extension.max())
    if opens and unread > _NOTABLE * float(near.value[at]):
        caveats.append(
            f"the largest tensile strain, {unread * 1e6:.1f} microstrain, lies where no principal stress is tensile: "
            "no crack opens there, and it is not evaluated; it would allow "
            f"{float(line.allowable_passes(unread)):.2g} load repetitions"
        )
    evaluated = float(near.value[at]) if opens else 0.0
    caveats += bright_spot(alone, quantity.strain, evaluated, data.attrs.get("mean_over"))
    caveats += border_in_words(alone, field, beyond)
    caveats += [] if means is None else unsearched(field)
    caveats += bottoms_without_depth(alone)
    caveats += filled_ribs(alone, data["depth"].to_numpy())
    dataset = variables.dataset(
        fields,
        {"depth": data["depth"].to_numpy(), "y": data["y"].to_numpy(), "x": data["x"].to_numpy()},
        depth=float(data["depth"][level]),
        reading=reading,
        **{name: data.attrs[name] for name in ("mean_over",) if depth is None},
        strain=quantity.strain,
        law=str(line),
        epsilon_6=line.at_a_million,
        slope=line.exponent,
        oblique_tolerance=oblique_tolerance,
        **({} if shifted is None else {"lattices": 2}),
        largest_principal_strain=largest["principal_strain_1"],
        largest_in_plane_strain=largest["in_plane_strain_1"],
        largest_unread=unread,
        warnings=json.dumps([*caveats, *warnings_of(line, near.value[at])], ensure_ascii=False),
    )
    verdict = Verdict(dataset, line, quantity.strain)
    return verdict if coarse is None else with_error(verdict, coarse, cell_of(alone))


def with_error(verdict: Verdict, coarse: Verdict, spacing: float) -> Verdict:
    """An assessment on cells of `spacing`, m, that states what it reads on coarser ones."""
    about = {
        "spacing": spacing,
        "coarse_spacing": COARSER * spacing,
        "coarse_strain": float(coarse.dataset["worst_strain"]),
    }
    return replace(verdict, dataset=verdict.dataset.assign_attrs(about))


def under(data: xr.Dataset) -> str:
    """The contacts that an assessment reads, in words, see `shifted` of `assess`. data: of a `Verdict`."""
    if data.attrs.get("lattices") == 2:
        return "the mean of two contacts whose grids are offset by half a cell"
    return "one contact"
