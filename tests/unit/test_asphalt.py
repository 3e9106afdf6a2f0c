"""How much asphalt lies in a road, and which lifts are one course."""

import pytest

import treadload as tl
from treadload.catalogue import mixes
from treadload.errors import InputError
from treadload.materials import HydraulicMix, Mix, Unbound
from treadload.pavement import FRICTIONLESS, is_bituminous, lift_below

GB3, BBSG, SOIL = mixes["EB-GB3"], mixes["EB-BBSG3"], mixes["PF3"]


def road(*layers, soil=SOIL):
    return tl.Pavement([*(tl.Layer(material, thickness) for material, thickness in layers), tl.Layer(soil)])


def test_contiguous_asphalt_is_added_up_and_no_other():
    one = road((BBSG, 0.06), (GB3, 0.10), (GB3, 0.12), (mixes["GNT1"], 0.25))
    for layer in (0, 1, 2, -3):
        assert tl.pavement.bituminous_thickness(one, layer) == pytest.approx(0.28, rel=1e-15)
    # An inverted structure: the granular layer parts the asphalt from what lies on the cement.
    inverted = road((BBSG, 0.08), (mixes["GNT1"], 0.12), (GB3, 0.10), (mixes["GC-T3"], 0.20))
    assert tl.pavement.bituminous_thickness(inverted, 0) == 0.08
    assert tl.pavement.bituminous_thickness(inverted, 2) == 0.10


def test_bonds_do_not_change_how_much_asphalt_there_is():
    parted = tl.Pavement([tl.Layer(BBSG, 0.06, bond=FRICTIONLESS), tl.Layer(GB3, 0.15), tl.Layer(SOIL)])
    assert tl.pavement.bituminous_thickness(parted, 1) == pytest.approx(0.21, rel=1e-15)


def test_what_is_known_of_a_material():
    for material in mixes.values():
        known = is_bituminous(material)
        assert known == isinstance(material, Mix)
        assert not (known and isinstance(material, HydraulicMix | Unbound))
    assert is_bituminous(tl.catalogue.materials[next(iter(tl.catalogue.materials))].material)
    # Softer than any mix, stiffer than any unbound material of the catalogue; above nothing is known.
    softest = min(min(m.moduli[-1]) for m in mixes.values() if isinstance(m, Mix) and len(m.frequencies) == 1)
    stiffest = max(m.modulus for m in mixes.values() if isinstance(m, Unbound))
    assert stiffest < 0.7e9 < softest
    assert is_bituminous(tl.Elastic(0.69e9, 0.35)) is False
    assert is_bituminous(tl.Elastic(0.71e9, 0.35)) is None


def test_elastic_layers_are_counted_where_they_are_known():
    asphalt, gravel = tl.Elastic(7e9, 0.35), tl.Elastic(300e6, 0.35)
    assert tl.pavement.bituminous_thickness(road((asphalt, 0.2), (gravel, 0.3), soil=tl.Elastic(5e7, 0.35)), 0) == 0.2
    with pytest.raises(InputError, match="may be asphalt or bound by cement"):
        tl.pavement.bituminous_thickness(road((BBSG, 0.06), (tl.Elastic(9e9, 0.35), 0.15)), 0)


@pytest.mark.parametrize(
    ("layer", "words"),
    [(1, "layer 2 '' is not asphalt"), (2, "is semi-infinite"), (3, "there is no layer 3"), (-4, "no layer -4")],
)
def test_other_layers_are_refused(layer, words):
    with pytest.raises(InputError, match=words):
        tl.pavement.bituminous_thickness(road((BBSG, 0.06), (mixes["GNT1"], 0.25)), layer)


def test_lifts():
    one = road((BBSG, 0.06), (GB3, 0.10), (GB3, 0.10))
    assert [lift_below(one, layer) for layer in range(4)] == [False, True, False, False]
    parted = tl.Pavement([tl.Layer(GB3, 0.1, bond=FRICTIONLESS), tl.Layer(GB3, 0.1), tl.Layer(SOIL)])
    assert not lift_below(parted, 0)
