"""Catalogues: lookup by name, what other packages bring along, files of one's own."""

from dataclasses import replace
from importlib import metadata
from pathlib import Path

import pytest

from treadload import named
from treadload.catalogue import (
    Structure,
    TireMesh,
    materials,
    mixes,
    read_mixes,
    read_structures,
    read_tires,
    structures,
    tires,
)
from treadload.errors import InputError
from treadload.materials import Elastic, Mix, Unbound
from treadload.pavement import (
    BONDED,
    FRICTIONLESS,
    HALF_BONDED,
    Bond,
    Layer,
    Pavement,
)
from treadload.pavement.catalogue import Course
from treadload.tire import Tire, example_mesh

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
        real = named.declared_points
        monkeypatch.setattr(
            named, "declared_points", lambda wanted, path: found if wanted == group else real(wanted, path)
        )

    return stand


@pytest.fixture
def file(tmp_path):
    def write(text, name="mine.toml"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / name

    return write


def test_names_are_met_without_case_and_spaces():
    assert mixes["eb-gb3"] is mixes["EB-GB3"] is mixes[" EB-GB3 "] is mixes["GB3"]
    assert tires["315_80r22.5"] is tires["315/80 R22.5"]
    assert "bbsg3" in mixes
    assert "BBSG9" not in mixes
    assert 3 not in mixes
    assert mixes.get("BBSG9") is None
    assert Pavement.from_catalogue("6BBSG3/15GB3/PF3") == Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: mixes["EB-GB5"], "no mix 'EB-GB5'; did you mean 'EB-GB[234]'"),
        (lambda: mixes["GB5"], "did you mean 'GB[234]'"),
        (lambda: materials["viscorout"], "no viscoelastic material 'viscorout'; did you mean 'ViscoRoute'"),
        (lambda: tires["315/70R22.5"], r"did you mean '315/80R22\.5'"),
        (lambda: tires["tractor"], "no tire 'tractor'; known are 11R22.5, 203 x 47 steel, 205/60R15, "),
        (lambda: Tire.from_profile("335/65R22.5"), r"is a mesh, .* use Tire.from_scan\(catalogue.tires\["),
        (lambda: mixes["concrete slab"], "no mix 'concrete slab'; known are EB-BBSG1, "),
        (lambda: mixes[3], "name of a mix must be text, got 3"),
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
    assert road.layers[1].material == mixes["EB-GB3"]
    warm = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    assert [layer.elastic.modulus / 1e6 for layer in warm.layers] == pytest.approx([7000, 9000, 120], rel=1e-14)
    assert warm == road.at_temperature(15)
    slow = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15, frequency=3)
    # 0.83 of the modulus at 10 Hz, as printed.
    assert [layer.elastic.modulus / 1e6 for layer in slow.layers] == pytest.approx([5810, 7470, 120], rel=1e-3)
    # The platform knows what it bears, and is elastic all the same.
    assert isinstance(warm.layers[2].material, Unbound)


@pytest.mark.parametrize("name", structures)
def test_every_structure_can_be_built(name):
    found = structures[name]
    road = Pavement.from_catalogue(name, temperature=15)
    assert Pavement.from_catalogue(found, temperature=15) == road
    assert not road.is_viscoelastic
    assert "llustrative" in found.caveats[0] or "secondary source" in found.source
    # The name tells the thicknesses in centimetres.
    told = [part.split() for part in name.split(" / ")]
    assert [layer.thickness for layer in road.layers[:-1]] == pytest.approx(
        [float(part[0]) / 100 for part in told[:-1]]
    )
    assert all(layer.name.endswith(part[-1]) for layer, part in zip(road.layers, told, strict=True))


CATALOGUES = {"mixes": mixes, "structures": structures, "materials": materials, "tires": tires}


@pytest.mark.parametrize("kind", CATALOGUES)
def test_every_entry_has_its_source_and_caveats(kind):
    known = CATALOGUES[kind]
    assert list(known) == [item.name for item in known.values()]
    for name, item in known.items():
        assert len(item.source) > 30, name
        assert item.caveats, name
        assert all(len(caveat) > 20 and caveat[-1] in ".:" for caveat in item.caveats), name
        assert "\n" not in item.source + "".join(item.caveats), name
        # Descriptions stay hashable and compare by all that they hold.
        assert hash(item) == hash(known[name.lower()])


@pytest.mark.parametrize("kind", CATALOGUES)
def test_a_catalogue_shows_itself(kind):
    known = CATALOGUES[kind]
    told, table = repr(known).splitlines(), known._repr_html_()
    assert len(told) == 1 + len(known)
    assert str(len(known)) in told[0]
    assert max(map(len, told)) <= 118
    assert table.count("<tr>") == 1 + len(known)
    for name, line in zip(known, told[1:], strict=True):
        assert name in line
        assert f">{name}<" in table
        assert all(text in known.about(name) for text in (known[name].source, *known[name].caveats))
    with pytest.raises(TypeError):
        known["mine"] = known[name]


def test_an_unknown_name_is_wrong_input_and_a_missing_key():
    for error in (InputError, KeyError):
        with pytest.raises(error) as caught:
            mixes["BBSG7"]
    # A KeyError alone would show its message quoted.
    assert str(caught.value).startswith("no mix 'BBSG7'; did you mean 'BBSG")


def test_numbers_of_one_mix_have_caveats_of_their_own():
    shared = mixes["GB3"].caveats
    assert mixes["BBM"].caveats[-1] == shared[0]
    assert "no fatigue line" in mixes["BBM"].caveats[0]
    assert mixes["BBM"].epsilon_6 is None


def test_the_mesh_of_the_catalogue_is_read_as_a_scan(file, tmp_path):
    mesh = tires["335/65R22.5"]
    assert Path(mesh) == mesh.path == example_mesh()
    (tmp_path / "mine.ply").write_bytes(b"")
    text = 'name = "mine"\nmesh = "mine.ply"\ntitle = "drawn"\nsource = "me"\ncaveats = ["all"]\n'
    assert read_tires(file(text)) == [TireMesh("mine", tmp_path / "mine.ply", "drawn", "me", ("all",))]
    for old, new, message in (
        ("mine.ply", "other.ply", "no mesh file .*other.ply"),
        ('["all"]', '"all"', "caveats: must be a list, got 'all'"),
        ("title", "titel", "unknown key 'titel'; did you mean 'title'"),
        ('"me"', "3", "mine.toml: source: .*got 3"),
    ):
        with pytest.raises(InputError, match=message):
            read_tires(file(text.replace(old, new)))


def test_other_packages_bring_tires(offer):
    wide = replace(tires["315/80R22.5"], name="wide base", width=0.3)
    offer("treadload.tires", maker=lambda: [wide])
    assert Tire.from_profile("Wide Base").surface.profile is wide


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
    assert mixes["ac-11"].moduli == ((12e9, 4e9),)
    assert list(mixes)[:3] == ["EB-BBSG1", "EB-BBSG2", "EB-BBSG3"]
    assert list(mixes)[-3:] == ["AC-11", "AC-22", "Sand"]


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda: 1 / 0, "entry point 'lab' .fake:lab. of the group treadload.mixes fails: ZeroDivisionError"),
        (lambda: [Elastic(1e9, 0.3)], "must return Mix, HydraulicMix, Unbound, UnboundByStress, got Elastic"),
        (lambda: [mixes["EB-GB3"]], "brings the mix 'EB-GB3', which treadload has already"),
    ],
)
def test_broken_packages_are_named_and_stop_no_one(offer, function, message):
    offer("treadload.mixes", lab=function)
    assert isinstance(mixes["EB-GB3"], Mix)
    with pytest.raises(InputError, match=message):
        list(mixes)
    with pytest.raises(InputError, match=message):
        mixes["unheard of"]


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
        ('source = "A', 'caveats = "none"\nsource = "A', "mine.toml: caveats"),
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
    assert found.layers()[0] == Layer(mixes["AC-11"], 0.04, "AC-11", Bond(1e10))


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
    assert list(structures)[-1] == "test track"
    road = Pavement.from_catalogue("Test Track", temperature=15)
    assert road.layers[0].elastic.modulus == pytest.approx(9e9, rel=1e-14)
