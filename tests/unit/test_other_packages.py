"""Things that another package brings: each is one thing of one file there, and no file is touched here.

The package is a real one on the path, with the metadata that an installer would write.
"""

import ast
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE, ONE_AXLE
from packages import build, forget
from tire_meshes import tire_mesh, write
from treadload.case import Case
from treadload.case.schema import json_schema
from treadload.errors import InputError
from treadload.registry import ALL, BONDS, COMPARISONS, CRITERIA, FRICTION, MATERIALS, PLASTICITY, READERS
from treadload.reporting.words import entries

FRICTION_LAW = '''
"""Rubber that loses grip under pressure."""
from dataclasses import dataclass

import numpy as np

from treadload.contact.friction import FrictionLaw
from treadload.errors import InputError
from treadload.units import Number, Pressure


@dataclass(frozen=True)
class Yielding(FrictionLaw):
    """Friction that falls on a straight line with pressure.

    unloaded: μ without pressure, > 0. yield_pressure: at which nothing is left. least: share that stays.
    """

    unloaded: Number
    yield_pressure: Pressure
    least: Number = 0.1
    base: FrictionLaw | None = None

    def __post_init__(self):
        if not self.unloaded > 0:
            raise InputError(f"unloaded must be > 0, got {self.unloaded:g}")

    @property
    def largest(self):
        return self.unloaded * (1 if self.base is None else self.base.largest)

    def coefficient(self, at):
        left = np.maximum(1 - at.pressure / self.yield_pressure, self.least)
        return self.unloaded * left * (1 if self.base is None else self.base.coefficient(at))

    def __str__(self):
        return f"{self.unloaded:g} falling to nothing at {self.yield_pressure / 1e3:g} kPa"
'''

MATERIALS_OF_THEIRS = '''
"""Soil by its bearing ratio, and a standard linear solid."""
from dataclasses import dataclass

import numpy as np

from treadload.materials import Elastic, Prony
from treadload.units import Modulus, Number, Share, Time


def soil(cbr: Share, poisson: Number = 0.4) -> Elastic:
    """Soil by its bearing ratio, 17.6 MPa CBR^0.64 (Powell et al. 1984).

    cbr: bearing ratio, 5 % is 0.05. poisson: Poisson's ratio.
    """
    return Elastic(17.6e6 * (100 * cbr) ** 0.64, poisson)


@dataclass(frozen=True)
class Zener:
    """Two springs and a dashpot.

    fast, slow: moduli of fast and slow loading. time: of relaxation. poisson: Poisson's ratio.
    """

    fast: Modulus
    slow: Modulus
    time: Time
    poisson: Number

    @property
    def glassy(self):
        return Elastic(self.fast, self.poisson)

    @property
    def rubbery(self):
        return Elastic(self.slow, self.poisson)

    def complex_modulus(self, omega):
        turn = 1j * np.asarray(omega) * self.time
        return self.slow + (self.fast - self.slow) * turn / (1 + turn)

    @property
    def prony(self):
        return Prony(self.fast, ((1 - self.slow / self.fast, self.time),), self.poisson)

    def slowed(self, factor):
        return Zener(self.fast, self.slow, self.time * factor, self.poisson)


def nothing() -> Elastic:
    return "not a material"


def bare(modulus, poisson: Number) -> Elastic:
    return Elastic(modulus, poisson)
'''

CRITERIA_OF_THEIRS = '''
"""A fatigue law of a test track, and a criterion that reads what it likes."""
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from treadload.damage import Criterion, FatigueLine, OnLayer, PowerLaw
from treadload.units import Number, Strain


@dataclass(frozen=True)
class Track(PowerLaw):
    """Passes to the first crack on the track.

    epsilon_6: strain of a million passes. power: of the strain, > 0. stiffening: factor on the strain.
    """

    epsilon_6: Strain
    power: Number
    stiffening: Number = 1.0

    reads = FatigueLine.reads
    source: ClassVar[str] = "the track"
    end_of_life: ClassVar[str] = "the first crack"

    @property
    def at_a_million(self):
        return self.epsilon_6 * self.stiffening

    @property
    def exponent(self):
        return -1 / self.power

    def __str__(self):
        return f"test track, power {self.power:g}"


@dataclass(frozen=True)
class Doubled(Criterion):
    """Reads twice the extension."""

    def read(self, data):
        return 2 * super().read(data)


def doubled(at: OnLayer, epsilon_6: Strain | None = None) -> Doubled:
    """A criterion of its own: twice the extension at the bottom of the layer.

    epsilon_6: strain of a million passes.
    """
    return Doubled(at.name, FatigueLine(epsilon_6, -0.2), at.number, "bottom")
'''

BOND_LAW = '''
"""Tack coats that soften as they warm up."""
from dataclasses import dataclass

from treadload.errors import InputError
from treadload.pavement import Bond, BondLaw
from treadload.units import Celsius, Kelvin, Stiffness


@dataclass(frozen=True)
class TackCoat(BondLaw):
    """A bond whose stiffness halves with every so many kelvin.

    at_reference: stiffness at the reference. halving: rise of temperature that halves it. reference: temperature.
    """

    at_reference: Stiffness
    halving: Kelvin
    reference: Celsius = 20.0

    @property
    def stiffness(self):
        raise InputError("this bond waits for its temperature; use Pavement.at_temperature")

    @property
    def depends_on_temperature(self):
        return True

    def at(self, temperature):
        return Bond(self.at_reference * 2 ** ((self.reference - temperature) / self.halving))

    def __str__(self):
        return "tack coat"
'''

READER = '''
"""Meshes of a laboratory, as NumPy archives in a file of its own ending."""
import numpy as np


def read(path):
    with np.load(path) as archive:
        return archive["points"], archive["triangles"]
'''

ENTRY_POINTS = """
[treadload.friction]
yielding = road_laws.friction:Yielding
torn = road_laws.nowhere:Torn
number = road_laws.criteria:__doc__

[treadload.materials]
soil = road_laws.materials:soil
zener = road_laws.materials:Zener
nothing = road_laws.materials:nothing
bare = road_laws.materials:bare

[treadload.criteria]
track = road_laws.criteria:Track
doubled = road_laws.criteria:doubled

[treadload.bonds]
tack-coat = road_laws.bonds:TackCoat

[treadload.readers]
lab = road_laws.reader:read
"""


@pytest.fixture
def road_laws(tmp_path, monkeypatch):
    folder = tmp_path / "site"
    build(
        folder,
        "road_laws",
        ENTRY_POINTS,
        friction=FRICTION_LAW,
        materials=MATERIALS_OF_THEIRS,
        criteria=CRITERIA_OF_THEIRS,
        bonds=BOND_LAW,
        reader=READER,
    )
    monkeypatch.syspath_prepend(str(folder))
    yield folder
    forget("road_laws")


def case_of(old, new):
    assert old in COARSE_CASE
    return COARSE_CASE.replace(old, new)


def said(text, kind=Case):
    with pytest.raises(InputError) as refused:
        kind.from_text(text)
    message = str(refused.value)
    assert "\n" not in message
    return message


def kinds_in(schema, key):
    """Words that tell tables apart anywhere in a schema."""
    text = json.dumps(schema)
    return {word.split('"')[0] for word in text.split(f'"{key}": {{"const": "')[1:]}


YIELDING = 'friction = { law = "yielding", unloaded = 1.2, yield_pressure = "2 MPa" }'


def test_a_friction_law_is_one_file_of_theirs(road_laws):
    case = Case.from_text(case_of("friction       = 0.7", YIELDING))
    assert Case.from_text(case.to_toml()) == case
    law = case.build_rolling().law
    assert str(law) == "1.2 falling to nothing at 2000 kPa"
    # The same from Python: what the registry finds is the class.
    assert law == FRICTION.find("yielding").target(1.2, 2e6)
    result = tl.run(case)
    data = result.contact.dataset
    touching = data.pressure.to_numpy() > 0
    expected = 1.2 * np.maximum(1 - data.pressure.to_numpy() / 2e6, 0.1)
    np.testing.assert_allclose(data.friction_coefficient.to_numpy()[touching], expected[touching], rtol=1e-9)
    shear = np.hypot(data.traction_x, data.traction_y).to_numpy()
    # The solver's tolerance of 1e-6 on a bound of 1 MPa.
    assert (shear <= expected * data.pressure.to_numpy() + 5).all()
    assert "falling to nothing at 2000 kPa" in result.to_tree()["contact"].attrs["rolling"]
    told = [str(entry) for entry in entries(Case, tomllib.loads(case.to_toml()))]
    assert any(one.endswith("friction: yield pressure 2000 kPa") for one in told), told
    inside = YIELDING.replace(" }", ', base = { law = "coulomb", coefficient = 0.5 } }')
    assert Case.from_text(case_of("friction       = 0.7", inside)).build_rolling().law.largest == 0.6


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"2 MPa"', '"2 mm"', "rolling.friction.yield_pressure: cannot read '2 mm'"),
        ("unloaded = 1.2", "unladen = 1.2", "unknown key 'rolling.friction.unladen'; did you mean 'unloaded'?"),
        ("unloaded = 1.2, ", "", "'rolling.friction.unloaded' is missing"),
        ("1.2", "-1.2", "rolling.friction: unloaded must be > 0, got -1.2"),
        ('"yielding"', '"yieldin"', "rolling.friction: no law 'yieldin'; did you mean 'yielding'?"),
        (
            ", yield",
            ", kinetic = 1, yield",
            "friction.kinetic'; kinetic is not a key of the friction law",
        ),
    ],
)
def test_their_laws_are_refused_in_our_words(road_laws, old, new, words):
    assert old in YIELDING
    assert words in said(case_of("friction       = 0.7", YIELDING.replace(old, new, 1)))


def test_a_material_is_one_file_of_theirs(road_laws):
    soil = case_of('kind = "elastic", modulus = "5400 MPa"', 'kind = "soil", cbr = "5 %"').replace("0.35", "0.4")
    case = Case.from_text(soil)
    assert Case.from_text(case.to_toml()) == case
    assert case.pavement.build().layers[0].material == tl.Elastic(17.6e6 * 5**0.64, 0.4)
    zener = 'kind = "zener", fast = "5400 MPa", slow = "540 MPa", time = "10 ms"'
    prony = 'kind = "prony", modulus = "5400 MPa", terms = [[0.9, "10 ms"]]'
    readings = []
    for words in (zener, prony):
        text = case_of('kind = "elastic", modulus = "5400 MPa"', words).replace("depths", "speed = 20\ndepths")
        road = Case.from_text(text).pavement.build()
        found = tl.solve_response(tl.UniformDisc(0.1, 7e5), road, depths=[0.02], x=[0, 0.05], y=[0], speed=20.0)
        readings.append(found.dataset.strain_xx.to_numpy())
    # The Prony series of one term is the same solid.
    np.testing.assert_allclose(*readings, rtol=1e-9)
    # A viscoelastic material of theirs shifts with temperature as ours do.
    shift = ', shift = { kind = "wlf", c1 = 15, c2 = "120 K", reference = 15 }, poisson = 0.35 }'
    text = case_of('kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }', zener + shift)
    text = text.replace("[[pavement", "[pavement]\ntemperature = 30\n[[pavement").replace(
        "depths", "speed = 1\ndepths"
    )
    shifted = Case.from_text(text).pavement.build().layers[0].material
    assert shifted.time == pytest.approx(0.01 * float(tl.materials.WLF(15, 120, 15).factor(30)))
    # A tire takes what is elastic, theirs too.
    tire = case_of('inflation_pressure = "8.2 bar"', 'material = { kind = "soil", cbr = 0.05 }')
    assert Case.from_text(tire).build_tire().material == tl.Elastic(17.6e6 * 5**0.64, 0.4)
    odd = case_of('inflation_pressure = "8.2 bar"', f"material = {{ {zener}, poisson = 0.4 }}")
    assert "tire.material: no material of the kind 'zener'" in said(odd)


DESIGN = (
    ONE_AXLE
    + """[[criteria]]
name = "ours"
law = "fatigue-line"
layer = "EB-GB3"
epsilon_6 = "100 microstrain"
slope = -0.2
[[criteria]]
name = "same"
law = "track"
layer = "EB-GB3"
epsilon_6 = "100 microstrain"
power = 5
[[criteria]]
name = "theirs"
law = "doubled"
layer = "EB-GB3"
epsilon_6 = "100 microstrain"
"""
)


def test_a_law_of_fatigue_and_a_criterion_are_one_file_of_theirs(road_laws):
    case = Case.from_text(DESIGN)
    assert Case.from_text(case.to_toml()) == case
    # What the table leaves out the layer gives, as for our laws.
    own = Case.from_text(DESIGN.replace('epsilon_6 = "100 microstrain"\npower', "power")).build_criteria()[1]
    assert own.law_at(15.0) == CRITERIA.find("track").target(tl.catalogue.mixes["EB-GB3"].epsilon_6, 5.0)
    result = tl.run(case, leave_out=("sensitivity",))
    years = result.life.dataset.life_years.to_numpy()
    assert years[1] == pytest.approx(years[0], rel=1e-12)
    # Twice the strain in a power of five.
    assert years[0] / years[2] == pytest.approx(2**5, rel=1e-9)
    assert "test track, power 5" in result.summary() + str(result.to_tree()["life"].attrs)
    text = DESIGN.replace('layer = "EB-GB3"\nepsilon_6 = "100 microstrain"\npower = 5', 'layer = "EB-GB3"\npowr = 5')
    assert "unknown key 'criteria.1.powr'; did you mean 'power'?" in said(text, Case)
    text = DESIGN.replace("power = 5", "risk = 5")
    assert "risk is not a key of the fatigue law 'track'" in said(text, Case)
    text = DESIGN.replace(
        '"theirs"\nlaw = "doubled"\nlayer = "EB-GB3"\nepsilon_6', '"theirs"\nlaw = "track"\nlayer = 3\nepsilon_6'
    )
    assert "'theirs': power is missing, and the layer does not provide it" in said(text, Case)


BONDED_ROAD = """
[pavement]
temperature = 30
[[pavement.layers]]
thickness = "60 mm"
material = { modulus = "7000 MPa", poisson = 0.35 }
bond = { kind = "tack-coat", at_reference = "8000 MPa/m", halving = "5 K" }
[[pavement.layers]]
material = { modulus = "120 MPa", poisson = 0.35 }
"""


def test_a_bond_law_is_one_file_of_theirs(road_laws):
    start, end = COARSE_CASE.index("[[pavement"), COARSE_CASE.index("[rolling]")
    text = COARSE_CASE[:start] + BONDED_ROAD + COARSE_CASE[end:]
    case = Case.from_text(text)
    assert Case.from_text(case.to_toml()) == case
    # 10 K are two halvings of 8000 MPa/m.
    road = case.pavement.build()
    assert road.layers[0].bond.stiffness == pytest.approx(2e9)
    layers = [tl.Layer(tl.Elastic(7e9, 0.35), 0.06, bond=tl.pavement.Bond(2e9)), tl.Layer(tl.Elastic(120e6, 0.35))]
    disc = tl.UniformDisc(0.1, 7e5)
    theirs, ours = (tl.solve_response(disc, one, depths=[0.06], x=[0], y=[0]) for one in (road, tl.Pavement(layers)))
    np.testing.assert_allclose(theirs.dataset.strain_xx, ours.dataset.strain_xx, rtol=1e-12)
    assert case.pavement.untempered().layers[0].bond == BONDS.find("tack-coat").target(8e9, 5.0)
    assert "it holds tack coat" in said(text.replace("temperature = 30", ""))
    assert "pavement.layers.0.bond: no bond 'tackcoat'; did you mean 'tack-coat'?" in said(
        text.replace('"tack-coat"', '"tackcoat"')
    )


@pytest.mark.slow
def test_a_reader_of_meshes_is_one_file_of_theirs(road_laws, tmp_path):
    points, triangles = tire_mesh()
    with (tmp_path / "wheel.lab").open("wb") as stream:
        np.savez(stream, points=points, triangles=triangles)
    tire = tl.Tire.from_scan(tmp_path / "wheel.lab", units="m", inflation_pressure=8e5)
    ours = tl.Tire.from_scan(write(tmp_path / "wheel.obj", points, triangles), units="m", inflation_pressure=8e5)
    grid = tl.response.Grid.centred(0.2, 0.2, 0.01)
    # OBJ keeps eight decimals.
    np.testing.assert_allclose(tire.surface.height_map(grid), ours.surface.height_map(grid), atol=1e-7)
    text = case_of('profile = "315/80R22.5"', 'scan = "wheel.lab"\nunits = "m"')
    assert Case.from_text(text, folder=tmp_path).build_tire().quality is not None
    with (tmp_path / "flat.lab").open("wb") as stream:
        np.savez(stream, points=points[:, :2], triangles=triangles)
    with pytest.raises(InputError, match=r"reader 'lab' of the package road-laws 1\.2: it must return vertices"):
        tl.Tire.from_scan(tmp_path / "flat.lab")
    (tmp_path / "torn.lab").write_text("?")
    with pytest.raises(InputError, match=r"could not be read by the reader 'lab' of the package road-laws 1\.2"):
        tl.Tire.from_scan(tmp_path / "torn.lab")
    (tmp_path / "wheel.labs").write_text("?")
    with pytest.raises(InputError, match=r"export the mesh as one of \.obj, .*, \.lab"):
        tl.Tire.from_scan(tmp_path / "wheel.labs")


def test_the_schema_knows_their_things(road_laws):
    (road_laws / "road_laws-1.2.dist-info" / "entry_points.txt").write_text(
        "\n".join(line for line in ENTRY_POINTS.splitlines() if line.split(" ")[0] not in ("torn", "number", "bare"))
    )
    schema = json_schema("life")
    assert {"yielding", "track", "doubled"} <= kinds_in(schema, "law")
    assert {"soil", "zener", "tack-coat"} <= kinds_in(schema, "kind")
    text = json.dumps(schema, ensure_ascii=False)
    assert "μ without pressure, > 0. A number, 0.7." in text
    assert "zener" not in json.dumps(schema["$defs"]["material-of-a-tire"])


def test_a_broken_package_stops_no_one_else_and_is_named(road_laws):
    assert Case.from_text(COARSE_CASE).build_rolling().law == tl.contact.friction.Coulomb(0.7)
    torn = said(case_of("friction       = 0.7", 'friction = { law = "torn" }'))
    assert torn.startswith(
        "case: rolling.friction: the package road-laws 1.2 brings 'torn' for treadload.friction, but "
        "road_laws.nowhere:Torn cannot be loaded: ModuleNotFoundError"
    )
    assert torn.endswith("repair that package or remove it")
    number = said(case_of("friction       = 0.7", 'friction = { law = "number" }'))
    assert "neither a class nor a function" in number
    nothing = said(case_of('kind = "elastic", modulus = "5400 MPa", poisson = 0.35', 'kind = "nothing"'))
    assert "the material 'nothing' of the package road-laws 1.2 must be" in nothing
    assert "got 'not a material'" in nothing
    bare = said(case_of('kind = "elastic"', 'kind = "bare"'))
    assert "the material 'bare' of the package road-laws 1.2 cannot be read from a table" in bare
    assert "the parameter modulus of bare has no annotation" in bare
    with pytest.raises(InputError, match=r"the package road-laws 1\.2 brings"):
        json_schema("run")


def test_a_name_that_two_bring_is_refused(tmp_path, monkeypatch):
    build(tmp_path / "a", "first_laws", "[treadload.friction]\ncoulomb = first_laws:X\n")
    monkeypatch.syspath_prepend(str(tmp_path / "a"))
    with pytest.raises(InputError, match=r"'coulomb' comes from treadload and from the package first-laws 1\.2"):
        Case.from_text(case_of("friction       = 0.7", 'friction = { law = "exponential" }'))
    # Other kinds of things are not touched by it.
    assert MATERIALS.find("elastic").target is tl.Elastic
    build(tmp_path / "b", "second_laws", "[treadload.readers]\nlab = second_laws:X\n")
    build(tmp_path / "c", "third_laws", "[treadload.readers]\nlab = third_laws:Y\n")
    monkeypatch.syspath_prepend(str(tmp_path / "b"))
    monkeypatch.syspath_prepend(str(tmp_path / "c"))
    with pytest.raises(InputError, match=r"'lab' comes from the package third-laws 1\.2 and from .*second-laws 1\.2"):
        READERS.names()


def test_the_page_on_laws_of_ones_own_does_what_it_says(tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs/howto/law_of_your_own.md").read_text(encoding="utf-8")
    (law, notebook, drawn), (project, rolling, first_line) = (
        re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL) for language in ("python", "toml")
    )
    points = tomllib.loads(project)["project"]["entry-points"]["treadload.friction"]
    declared = "\n".join(f"{name} = {place}" for name, place in points.items())
    build(tmp_path, "road_laws", f"[treadload.friction]\n{declared}\n", friction=law)
    monkeypatch.syspath_prepend(str(tmp_path))
    text = COARSE_CASE.replace('normal_load    = "32.5 kN"\n', "").replace("friction       = 0.7\n", "")
    case = Case.from_text(first_line + text.replace("[rolling]\n", rolling))
    assert str(case.build_rolling().law) == "1.2, yielding at 2000 kPa"
    with pytest.raises(InputError, match=r"rolling\.friction: unloaded must be > 0, got 0; a dry road is near 0\.7"):
        Case.from_text(text.replace("[rolling]\n", rolling.replace("1.2", "0")))
    groups = set(re.findall(r"^\| .* \| `(treadload\.[a-z_]+)` \|", page, re.MULTILINE))
    assert groups == {registry.group for registry in (*ALL, COMPARISONS)}
    monkeypatch.setattr(FRICTION, "_built_in", dict(FRICTION._built_in))
    # A class of a notebook stands in the same module as before, under a new name here.
    cell = notebook.replace('"yielding"', '"of the page"')
    exec(compile(cell, "page", "exec"), {"Yielding": type(case.build_rolling().law)})
    assert "of the page" in FRICTION.built_in()
    # Read, not run: running it would register the figure for all tests that follow.
    assert {node.id for node in ast.walk(ast.parse(drawn)) if isinstance(node, ast.Name)} >= {"figure"}
    del sys.modules["road_laws"], sys.modules["road_laws.friction"]


def test_a_session_may_register_its_own():
    before = dict(FRICTION._built_in)
    try:

        @FRICTION.register("of a notebook")
        def half(of: float) -> tl.contact.friction.FrictionLaw:
            """Half of a coefficient."""
            return tl.contact.friction.Coulomb(of / 2)

        case = Case.from_text(case_of("friction       = 0.7", 'friction = { law = "of a notebook", of = 1.4 }'))
        assert case.build_rolling().coefficient == 0.7
        with pytest.raises(InputError, match=r"'coulomb' is .*_coulomb already"):
            FRICTION.register("coulomb")(half)
    finally:
        FRICTION._built_in.clear()
        FRICTION._built_in.update(before)


def test_importing_treadload_loads_nothing_of_theirs(road_laws):
    code = (
        f"import sys; sys.path.insert(0, {str(road_laws)!r}); import treadload as tl; tl.Case; "
        "print([name for name in sys.modules if name.startswith('road_laws')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_names_that_are_known_do_not_depend_on_the_order_of_imports():
    with pytest.raises(tl.InputError) as caught:
        PLASTICITY.find("q9x7")
    told = str(caught.value).split("known are ")[1].split(", ")
    assert told == sorted(told)
    assert len(told) >= 5
