"""Inputs of a report in a person's words: every number with its unit, lists as tables, and a page that prints."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from importlib import resources
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np
import pytest
import xarray as xr

import treadload as tl
import treadload.case
from treadload.case import choices
from treadload.case.criteria import CRITERION
from treadload.read import Table
from treadload.reporting import write_report
from treadload.reporting.inputs import input_lists, input_table
from treadload.reporting.reading import ReportCase
from treadload.reporting.tables import tables_of
from treadload.reporting.words import SHOWN, entries, number, part_of, sentence, units_in, worded
from treadload.rows import Place, Row
from treadload.units import Unit
from treadload.us_units import display_units

LIFE = """
title = "Mixed traffic"
spacing = 0.006
[tire]
profile = "315/80R22.5"
[pavement]
structure = "6 BBSG3 / 15 GB3 / PF3"
[climate]
months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5]
[traffic]
passes_per_year = 60000
growth = 0.02
years = 20
wander = { deviation = 0.25 }
[[traffic.classes]]
name = "front axle"
share = 0.6
axle_load = 130000.0
inflation_pressure = 830000.0
maneuvers = [
    { name = "straight", kind = "straight", share = 0.9 },
    { kind = "turning", radius = 60.0, speed = 9.72222222222222, share = 0.1 },
]
[[traffic.classes]]
name = "trailer"
share = 0.4
wheel_load = 39000.0
inflation_pressure = 1100000.0
friction = { law = "exponential", static = 0.9, kinetic = 0.5, reference_speed = 2.0 }
wheels = [[-1.31, 0.0], [0.0, 0.0], [1.31, 0.0]]
[[criteria]]
name = "base, bottom-up"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
epsilon_6 = 9e-5
[[criteria]]
name = "platform, rutting"
law = "french-subgrade"
[[criteria]]
name = "surface"
law = "fatigue-line"
layer = 1
place = "top"
strain = "principal"
"""


def _case(text: str, label: str = "case") -> ReportCase:
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    layers = [{"name": layer.name} for layer in road.layers]
    return ReportCase(label, {}, {"case": text, "layers": json.dumps(layers)})


def _rows(cases: list[ReportCase]) -> dict[tuple[str, str], tuple[str, tuple[str, ...]]]:
    return {
        (section.heading, row.name): (row.unit, row.values) for section in input_table(cases) for row in section.rows
    }


def _all_parts(base: type[Table] = Table) -> list[type[Table]]:
    # A kind becomes a table when it is first asked for.
    for choice in (CRITERION, *(one for one in vars(choices).values() if isinstance(one, choices.Choice))):
        for name in choice.names():
            choice.table(name)
    return [part for one in base.__subclasses__() for part in (one, *_all_parts(one))]


def _bare_floats(hint: Any, covered: bool = False) -> int:
    """Floats in a type that no unit stands around."""
    if get_origin(hint) is Annotated:
        inner, *marks = get_args(hint)
        return _bare_floats(inner, covered or any(isinstance(mark, Unit) for mark in marks))
    if hint is float:
        return not covered
    if isinstance(hint, type) and issubclass(hint, Table):
        return 0
    return sum(_bare_floats(one, covered) for one in get_args(hint))


def test_every_number_of_every_table_has_a_unit_that_can_be_shown():
    assert treadload.case.Case in _all_parts()
    assert len(_all_parts()) > 35
    # Tests of this process define tables of other packages.
    for part in [part for part in _all_parts() if part.__module__.partition(".")[0] == "treadload"]:
        for key, hint in get_type_hints(part, include_extras=True).items():
            if key in part.model_fields:
                assert _bare_floats(hint) == 0, f"{part.__name__}.{key} has a number without a Unit"
                for symbol in units_in(hint):
                    assert symbol in SHOWN, f"{part.__name__}.{key}: no way to show {symbol!r}"
    # The check itself sees a bare number.
    assert _bare_floats(float | None) == 1


def test_numbers_of_a_life_have_their_units():
    rows = _rows([_case(LIFE)])
    assert rows["Traffic", "load repetitions in the first year"] == ("per year", ("60\u202f000",))
    assert rows["Traffic", "annual growth of the traffic"] == ("%", ("2",))
    assert rows["Traffic", "design life"] == ("years", ("20",))
    assert rows["Traffic", "wander: deviation"] == ("mm", ("250",))
    assert rows["Climate", "temperature, January to December"][0] == "°C"
    assert rows["Computation", "cell size of the grid"] == ("mm", ("6",))
    for (_, name), (unit, values) in rows.items():
        assert unit or not re.search(r"\d", values[0]) or name in ("profile", "structure from the catalogue"), name
        assert "{" not in values[0]
        assert "classe " not in name


def test_axles_and_criteria_are_tables():
    axles, criteria = input_lists([_case(LIFE)])
    assert (axles.heading, criteria.heading) == ("Axles", "Criteria asked for")
    cells = dict(zip(axles.columns, axles.rows[0], strict=True))
    assert cells["name"] == "front axle"
    assert cells["axle load, kN"] == "130"
    assert cells["inflation pressure, kPa"] == "830"
    assert cells["maneuvers"] == "straight: share 90 %; turning: radius 60 m, speed 35 km/h, share 10 %"
    cells = dict(zip(axles.columns, axles.rows[1], strict=True))
    assert cells["wheel load, kN"] == "39"
    # One unit a column, though 1.1 MPa would do by itself.
    assert cells["inflation pressure, kPa"] == "1100"
    assert cells["axle load, kN"] == "–"
    assert cells["wheels, mm"] == "(−1310, 0), (0, 0), (1310, 0)"
    assert cells["coefficient of friction"].startswith("exponential: ")
    assert "reference speed 2 m/s" in cells["coefficient of friction"]

    assert criteria.columns == ("criterion", "law", "layer", "place", "what it reads", "parameters given")
    base, platform, surface = criteria.rows
    plane = "tensile strain in the horizontal plane"
    assert base == (
        "base, bottom-up", "french bituminous", "EB-GB3", "bottom", plane,
        "risk 5 %, ε₆, strain at a million load repetitions 90 microstrain",
    )  # fmt: skip
    # What a law reads by itself is said.
    assert platform == (
        "platform, rutting",
        "french subgrade",
        "PF3",
        "top",
        "vertical strain on the subgrade",
        "those of the layer",
    )
    assert surface[2:5] == ("EB-BBSG3", "top", "three-dimensional tensile strain")


def test_a_criterion_tells_its_law_as_it_was_solved():
    life = xr.Dataset(coords={"criterion": ["platform, rutting", "base, bottom-up", "surface"]})
    life.attrs["laws"] = '["French method, subgrade", "French method, bituminous, risk 5 %", "fatigue line"]'
    case = _case(LIFE)
    told = input_lists([ReportCase("case", {"life": life}, case.attrs)])[1]
    assert [row[1] for row in told.rows] == [
        "French method, bituminous, risk 5 %", "French method, subgrade", "fatigue line",
    ]  # fmt: skip
    # A file of somebody else's does not stop the page.
    for strange in ("no json", '["one"]', "{}"):
        life.attrs["laws"] = strange
        rows = input_lists([ReportCase("case", {"life": life}, case.attrs)])[1].rows
        assert rows[0][1] == "french bituminous"


def test_one_row_holds_a_quantity_of_all_cases():
    text = "[rolling]\nnormal_load = 32500.0\nfriction = 0.7\ntractive_force = {}\n"
    rows = _rows([_case(text.format(force)) for force in ("0.0", "10.0", "10000.0")])
    assert rows["Rolling", "tractive force"] == ("kN", ("0", "0.01", "10"))


def test_words_follow_the_types_of_the_fields():
    hints = get_type_hints(treadload.case.Case, include_extras=True)
    table = {"kind": "prony", "modulus": 10e6, "terms": [[0.7, 0.01], [0.1, 1.0]], "poisson": 0.49}
    tire = part_of(hints["tire"], {"profile": "a", "material": table})
    assert tire is not None
    told = {entry.name: (entry.text, entry.unit) for entry in entries(tire, {"profile": "a", "material": table})}
    assert told["material"] == ("Prony series", "")
    assert told["Young's modulus"] == ("10", "MPa")
    assert told["terms (share, relaxation time)"] == ("(0.7, 0.01 s), (0.1, 1 s)", "")
    # A text that brings its unit keeps it; a key that nobody knows is shown as it is.
    assert worded("3 mm", hints["spacing"]) == ("3 mm", "")
    assert worded(7.0, None) == ("7", "–")
    assert [str(entry) for entry in entries(None, {"strange_key": [1, 2]})] == ["strange key 1, 2"]
    assert sentence(None, {"kind": "wlf", "c": True}) == "WLF: c yes"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.25, "−0.25"),
        (60000.0, "60\u202f000"),
        (1.2e-5, "1.2×10⁻⁵"),
        (5400.0, "5400"),
        (1 / 3, "0.333333"),
    ],
)
def test_numbers_read_as_printed_ones(value, text):
    assert number(value) == text


class _Cells(HTMLParser):
    def __init__(self, html: str) -> None:
        super().__init__()
        self.text: list[str] = []
        self.feed(html)

    def handle_data(self, data: str) -> None:
        self.text.append(data)


@pytest.fixture(scope="module")
def page(tmp_path_factory, page_of_dots) -> str:
    """The report of a small contact built from Python: an inflated tire without a material."""
    x = 5e-3 * (np.arange(24) - 11.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / 0.8
    tire = tl.Tire.from_height_map(gap, 5e-3, inflation_pressure=820e3, name="ball")
    road = tl.Pavement(
        [tl.Layer(tl.Elastic(5.4e9, 0.35), 0.1, "asphalt"), tl.Layer(tl.Elastic(5e7, 0.4), name="soil")]
    )
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=400.0, friction=0.7))
    return page_of_dots([contact], tmp_path_factory.mktemp("words") / "r.html", title="By hand")


def test_a_tire_built_in_python_tells_the_modulus_it_is_solved_with(page):
    modulus = tl.tire.modulus_from_inflation(820e3) / 1e6
    assert f"E = {modulus:.4g} MPa by the inflation pressure, ν = 0.5" in page
    given = tl.Tire.from_height_map(np.ones((2, 2)), 0.1, material=tl.Elastic(3e6, 0.5), inflation_pressure=820e3)
    assert "by the inflation pressure" not in str(given)


def test_the_last_layer_is_semi_infinite(page):
    assert "semi-infinite" in page
    assert "for ever" not in page


@pytest.mark.usefixtures("figures_as_dots")
def test_a_life_is_told_without_code(tmp_path):
    contact = xr.Dataset({"pressure": (("y", "x"), np.ones((3, 3)))}, coords={"x": [0, 1, 2.0], "y": [0, 1, 2.0]})
    tree = xr.DataTree.from_dict({"/": xr.Dataset(attrs={"case": LIFE, "title": "t"}), "/contact": contact})
    html = write_report({"t": tree}, tmp_path / "r.html").read_text(encoding="utf-8")
    # The case as TOML stands in its own box.
    shown = " ".join(_Cells(re.sub(r"(?s)<(pre|style)>.*?</\1>", "", html)).text)
    for code in ("{", "&#39;", "classe ", "axle_load", "french-bituminous", "None"):
        assert code not in shown, code
    assert "Criteria asked for" in shown


def _print_rules() -> dict[str, str]:
    """Rules for paper: selector → declarations."""
    text = resources.files("treadload.reporting").joinpath("template.html.j2").read_text(encoding="utf-8")
    inside = text[text.index("@media print {") : text.index("</style>")]
    inside = re.sub(r"(?s)/\*.*?\*/", "", inside)
    rules: dict[str, str] = {}
    for selectors, declarations in re.findall(r"([^{}]+)\{([^{}]*)\}", inside.split("{", 1)[1]):
        for selector in selectors.split(","):
            rules[selector.strip()] = rules.get(selector.strip(), "") + declarations
    return rules


def test_paper_does_not_scroll_and_keeps_rows_whole():
    rules = _print_rules()
    assert "overflow: visible" in rules[".scroll"]
    assert "overflow: visible" in rules["pre"]
    assert "white-space: pre-wrap" in rules["pre"]
    assert "table-header-group" in rules["thead"]
    for whole in ("tr", "figure", "li", ".card", "h2"):
        assert "break-inside: avoid" in rules[whole], whole
    for held in ("h2", "h3", "tr.group"):
        assert "break-after: avoid" in rules[held], held
    # No column is wider than its words need, so that six of them stand on a page.
    assert "min-width: 0" in rules["td.value"]
    # Three rows of figures on a page, whatever their shape.
    assert "max-height" in rules["figure img"]
    assert "max-height" in rules["figure.wide img"]
    assert "!important" in rules["figure img"]
    # Numbers of references stand left of the text, two digits wide at least.
    padding = re.search(r"padding-left: ([\d.]+)em", rules["ol.references"])
    assert padding is not None
    assert float(padding[1]) >= 2


def test_rows_are_tables_with_their_remarks():
    """Rows of several groups with the same keys: a line a group; others: a line a row; places and notes behind."""
    groups = [
        Row(key, label, 1e-4 * k, "microstrain", ".0f", note=f"at {k}" if key == "b" else "", group=f"step {k}")
        for k in (1, 2)
        for key, label in (("a", "first"), ("b", "second"))
    ]
    alone = [Row("c", "third", -12345.0, "N", ".0f", place=Place(-0.001, 0.0)), Row("d", "fourth", "a-b")]
    several, single = tables_of([*groups, *alone])
    assert several.columns == ("", "first, microstrain", "second, microstrain", "note")
    assert several.rows == (("step 1", "100", "100", "at 1"), ("step 2", "200", "200", "at 2"))
    assert single.rows == (("third", "\u221212345 N", "at x = \u22121.0 mm, y = 0.0 mm"), ("fourth", "a-b", ""))


def test_inputs_of_steps_have_their_units():
    """A case has the tables of its steps as fields that no annotation of its class names."""
    table = {"response": {"depths": [0.0, 0.06]}, "damage": {"fatigue": {"epsilon_6": 1.2e-4, "slope": -0.2}}}
    given = {entry.name: (entry.text, entry.unit) for entry in entries(tl.Case, table)}
    assert given["response: depths"] == ("0, 60", "mm")
    assert given["damage: ε₆, strain at a million load repetitions"] == ("120", "microstrain")


def test_inputs_in_us_units():
    for value, symbol, si, us in (
        (0.2, "m", ("200", "mm"), ("7.874", "in")),
        (820e3, "Pa", ("820", "kPa"), ("118.9", "psi")),
        (5400e6, "modulus", ("5400", "MPa"), ("783.2", "ksi")),
        (15.0, "degC", ("15", "°C"), ("59", "°F")),
        (5.0, "K", ("5", "K"), ("9", "Δ°F")),
        (120e-6, "strain", ("120", "microstrain"), ("120", "microstrain")),
    ):
        annotation = Annotated[float, Unit(symbol)]
        assert worded(value, annotation) == si
        with display_units("us"):
            assert worded(value, annotation) == us
