"""Results that are broken: in memory, as the report gets them, and as files, down to their bytes."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import random
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

import h5py
import numpy as np
import xarray as xr
from PIL import Image

import treadload.reporting.pictures
from cases import BASE_AND_SOIL
from fuzz.corpus import TABLES
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.case import Case
from treadload.reporting import write_report
from treadload.results import open_results, save_results
from treadload.steps import run

# One in so many is a file, has figures, has them drawn: a drawing takes a second, the rest of a report a twentieth.
FILES, FIGURES, DRAWN = 12, 10, 60

_TEXTS = ("", " ", "nan", "[]", "{}", "[1]", '["a"]', '{"a": []}', "null", "9" * 5000, "[" * 3000, "\x00", "a\nb",
          "m", "mm", "kPa", "Pa", "1", "days since 2000-01-01", "é", "x = 1", "[rolling]\nfriction = []")  # fmt: skip
_NUMBERS = (0, -1, 1, 2, 7, 1e300, -1e300, 1e-300, math.nan, math.inf, -math.inf, 2**62)


def attack(rng: random.Random, folder: Path) -> str:
    """Break a result and ask for its report: a page, or one sentence."""
    if rng.randrange(FILES):
        base = rng.choice(_bases())
        attrs: Any = dict(base.attrs)
        groups = {str(name): node.to_dataset() for name, node in base.children.items()}
        for _ in range(rng.choice((1, 1, 1, 2, 3))):
            attrs, groups = _break(rng, attrs, groups)
        tree = _of(attrs, groups)
        answer = ask(lambda: _report(rng, tree, folder))
    else:
        path = folder / "result.nc"
        path.write_bytes(rng.choice(_files()))
        rng.choice((_break_file, _break_file, _break_bytes))(rng, path)
        answer = ask(lambda: _opened(rng, path, folder))
    return REFUSED if isinstance(answer, Refusal) else TAKEN


@functools.cache
def _blank() -> Image.Image:
    """A picture of one point, in place of a figure that takes a second."""
    return Image.new("RGB", (1, 1))


def _report(rng: random.Random, tree: xr.DataTree, folder: Path) -> None:
    path = folder / "report.html"
    with contextlib.ExitStack() as stack:
        if rng.randrange(FIGURES):
            nothing = mock.Mock(return_value=[])
            stack.enter_context(mock.patch.object(treadload.reporting.pictures, "picture", nothing))
        elif rng.randrange(DRAWN // FIGURES):
            blank = mock.Mock(return_value=_blank())
            stack.enter_context(mock.patch.object(treadload.reporting.pictures, "raster", blank))
        write_report({"broken": tree}, path)
    page = path.read_text(encoding="utf-8")
    if "</html>" not in page:
        raise WrongAnswer("the page is not whole")
    # A page says what a figure lacks; that a program fell over is no answer.
    fell = re.search(r"could not be drawn: (\w+), [^<]*", page)
    if fell:
        raise WrongAnswer(fell[0])


def _opened(rng: random.Random, path: Path, folder: Path) -> None:
    """Open a file, make its parts, report them."""
    results = open_results(path)
    for name in results:
        # A part that cannot be made says so; the others are still there.
        ask(lambda name=name: results[name].summary())
    _report(rng, results.tree, folder)


def prepare() -> None:
    """Solve the cases whose results are to be broken."""
    _files()


_SMALL = """
title = "small"
{spacing}
{tire}
[pavement]
temperature = 20
frequency = "10 Hz"
[[pavement.layers]]
name = "wearing course"
thickness = "60 mm"
mix = "EB-BBSG3"
[[pavement.layers]]
mix = "PF3"
{load}
[response]
depths = ["0 mm", "60 mm"]
slice_depth = "80 mm"
[damage]
fatigue = {{ epsilon_6 = "90 microstrain", slope = -0.2 }}
"""
_COARSE = """
spacing = "24 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
[[pavement.layers]]
material = { modulus = "5400 MPa", poisson = 0.35 }
[rolling]
normal_load = "32.5 kN"
friction = 0.7
tractive_force = "5 kN"
[response]
depths = ["0 mm", "20 mm"]
[damage]
fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }
"""
_LIFE = (
    """
spacing = "24 mm"
tire = { profile = "315/80R22.5" }
climate = { temperature = 15 }
[pavement]
structure = "6 BBSG3 / 15 GB3 / PF3"
[traffic]
passes_per_year = 1e5
years = 20
[[traffic.classes]]
name = "front"
share = 1
axle_load = "70 kN"
inflation_pressure = "8 bar"
"""
    + BASE_AND_SOIL
)


@functools.cache
def _bases() -> list[xr.DataTree]:
    """Results of small cases: a tire, a recorded footprint on a road with what a viscoelastic one adds, a life."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in TABLES.items():
            (folder / file).write_bytes(content)
        footprint = '[footprint]\nfile = "footprint.csv"\nspacing = "40 mm"\nmissing = "zero"\nnoise = 10'
        slow = _SMALL.format(spacing="", tire="", load=footprint)
        return [
            _small(run(Case.from_text(_COARSE)).to_tree()),
            _rolled(_small(run(Case.from_text(slow, folder=folder)).to_tree())),
            _small(run(Case.from_text(_LIFE)).to_tree()),
        ]


def _small(tree: xr.DataTree) -> xr.DataTree:
    """The tree with the variables of a response that a report reads: all others are as these, and cost time."""
    groups = {str(name): node.to_dataset() for name, node in tree.children.items()}
    for name in ("response", "slice_along", "slice_across", "bowl"):
        if name in groups:
            groups[name] = groups[name][[one for one in _READ if one in groups[name]]]
    return _of(tree.attrs, groups)


def _rolled(tree: xr.DataTree) -> xr.DataTree:
    """The tree with a speed and energies, which to solve for takes longer than thousands of attacks."""
    groups = {str(name): node.to_dataset() for name, node in tree.children.items()}
    for name in set(groups) & {"response", "slice_along", "slice_across", "bowl"}:
        energy = (("depth", "y"), np.ones((groups[name].sizes["depth"], groups[name].sizes["y"])), {"units": "J/m^3"})
        groups[name] = groups[name].assign(dissipated_energy=energy).assign_attrs(speed=20.0)
    return _of(tree.attrs, groups)


def _of(attrs: Any, groups: dict[str, xr.Dataset]) -> xr.DataTree:
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=attrs), **{f"/{name}": groups[name] for name in groups}})


@functools.cache
def _files() -> list[bytes]:
    """Files of a part of the same each: a reader takes milliseconds for every variable."""
    with tempfile.TemporaryDirectory() as folder:
        return [
            save_results(
                _of(tree.attrs, {name: tree[name].to_dataset() for name in part}), Path(folder) / "result.nc"
            ).read_bytes()
            for tree in _bases()
            for part in _PARTS
            if set(part) <= set(tree.children)
        ]


# Without what they were asked, as earlier versions wrote them, and with it.
_PARTS = (("contact", "response"), ("slice_along", "damage"), ("life",), ("contact", "asked"), ("response", "asked"),
          ("damage", "asked"), ("life", "asked"))  # fmt: skip
_READ = ("principal_strain_1", "principal_direction_1", "in_plane_strain_1", "in_plane_angle_1", "displacement_z",
         "dissipated_energy", "stress_zz")  # fmt: skip


def _break(rng: random.Random, attrs: Any, groups: dict[str, xr.Dataset]) -> tuple[Any, dict[str, xr.Dataset]]:
    """One break of a tree in memory, of its attributes or its groups."""
    names = sorted(groups)
    which = rng.randrange(10)
    if which == 0 or not names:
        return _broken_attrs(rng, attrs), groups
    group = rng.choice(names)
    if which == 1:
        return attrs, {name: groups[name] for name in names if name != group}
    if which == 2 and len(names) > 1:
        other = rng.choice([name for name in names if name != group])
        return attrs, {**groups, group: groups[other], other: groups[group]}
    return attrs, {**groups, group: _broken_group(rng, groups[group])}


def _broken_attrs(rng: random.Random, attrs: Any) -> dict[Any, Any]:
    attrs = dict(attrs)
    if not attrs:
        return attrs
    name = rng.choice(sorted(attrs))
    which = rng.randrange(5)
    if which == 0:
        del attrs[name]
    elif which == 1:
        attrs[name] = rng.choice(_TEXTS)
    elif which == 2:
        attrs[name] = rng.choice(_NUMBERS)
    elif which == 3 and isinstance(attrs[name], str) and attrs[name]:
        at = rng.randrange(len(attrs[name]))
        attrs[name] = attrs[name][:at] + rng.choice(("", "[", "0", '"', "\n", "x", "-")) + attrs[name][at + 1 :]
    elif isinstance(attrs[name], str):
        try:
            held = json.loads(attrs[name])
        except ValueError:
            held = []
        attrs[name] = json.dumps(_broken_json(rng, held))
    else:
        attrs[name] = np.array(rng.choice(([], [1.0, 2.0], [[1.0]], ["a", "b"])))
    return attrs


def _broken_json(rng: random.Random, held: Any) -> Any:
    if isinstance(held, list) and held:
        at = rng.randrange(len(held))
        changed = _broken_json(rng, held[at])
        return rng.choice((held[:at], held + held, [*held[:at], changed, *held[at + 1 :]]))
    if isinstance(held, dict) and held:
        key = rng.choice(sorted(held))
        return rng.choice(({k: v for k, v in held.items() if k != key}, {**held, key: _broken_json(rng, held[key])}))
    return rng.choice((None, [], {}, "x", 1, -1, 1e300, True, [[]], {"modulus": "a"}, math.nan))


def _broken_group(rng: random.Random, data: xr.Dataset) -> xr.Dataset:
    if not data.variables:  # an earlier break took the last
        return data
    name = str(rng.choice(sorted(map(str, data.variables))))
    field, dims = data[name], sorted(map(str, data.dims))
    dim = rng.choice(dims) if dims else "x"
    which = rng.randrange(13)
    if which <= 1:
        return data.drop_vars(name)
    if which == 2:
        return data.assign_attrs(_broken_attrs(rng, data.attrs)) if rng.random() < 0.8 else data.drop_attrs()
    if which == 3:
        return data.isel({dim: slice(0, rng.choice((0, 0, 1, 2)))}) if dims else data
    if which == 4:
        return data.isel({dim: 0}, drop=rng.random() < 0.5) if dims and data.sizes[dim] else data
    if which == 5:
        return data.isel({dim: slice(None, None, -1)}) if dims else data
    if which == 6:
        return data.rename({name: rng.choice(("odd", "pressure", "x", "state"))}) if _free(data, name) else data
    if which == 7:
        kind = rng.choice((str, object, complex, bool, "datetime64[ns]", "float32", "int64"))
        with np.errstate(all="ignore"):
            values = np.nan_to_num(field.to_numpy()) if field.dtype.kind == "f" else field.to_numpy()
            try:
                return data.assign({name: (field.dims, values.astype(kind), field.attrs)})
            except (TypeError, ValueError):
                return data
    if which == 8:
        unit = rng.choice(("mm", "kPa", "m", "Pa", "1", "", "odd", 3, "days since 2000-01-01"))
        return data.assign({name: (field.dims, field.to_numpy(), {"units": unit})})
    if which == 9 and field.size and field.ndim:
        return data.assign({name: field.isel({field.dims[0]: 0}, drop=True).variable}) if name not in dims else data
    if which == 10 and name not in dims:
        further = next(one for one in ("other", "another", "a third", "a fourth") if one not in field.dims)
        return data.assign({name: ((further, *field.dims), field.to_numpy()[None])})
    if which == 11 and field.ndim > 1:
        return data.assign({name: field.transpose(*field.dims[::-1]).variable})
    values = np.array(field.to_numpy())
    if values.dtype.kind not in "fi" or not values.size:
        return data
    values = values.astype(float)
    spot = rng.choice((..., tuple(rng.randrange(n) for n in values.shape)))
    values[spot] = rng.choice(_NUMBERS)
    return data.assign({name: (field.dims, values, field.attrs)})


def _free(data: xr.Dataset, name: str) -> bool:
    return name not in data.dims and not {"odd", "pressure", "x", "state"} & set(map(str, data.variables)) - {name}


def _break_bytes(rng: random.Random, path: Path) -> None:
    content = bytearray(path.read_bytes())
    if rng.random() < 0.3:
        path.write_bytes(content[: rng.randrange(len(content))])
        return
    for _ in range(rng.choice((1, 5, 100))):
        # The first part of the file holds its structure.
        content[rng.randrange(rng.choice((2000, len(content))))] = rng.randrange(256)
    path.write_bytes(content)


def _break_file(rng: random.Random, path: Path) -> None:
    """One break of the file itself, as other programs leave it."""
    with h5py.File(path, "r+") as file:
        nodes: list[Any] = []
        file.visititems(lambda _, node: nodes.append(node))
        node = rng.choice(nodes)
        change: Callable[[], None] = rng.choice(
            (
                lambda: node.parent.pop(node.name.split("/")[-1]),
                lambda: _odd_attribute(rng, rng.choice((file, node))),
                lambda: node.attrs.clear(),
                lambda: _replaced(rng, node),
                *([lambda: _asked_otherwise(rng, file["asked"])] * 3 if "asked" in file else []),
            )
        )
        change()


def _asked_otherwise(rng: random.Random, group: Any) -> None:
    """Break what the parts were asked."""
    told = json.loads(group.attrs["questions"])
    for _ in range(rng.choice((1, 1, 3))):
        told = _broken_json(rng, told)
    group.attrs["questions"] = json.dumps(told)


def _odd_attribute(rng: random.Random, node: Any) -> None:
    name = rng.choice([*node.attrs, "units", "scale_factor", "_FillValue", "coordinates", "calendar", "grid_mapping"])
    odd = rng.choice((*_TEXTS[:6], b"\xff\xfe", 3, 1.5, math.nan, [1, 2], np.zeros(0), h5py.Empty("f")))
    if not (isinstance(odd, str) and "\x00" in odd):
        node.attrs[name] = odd


def _replaced(rng: random.Random, node: Any) -> None:
    name, parent = node.name.split("/")[-1], node.parent
    parent.pop(name)
    parent[name] = rng.choice((
        np.zeros(0), np.zeros((2, 2)), np.array(["a", "b"], dtype="S1"), 1.0, "text", np.zeros((1, 1, 1, 1)),
        np.zeros(2, [("a", "f8"), ("b", "i4")]), np.array([True, False]), np.array(1 + 2j),
    ))  # fmt: skip
