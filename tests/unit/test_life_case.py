"""A case of design: what its tables build, and what is said of wrong ones."""

import pytest

import treadload as tl
from treadload.case import Case
from treadload.catalogue import mixes
from treadload.contact.maneuver import Maneuver
from treadload.errors import InputError

DESIGN = """
spacing = "12 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5] }

[traffic]
passes_per_year = 1e5
growth = 0.02
years = 20
wander = { deviation = "250 mm" }

[[traffic.classes]]
name = "front"
share = 0.6
axle_load = "70 kN"
inflation_pressure = "8 bar"

[[traffic.classes]]
name = "driven"
share = 0.4
axle_load = "113 kN"
inflation_pressure = "8 bar"
gear = "tandem-dual"
friction = 0.6
maneuvers = [
    { kind = "straight", share = 0.9 },
    { name = "bend", kind = "turning", radius = "-60 m", speed = "36 km/h", share = 0.1 },
]

[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05

[[criteria]]
name = "surface"
law = "fatigue-line"
layer = 1
place = "top"
strain = "principal"

[[criteria]]
name = "soil"
law = "french-subgrade"

[[criteria]]
name = "mepdg"
law = "mepdg-bottom-up"
layer = 2
air_voids = 0.07
binder_volume = 0.11
"""


def test_classes_and_maneuvers_become_rows():
    case = Case.from_text(DESIGN)
    traffic = case.build_traffic()
    assert [row.name for row in traffic.classes] == ["front", "driven, straight", "driven, bend"]
    assert [row.share for row in traffic.classes] == pytest.approx([0.6, 0.36, 0.04])
    front, _, bend = traffic.classes
    assert (front.wheel_load, len(front.wheels)) == (35e3, 1)
    # 113 kN over four wheels; two axles 1.31 m apart, duals 0.34 m apart by default.
    assert bend.wheel_load == pytest.approx(28.25e3)
    assert set(bend.wheels) == {(x, y) for x in (-0.655, 0.655) for y in (-0.17, 0.17)}
    assert bend.maneuver == Maneuver.turning(-60.0, 10.0)
    assert (bend.friction, traffic.years, traffic.wander) == (0.6, 20, tl.damage.Wander.normal(0.25))


def test_a_class_may_bring_its_tire_and_pairs_are_mounted_back_to_back():
    text = DESIGN.replace('gear = "tandem-dual"', 'gear = "tandem-dual"\ntire = { profile = "315/80R22.5" }')
    case = Case.from_text(text)
    front, driven, _ = case.build_traffic().classes
    assert (front.tire, front.mirrored) == (None, ())
    assert driven.tire == tl.Tire.from_profile("315/80R22.5")
    assert [driven.wheels[number][1] for number in driven.mirrored] == pytest.approx([-0.17, -0.17])
    assert Case.from_text(case.to_toml()).build_traffic() == case.build_traffic()
    with pytest.raises(InputError, match=r"did you mean '315/80R22\.5'"):
        Case.from_text(text.replace('315/80R22.5" }', '315/80" }'))


def test_a_mix_gives_its_law():
    """The numbers of the catalogue, at the temperature of the layer, and k_s of what lies below."""
    base, surface, soil, mepdg = Case.from_text(DESIGN).build_criteria()
    mix = mixes["EB-GB3"]
    for temperature in (5.0, 15.0, 30.0):
        asked = tl.damage.FrenchBituminous.of(
            mix, thickness=0.21, risk=0.05, temperature=temperature, platform_modulus=120e6
        )
        # 6 cm of BBSG3 and 15 cm of GB3: the laws ask for all asphalt.
        assert base.law_at(temperature) == asked
        assert mepdg.law_at(temperature) == tl.damage.MepdgBottomUp(mix.modulus(temperature), 0.21, 0.07, 0.11)
    assert surface.law_at(15.0) == tl.FatigueLine(mixes["EB-BBSG3"].epsilon_6, mixes["EB-BBSG3"].slope)
    assert (surface.layer, surface.place, surface.strain) == (0, "top", "principal")
    assert soil.law_at(15.0) == tl.damage.FrenchSubgrade.of(mixes["PF3"])
    assert (soil.layer, soil.place, base.layer, base.place) == (2, "top", 1, "bottom")


def test_a_number_given_stands_before_the_mixs():
    text = DESIGN.replace("risk = 0.05", 'risk = 0.05\nepsilon_6 = "80 microstrain"\nthickness_scatter = "20 mm"')
    law = Case.from_text(text).build_criteria()[0].law_at(10.0)
    assert (law.epsilon_6, law.spread, law.slope) == (80e-6, 0.02, mixes["EB-GB3"].slope)
    assert law.verified


def test_laws_take_all_the_asphalt_where_no_thickness_is_given():
    """The wearing course alone makes top-down cracking of the MEPDG 1048 times too slow."""
    text = DESIGN.replace('law = "mepdg-bottom-up"\nlayer = 2', 'law = "mepdg-top-down"')
    law = Case.from_text(text).build_criteria()[3].law_at(15.0)
    assert law.thickness == pytest.approx(0.21, rel=1e-12)
    own = Case.from_text(text + 'thickness = "6 cm"\n').build_criteria()[3].law_at(15.0)
    assert own.thickness == 0.06
    assert own.allowable_passes(1e-4) / law.allowable_passes(1e-4) == pytest.approx(1048, rel=1e-3)


LIFTS = """
[[pavement.layers]]
mix = "EB-BBSG3"
thickness = "4 cm"
[[pavement.layers]]
name = "upper"
mix = "EB-GB3"
thickness = "4 cm"
[[pavement.layers]]
name = "lower"
mix = "EB-GB3"
thickness = "4 cm"
[[pavement.layers]]
mix = "PF3"
"""


def test_lifts_of_one_mix_have_the_law_of_their_sum():
    text = DESIGN[: DESIGN.index("[[criteria]]")].replace('pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }\n', "")
    base = '[[criteria]]\nname = "base"\nlaw = "french-bituminous"\nrisk = 0.05\nlayer = "lower"\n'
    two = Case.from_text(text + LIFTS + base).build_criteria()[0].law_at(15.0)
    whole = LIFTS[: LIFTS.index('[[pavement.layers]]\nname = "lower"')] + '[[pavement.layers]]\nmix = "PF3"\n'
    whole = whole.replace(
        '"upper"\nmix = "EB-GB3"\nthickness = "4 cm"', '"lower"\nmix = "EB-GB3"\nthickness = "8 cm"'
    )
    one = Case.from_text(text + whole + base).build_criteria()[0].law_at(15.0)
    assert one == two
    # 4 + 4 + 4 cm: on the slope of the rule, 10 mm and three tenths of 2 cm.
    assert two.spread == pytest.approx(0.016, rel=1e-12)


def test_asphalt_that_is_not_known_is_asked_for():
    text = DESIGN[: DESIGN.index("[[criteria]]")].replace('pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }\n', "")
    stiff = LIFTS.replace(
        'name = "lower"\nmix = "EB-GB3"', 'name = "lower"\nmaterial = { modulus = "9 GPa", poisson = 0.35 }'
    )
    base = '[[criteria]]\nname = "base"\nlaw = "french-bituminous"\nrisk = 0.05\nlayer = "upper"\n'
    with pytest.raises(InputError, match=r"'base': layer 3 'lower' .* may be asphalt or bound by cement") as refused:
        Case.from_text(text + stiff + base)
    assert "\n" not in str(refused.value)
    law = Case.from_text(text + stiff + base + 'thickness = "12 cm"\n').build_criteria()[0].law_at(15.0)
    assert law.thickness == pytest.approx(0.12)
    told = Case.from_text(text + stiff + base + 'thickness_scatter = "2 cm"\n').build_criteria()[0].law_at(15.0)
    assert told.spread == 0.02


def test_the_text_of_a_case_reads_back():
    case = Case.from_text(DESIGN)
    again = Case.from_text(case.to_toml())
    assert again.build_traffic() == case.build_traffic()
    assert again.build_climate() == case.build_climate()
    assert again.build_road() == case.build_road()


def test_elastic_layers_take_the_numbers_of_the_table():
    layers = """
[[pavement.layers]]
name = "asphalt"
thickness = "200 mm"
material = { modulus = "7 GPa", poisson = 0.35 }
[[pavement.layers]]
name = "soil"
material = { modulus = "60 MPa", poisson = 0.35 }
"""
    text = DESIGN[: DESIGN.index("[[criteria]]")].replace('pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }\n', "")
    text = text.replace("months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5]", "temperature = 15") + layers
    criteria = '[[criteria]]\nname = "shell"\nlaw = "shell"\nlayer = "Asphalt"\n'
    criterion = Case.from_text(text + criteria).build_criteria()[0]
    assert criterion.law_at(15.0) == tl.damage.ShellFatigue(7e9)
    with pytest.raises(InputError, match=r"epsilon_6 and slope are missing"):
        Case.from_text(text + criteria.replace('"shell"\nlayer', '"fatigue-line"\nlayer'))
    with pytest.raises(InputError, match=r"no layer has moduli"):
        Case.from_text((text + criteria).replace("temperature = 15", f"months = {list(range(12))}"))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("share = 0.6", "share = 0.5", "sum to 1, got 0.9"),
        ("share = 0.9 }", "share = 0.8 }", "sum to 1, got 0.9"),
        ('gear = "tandem-dual"', 'gear = "tandem-duel"', "did you mean 'tandem-dual'"),
        ('law = "french-bituminous"', 'law = "french-bituminus"', "did you mean 'french-bituminous'"),
        ('layer = "EB-GB3"', 'layer = "EB-GB4"', "did you mean 'EB-GB3'"),
        ("layer = 1", "layer = 4", "no layer 4; the road has 1 'EB-BBSG3'"),
        ("layer = 2", "", "layer is missing"),
        ("risk = 0.05", "", "risk is missing"),
        (
            "risk = 0.05",
            "risk = 0.05\nmodulus = 5e9",
            "modulus is not a key of the fatigue law 'french-",
        ),
        ("risk = 0.05", "risc = 0.05", "unknown key 'criteria.0.risc'; did you mean 'risk'"),
        ("passes_per_year = 1e5", "passes_per_year = -1", "passes_per_year must be >= 0"),
        ("months = [4, 5,", "months = [60, 5,", "EB-BBSG3"),
        ("months = [4, 5,", "months = [4,", "12 temperatures"),
        ("months", "month", "did you mean 'months'"),
        ('kind = "turning"', 'kind = "turnin"', "no maneuver 'turnin'; did you mean 'turning'"),
        ('radius = "-60 m", ', "", "'traffic.classes.1.maneuvers.1.radius' is missing"),
        ('kind = "straight", share', 'kind = "straight", radius = 3, share', "radius is not a key of the maneuver"),
        ('axle_load = "70 kN"', "", "either axle_load or wheel_load"),
        ('axle_load = "70 kN"', 'axle_load = "70 bar"', "cannot read '70 bar'"),
        ('name = "surface"', 'name = "base"', "two criteria have the name 'base'"),
        ('name = "driven"', 'name = "front"', ""),
        ('PF3" }', 'PF3", temperature = 15 }', "temperatures of [climate]"),
        ('{ deviation = "250 mm" }', "{ offsets = [0, 0.1], shares = [0.5, 0.4] }", "sum to 1, got 0.9"),
        ("growth = 0.02", 'growth = 0.02\nkind = "geometrical"', "geometric"),
        ("years = 20", "years = 0", "the design life must be a positive number of years, got 0; leave it out"),
    ],
)
def test_wrong_tables_are_named(old, new, words):
    assert old in DESIGN
    if not words:
        assert Case.from_text(DESIGN.replace(old, new, 1)).build_traffic().classes[1].name == "front, straight"
        return
    with pytest.raises(InputError) as refused:
        Case.from_text(DESIGN.replace(old, new, 1))
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
