"""Catalogues: lookup by name, what other packages bring along, files of one's own."""

from importlib import metadata

import pytest

from treadload.errors import InputError
from treadload.materials import Elastic, Mix, Unbound, mix, mixes, read_mixes
from treadload.pavement import (
    BONDED,
    FRICTIONLESS,
    HALF_BONDED,
    Bond,
    Layer,
    Pavement,
    Structure,
    read_structures,
    structures,
)
from treadload.pavement.catalogue import Course

MIXES = """
source = "A laboratory's own measurements."

[bituminous]
temperatures = [0, 20]
frequency = 15
poisson = 0.3
mixes.AC-11.moduli = [12e9, 4e9]
mixes.AC-22.moduli = [15e9, 6e9]
mixes.AC-22.ratios = "all"
ratios.all = { 5 = [0.9, 0.4], 15 = [1.0, 0.5] }

[unbound]
poisson = 0.4
slope = -0.25
constant = 0.02
constant_light = 0.03
platforms = { Sand = 60e6 }
"""
STRUCTURES = """
[[structures]]
name = "test track"
title = "two bonds"
source = "Invented."
layers = [
    { mix = "AC-11", thickness = 0.04, bond = { stiffness = 1e10 } },
    { mix = "EB-GB3", thickness = 0.1, bond = "frictionless" },
    { mix = "Sand" },
]
"""


@pytest.fixture
def offer(monkeypatch):
    """Let functions stand as entry points, as installed packages would bring them."""

    def stand(group, **functions):
        found = [metadata.EntryPoint(name, f"fake:{name}", group) for name in functions]
        monkeypatch.setattr(metadata.EntryPoint, "load", lambda point: functions[point.name])
        known = metadata.entry_points
        monkeypatch.setattr(
            metadata, "entry_points", lambda **which: found if which == {"group": group} else known(**which)
        )

    return stand


@pytest.fixture
def file(tmp_path):
    def write(text, name="mine.toml"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / name

    return write


def test_names_are_met_without_case_and_spaces():
    assert mix("eb-gb3") is mix("EB-GB3") is mix(" EB-GB3 ")
    assert Pavement.from_catalogue("6BBSG3/15GB3/PF3") == Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: mix("EB-GB5"), "no mix 'EB-GB5'; did you mean 'EB-GB[234]'"),
        (lambda: mix("GB3"), "did you mean 'EB-GB3'"),
        (lambda: mix("concrete slab"), "no mix 'concrete slab'; known are EB-BBSG1, "),
        (lambda: mix(3), "name of a mix must be a text, got 3"),
        (lambda: Pavement.from_catalogue("6 BBSG / 15 GB3 / PF3"), "did you mean '6 BBSG3 / 15 GB3 / PF3'"),
        (lambda: Pavement.from_catalogue("motorway"), "no structure 'motorway'; known are 6 BBSG3 / 15 GB3 / PF3, "),
        (lambda: Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=60), "layer 'EB-BBSG3'.* 60 °C"),
        (lambda: Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=288.15), "kelvin"),
    ],
)
def test_unknown_names_and_temperatures(ask, message):
    with pytest.raises(InputError, match=message):
        ask()


def test_catalogued_structures_wait_for_their_temperature():
    road = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    assert [layer.name for layer in road.layers] == ["EB-BBSG3", "EB-GB3", "PF3"]
    assert road.interfaces == pytest.approx([0.06, 0.21])
    assert road.layers[1].material == mix("EB-GB3")
    warm = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    assert [layer.elastic.modulus / 1e6 for layer in warm.layers] == pytest.approx([7000, 9000, 120], rel=1e-14)
    assert warm == road.at_temperature(15)
    slow = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15, frequency=3)
    # 0.83 of the modulus at 10 Hz, as printed.
    assert [layer.elastic.modulus / 1e6 for layer in slow.layers] == pytest.approx([5810, 7470, 120], rel=1e-3)
    # The platform knows what it bears, and is elastic all the same.
    assert isinstance(warm.layers[2].material, Unbound)


@pytest.mark.parametrize("name", structures())
def test_every_structure_can_be_built(name):
    found = structures()[name]
    road = Pavement.from_catalogue(name, temperature=15)
    assert Pavement.from_catalogue(found, temperature=15) == road
    assert not road.is_viscoelastic
    assert "llustrative" in found.source or "secondary source" in found.source
    # The name tells the thicknesses in centimetres.
    told = [part.split() for part in name.split(" / ")]
    assert [layer.thickness for layer in road.layers[:-1]] == pytest.approx(
        [float(part[0]) / 100 for part in told[:-1]]
    )
    assert all(layer.name.endswith(part[-1]) for layer, part in zip(road.layers, told, strict=True))


def test_the_semi_rigid_structure_is_half_bonded():
    road = Pavement.from_catalogue("6 BBSG3 / 15 GC-T3 / 15 GC-T3 / PF3")
    assert [layer.bond for layer in road.layers] == [BONDED, HALF_BONDED, BONDED, BONDED]


def test_files_of_ones_own(file):
    found = {one.name: one for one in read_mixes(file(MIXES))}
    assert list(found) == ["AC-11", "AC-22", "Sand"]
    assert found["AC-11"].at(5.0) == Elastic(10e9, 0.3)
    assert found["AC-22"].at(20.0) == Elastic(6e9, 0.3)
    assert found["AC-22"].modulus(20.0, frequency=5) == pytest.approx(0.8 * 6e9, rel=1e-14)
    assert found["AC-11"].source == "A laboratory's own measurements."
    assert found["Sand"].constant_inverted is None
    assert found["AC-11"].epsilon_6 is None


def test_other_packages_bring_mixes(offer, file):
    offer("treadload.mixes", lab=lambda: read_mixes(file(MIXES)))
    assert mix("ac-11").moduli == ((12e9, 4e9),)
    assert list(mixes())[:3] == ["EB-BBSG1", "EB-BBSG2", "EB-BBSG3"]
    assert list(mixes())[-3:] == ["AC-11", "AC-22", "Sand"]


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda: 1 / 0, "entry point 'lab' .fake:lab. of the group treadload.mixes fails: ZeroDivisionError"),
        (lambda: [Elastic(1e9, 0.3)], "must return Mix, HydraulicMix, Unbound, got Elastic"),
        (lambda: [mix("EB-GB3")], "brings the mix 'EB-GB3', which treadload has already"),
    ],
)
def test_broken_packages_are_named_and_stop_no_one(offer, function, message):
    offer("treadload.mixes", lab=function)
    assert isinstance(mix("EB-GB3"), Mix)
    with pytest.raises(InputError, match=message):
        mixes()
    with pytest.raises(InputError, match=message):
        mix("unheard of")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("poisson = 0.3\n", "", "mine.toml: 'bituminous.poisson' is missing"),
        ("poisson = 0.3\n", "poison = 0.3\n", "mine.toml: unknown key 'bituminous.poison'; did you mean 'poisson'"),
        (
            "mixes.AC-11.moduli",
            "mixes.AC-11.modulus",
            "unknown key 'bituminous.mixes.AC-11.modulus'; did you mean 'moduli'",
        ),
        ('ratios = "all"', 'ratios = "some"', "no table of ratios 'some'; known are all"),
        ("15 = [1.0, 0.5]", "25 = [1.0, 0.5]", "must hold the frequency of the moduli, 15 Hz"),
        (
            "15 = [1.0, 0.5]",
            "15 = [1.0]",
            "mine.toml: bituminous.mixes.AC-22: a table of ratios needs one for each of the 2 moduli, got 1",
        ),
        ("[12e9, 4e9]", "[12e9, -4e9]", "modulus must be a positive number of Pa"),
        ("[unbound]", "[unbound", "cannot read .*mine.toml"),
        ("[unbound]", "[unbounded]", "unknown key 'unbounded'; did you mean 'unbound'"),
        ('source = "A laboratory\'s own measurements."', "", "mine.toml: 'source' is missing"),
    ],
)
def test_bad_files_of_mixes(file, old, new, message):
    assert old in MIXES
    with pytest.raises(InputError, match=message):
        read_mixes(file(MIXES.replace(old, new)))


def test_bonds_of_structures(file, offer):
    (found,) = read_structures(file(STRUCTURES))
    assert [course.bond for course in found.courses] == [Bond(1e10), FRICTIONLESS, BONDED]
    assert str(found) == "test track (two bonds)"
    with pytest.raises(InputError, match="no mix 'AC-11'"):
        found.layers()
    offer("treadload.mixes", lab=lambda: read_mixes(file(MIXES)))
    assert found.layers()[0] == Layer(mix("AC-11"), 0.04, "AC-11", Bond(1e10))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            '"frictionless"',
            '"glued"',
            "structures.0.layers.1.bond: a bond is 'bonded', 'half-bonded', 'frictionless' or .*got 'glued'",
        ),
        (
            "thickness = 0.1,",
            "thicknes = 0.1,",
            "unknown key 'structures.0.layers.1.thicknes'; did you mean 'thickness'",
        ),
        ('title = "two bonds"', "", "'structures.0.title' is missing"),
        ("= 1e10", "= -1e10", "stiffness of a bond must be >= 0"),
        ("[[structures]]", "[[roads]]", "unknown key 'roads'"),
    ],
)
def test_bad_files_of_structures(file, old, new, message):
    with pytest.raises(InputError, match=message):
        read_structures(file(STRUCTURES.replace(old, new)))


def test_other_packages_bring_structures(offer):
    courses = (Course("EB-GB3", 0.1), Course("PF2"))
    offer("treadload.structures", track=lambda: [Structure("test track", "in words", courses)])
    assert list(structures())[-1] == "test track"
    road = Pavement.from_catalogue("Test Track", temperature=15)
    assert road.layers[0].elastic.modulus == pytest.approx(9e9, rel=1e-14)
