"""The verdict: where a road cracks first, in which direction, and after how many passes."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import xarray as xr

from treadload import variables
from treadload.composing import BaseResult, Holds, Source
from treadload.damage.cracks import (
    OBLIQUE_TOLERANCE,
    ORIENTATIONS,
    check_tolerance,
    first_to_expect,
    nothing_opens,
    opens_down,
    orientation,
)
from treadload.damage.laws.fatigue import PowerLaw, warnings_of
from treadload.damage.quantity import READINGS, Reading, check_reading
from treadload.damage.reading import Field, check_law, closer, local_field, mean_field, under_both
from treadload.damage.unevaluated import bottoms_without_depth, bright_spot
from treadload.describing import first_line
from treadload.response import MATERIAL_LENGTH
from treadload.response.loads import Load, gather

# A local reading less deep than this, m, feels the cells of the contact.
_FELT = 2 * MATERIAL_LENGTH
# An extension this many times the one that is read is worth a sentence.
_NOTABLE = 1.1


@dataclass(frozen=True, eq=False)
class Verdict(BaseResult, group="damage"):
    """What a fatigue law says of a strain field.

    dataset: fields (y, x) extension_strain, allowable_passes, crack_angle, crack_dip, crack_orientation at the worst
    depth; extension_by_depth (depth), the largest reading of each; scalars worst_*, which stand between the points of
    the fields where the reading is largest there; NaN angle and dip where no crack opens. line: the fatigue law.
    strain: the strain that the verdict reads, "principal" (three-dimensional) or "in-plane" (horizontal plane).
    """

    holds: ClassVar[Holds] = Holds(
        {"depth": "depth", "worst_x worst_y worst_depth worst_strain worst_passes": "",
         "worst_crack_angle worst_crack_dip worst_crack_orientation": ""},
        numbers="largest_principal_strain largest_in_plane_strain largest_unread",
        texts="reading",
        lists="warnings",
        maybe_numbers="coarse_strain coarse_spacing spacing lattices",
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

    def summary(self) -> str:
        """What is read, both strains, the worst point, passes, the orientation of the crack, and a verdict."""
        data = self.dataset
        strain, passes = float(data["worst_strain"]), float(data["worst_passes"])
        depths = ", ".join(f"{1e3 * float(z):g}" for z in data["depth"])
        lines = [
            f"{self.line}, read with the {READINGS[self.strain]} strain, {data.attrs['reading']}, at depth "
            f"{depths} mm",
            f"largest extension, three-dimensional: {data.attrs['largest_principal_strain'] * 1e6:.1f} microstrain",
            f"largest extension, horizontal plane:  {data.attrs['largest_in_plane_strain'] * 1e6:.1f} microstrain",
        ]
        if not strain > 0:
            lines += [*self._lattices(), *(f"warning: {text}" for text in self.warnings)]
            return "\n".join([*lines, f"Verdict: {nothing_opens(float(data.attrs['largest_unread']))}"])
        angle, dip = float(data["worst_crack_angle"]), float(data["worst_crack_dip"])
        against = f"{strain * 1e6:.1f} microstrain is {strain / self.line.at_a_million:.2f} of {self.line.symbol}"
        lines += [
            f"worst point: x = {float(data['worst_x']) * 1e3:.1f} mm, y = {float(data['worst_y']) * 1e3:.1f} mm, "
            f"depth {float(data['worst_depth']) * 1e3:g} mm; {against}",
            _plane_in_words(self.orientation, angle, dip),
            f"allowable passes: {passes:.3g}",
            *self._error_estimate(),
            *self._lattices(),
            *(f"warning: {text}" for text in self.warnings),
        ]
        few = "fewer" if passes < 1e6 else "more"
        lines.append(
            f"Verdict: the {self.line.noun} allows {passes:.2g} passes at the worst point, {few} than a million; "
            f"{first_to_expect(self.orientation)}."
        )
        return "\n".join(lines)

    def _error_estimate(self) -> list[str]:
        """What coarser cells change, where that was asked for, see `treadload.assess_on_two_grids`."""
        about = self.dataset.attrs
        if "coarse_strain" not in about:
            return []
        read = float(self.dataset["worst_strain"])
        cells, wide = (1e3 * float(about[name]) for name in ("spacing", "coarse_spacing"))
        coarse = float(about["coarse_strain"])
        error = abs(coarse - read)
        fewest, most = (self.line.allowable_passes(read + part) for part in (error, -error))
        return [
            f"error estimate: {coarse * 1e6:.1f} microstrain on cells of {wide:g} mm, {read * 1e6:.1f} on cells of "
            f"{cells:g} mm: they differ by {100 * error / read:.2g} %, {fewest:.2g} to {most:.2g} passes",
            "    (no bound: where cells lie at the edges of ribs may do more, see `shifted` of `assess`)",
        ]

    def _lattices(self) -> list[str]:
        """That it reads two lattices of cells, where it does."""
        return [f"read under {under(self.dataset)}"] if self.dataset.attrs.get("lattices") == 2 else []

    __repr__ = first_line


def assess(
    response: Source,
    line: PowerLaw,
    *,
    shifted: Load | Sequence[Load] | None = None,
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
    depths closer to each other; the worst of all is the verdict, which says how deep it is. A response that already
    is a mean is read as it is.
    line: fatigue line or another law that reads an extension; one of the surface reads depth 0 only, one of the
    bottom needs `depth`.
    shifted: the same contact on cells half a cell beside, solved with `offset=(0.5, 0.5)`; of several wheels all. A
    cell is in contact as a whole or not at all, so that the edge of a rib stands up to half a cell from its place:
    outwards on one of two such lattices, inwards on the other. The mean of both loads is read then, which hardly
    depends on where the cells lie.
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
    """
    if strain is not None:
        check_reading(strain)
    check_tolerance(oblique_tolerance)
    check_law(line)
    alone = response
    if shifted is not None:
        response = under_both(response, gather(shifted), depth)
    if depth is None:
        data, said, means = mean_field(response, line, mean_over)
        reading = f"mean over {float(data.attrs['mean_over']) * 1e3:g} mm"
    else:
        data, said, means = local_field(response, line, depth), [], None
        reading = "local, depends on the cells" if depth < _FELT else "local"
    quantity = line.reads if strain is None else line.reads.with_strain(strain)
    field = Field(data, quantity)
    row = field.worst[0]
    deep = float(data["depth"][row])
    found = closer(means, field) if means is not None and field.value[field.worst] > 0 else None
    near, around = (field, field.largest) if found is None else found
    at = near.worst
    if near is not field:
        deep = float(near.data["depth"][at[0]])
        # Fields are drawn at the depth of the response that is nearest to it.
        row = int(np.abs(data["depth"].to_numpy() - deep).argmin())
    opens = bool(near.value[at] > 0)
    angle, dip = (part[0] for part in field.crack_at(slice(row, row + 1)))
    worst_angle, worst_dip = (float(part[at]) for part in near.crack)
    codes = orientation(np.append(angle, worst_angle), np.append(dip, worst_dip), oblique_tolerance)
    dims, none = ("y", "x"), ()
    passes = line.allowable_passes(field.value[row])
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "extension_strain": (dims, field.extension[row]),
        "allowable_passes": (dims, passes),
        "crack_angle": (dims, angle),
        "crack_dip": (dims, dip),
        "crack_orientation": (dims, codes[:-1].reshape(dip.shape)),
        "extension_by_depth": (("depth",), field.value.max(axis=(1, 2))),
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
        said.append(
            f"the largest extension, {unread * 1e6:.1f} microstrain, lies where no principal stress is tensile: no "
            f"crack opens there, and it is not read; it would allow {float(line.allowable_passes(unread)):.2g} passes"
        )
    evaluated = float(near.value[at]) if opens else 0.0
    said += bright_spot(alone, quantity.strain, evaluated, data.attrs.get("mean_over"))
    said += bottoms_without_depth(alone)
    dataset = variables.dataset(
        fields,
        {"depth": data["depth"].to_numpy(), "y": data["y"].to_numpy(), "x": data["x"].to_numpy()},
        depth=float(data["depth"][row]),
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
        warnings=json.dumps([*said, *warnings_of(line, near.value[at])], ensure_ascii=False),
    )
    return Verdict(dataset, line, quantity.strain)


def under(data: xr.Dataset) -> str:
    """The contacts that a verdict reads, in words, see `shifted` of `assess`. data: of a `Verdict`."""
    if data.attrs.get("lattices") == 2:
        return "the mean of two contacts whose cells lie half a cell apart"
    return "one contact"


def _plane_in_words(name: str, angle: float, dip: float) -> str:
    if not opens_down(name):
        return f"split: closer to horizontal than to vertical, as when layers separate (dip {math.degrees(dip):.0f}°)"
    side = "right" if angle > 0 else "left"
    turned = f"{abs(math.degrees(angle)):.0f}° from travel" + (f" to the {side}" if name == "oblique" else "")
    return f"crack: {name}, its trace {turned}, its plane {math.degrees(dip):.0f}° from the horizontal"
