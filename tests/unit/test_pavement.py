"""Pavement: layers from the top, the last one without thickness."""

import math

import pytest

from treadload.errors import InputError
from treadload.materials import Elastic, Prony
from treadload.pavement import BONDED, FRICTIONLESS, HALF_BONDED, Bond, Layer, Pavement

ASPHALT, SOIL = Elastic(5.4e9, 0.35), Elastic(8e7, 0.4)


def test_half_space():
    road = Pavement.half_space(ASPHALT, name="wearing course")
    assert road.surface_material == ASPHALT
    assert road.is_homogeneous
    assert road.layers[0].thickness is None
    assert road.layers[0].name == "wearing course"


def test_layers():
    road = Pavement([Layer(ASPHALT, 0.08), Layer(SOIL)])
    assert road.surface_material == ASPHALT
    assert not road.is_homogeneous
    assert Pavement([Layer(SOIL, 0.1), Layer(SOIL)]).is_homogeneous
    assert road == Pavement((Layer(ASPHALT, 0.08), Layer(SOIL)))


@pytest.mark.parametrize("thickness", [0, -0.1, math.nan, math.inf, "6 cm"])
def test_thickness_must_be_positive(thickness):
    with pytest.raises(
        InputError, match=f"layer 'top': thickness must be .* metres, got {thickness!r}; leave it out"
    ):
        Layer(ASPHALT, thickness, name="top")


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ([], "at least one layer"),
        ([Layer(ASPHALT), Layer(SOIL)], "layer 1"),
        ([Layer(ASPHALT, 0.1), Layer(SOIL, 1.0)], "must have no thickness"),
    ],
)
def test_refusals(layers, message):
    with pytest.raises(InputError, match=message):
        Pavement(layers)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: Bond(-1.0), "must be >= 0 Pa/m, got -1.0"),
        (lambda: Bond(math.nan), "must be >= 0 Pa/m"),
        (lambda: Bond("stiff"), "must be >= 0 Pa/m, got stiff"),
        (lambda: HALF_BONDED.stiffness, "no stiffness.*bond_limits"),
        (lambda: Pavement([Layer(ASPHALT, 0.1), Layer(SOIL, bond=HALF_BONDED)]), "got the bond half-bonded"),
        (lambda: Pavement([ASPHALT, Layer(SOIL)]), "layer 1 must be a Layer, got Elastic"),
        (lambda: Layer(5.4e9, 0.1, name="top"), "layer 'top': material must be Elastic, .*got float 5400000000.0"),
        (lambda: Layer("asphalt", 0.1), "material must be Elastic, .*got str 'asphalt'"),
        (lambda: Layer(ASPHALT, 0.1, bond="glued"), "BONDED, HALF_BONDED, FRICTIONLESS or Bond.*got 'glued'"),
        (lambda: Pavement([Layer(ASPHALT, 0.1), Layer(SOIL, bond=FRICTIONLESS)]), "no layer below it"),
        (lambda: Pavement([Layer(ASPHALT, 0.1), Layer(SOIL)], rigid_base=True), "needs a thickness"),
    ],
)
def test_bad_bonds_and_bases(build, message):
    with pytest.raises(InputError, match=message):
        build()


def test_bonds_in_words():
    assert str(BONDED) == "bonded"
    assert str(HALF_BONDED) == "half-bonded"
    assert str(FRICTIONLESS) == "frictionless"
    assert str(Bond(stiffness=1e9)) == "spring of 1000 MPa/m"


def test_bonded_layers_of_one_material_are_one():
    road = Pavement([Layer(ASPHALT, 0.04), Layer(ASPHALT, 0.04, bond=FRICTIONLESS), Layer(SOIL, 1.0), Layer(SOIL)])
    assert [layer.thickness for layer in road.distinct_layers] == [0.08, None]
    assert road.distinct_layers[0].bond == FRICTIONLESS
    assert not Pavement([Layer(SOIL, 0.1, bond=Bond(1e9)), Layer(SOIL)]).is_homogeneous
    assert not Pavement([Layer(SOIL, 0.1)], rigid_base=True).is_homogeneous


def test_a_layer_says_what_its_material_needs():
    solid = Prony(8e9, ((0.5, 0.1), (0.4, 1.0)), 0.35)
    fluid = Prony(8e9, ((1.0, 0.1),), 0.35)
    assert Pavement.half_space(solid).surface_material == Elastic(8e9, 0.35)
    assert Layer(ASPHALT).elastic == Layer(ASPHALT).resolved == ASPHALT
    assert Layer(fluid).resolved is fluid
    with pytest.raises(InputError, match=r"layer 'base' is viscoelastic \(Prony.*give the speed of the load"):
        _ = Layer(solid, 0.1, name="base").elastic

    class Mix:
        def at(self, temperature, *, extrapolate=False):
            return solid

        def __str__(self):
            return "mix"

    with pytest.raises(InputError, match=r"layer 'base' depends on temperature \(mix\).*Pavement.at_temperature"):
        _ = Layer(Mix(), 0.1, name="base").resolved


def test_half_bonded_interfaces_switch_together():
    road = Pavement([Layer(ASPHALT, 0.1, bond=HALF_BONDED), Layer(SOIL, 0.2, bond=HALF_BONDED), Layer(ASPHALT)])
    assert [[layer.bond for layer in limit.layers[:-1]] for limit in road.bond_limits] == [
        [BONDED, BONDED],
        [FRICTIONLESS, FRICTIONLESS],
    ]
    whole = Pavement([Layer(ASPHALT, 0.1, bond=Bond(1e10)), Layer(SOIL)])
    assert whole.bond_limits == (whole,)


def test_elastic_limits_of_a_viscoelastic_road():
    solid = Prony(8e9, ((0.5, 0.1), (0.4, 1.0)), 0.35)
    road = Pavement([Layer(solid, 0.1, name="top", bond=FRICTIONLESS), Layer(SOIL, 2.0)], rigid_base=True)
    assert road.is_viscoelastic
    for limit, modulus in ((road.glassy, 8e9), (road.rubbery, 8e8)):
        assert not limit.is_viscoelastic
        assert limit.layers[0].material.modulus == pytest.approx(modulus, rel=1e-12)
        assert limit.layers[0].material.poisson == 0.35
        # All else stays.
        assert limit.rigid_base
        assert limit.layers[1] == road.layers[1]
        assert (limit.layers[0].name, limit.layers[0].bond) == ("top", FRICTIONLESS)
    fluid = Pavement.half_space(Prony(8e9, ((1.0, 0.1),), 0.35))
    assert fluid.glassy == Pavement.half_space(Elastic(8e9, 0.35))
    with pytest.raises(InputError, match="no elastic limit"):
        _ = fluid.rubbery
