"""Layers by their role: the lowest asphalt layer, the subgrade; and keys of layers by the layers' names."""

import pytest

import treadload as tl
from cases import ONE_AXLE
from treadload.case.keys import find_key
from treadload.errors import InputError
from treadload.pavement.roles import layer_of_role

ASPHALT, SOFT, STIFF = tl.Elastic(6e9, 0.35), tl.Elastic(300e6, 0.35), tl.Elastic(9e9, 0.25)
SOIL = tl.Layer(tl.Elastic(60e6, 0.4), name="soil")


def road(*layers):
    return tl.Pavement([*(tl.Layer(material, 0.1, name=name) for name, material in layers), SOIL])


def test_catalogued_materials_are_known_by_what_they_are():
    french = tl.Pavement.from_catalogue("6 BBSG3 / 10 GB3 / 15 GC-T3 / PF3")
    assert layer_of_role(french, "lowest asphalt layer") == 1
    assert layer_of_role(french, "Lowest cement-bound layer") == 2
    assert layer_of_role(french, "top of the subgrade") == layer_of_role(french, "subgrade") == 3
    assert layer_of_role(french, "top layer") == layer_of_role(french, "surface layer") == 0
    assert layer_of_role(french, "EB-GB3") is None


def test_elastic_layers_are_known_by_their_names():
    several = road(("asphalt 1", ASPHALT), ("asphalt 2", ASPHALT), ("cement-treated", STIFF), ("gravel", SOFT))
    assert layer_of_role(several, "lowest asphalt layer") == 1
    assert layer_of_role(several, "lowest cement-bound layer") == 2
    # Cracked asphalt may be as soft as a base.
    assert layer_of_role(road(("old asphalt", SOFT), ("base", SOFT)), "lowest asphalt layer") == 0
    # An old asphalt road under a new base is the lowest one.
    assert (
        layer_of_role(road(("overlay", ASPHALT), ("base", SOFT), ("asphalt", ASPHALT)), "lowest asphalt layer") == 2
    )


def test_what_may_be_either_and_what_is_not_there_are_errors():
    with pytest.raises(
        InputError, match=r"layer 2 'base'.*may be asphalt or bound by cement.*\"asphalt\" or \"cement"
    ):
        layer_of_role(road(("asphalt", ASPHALT), ("base", STIFF)), "lowest asphalt layer")
    with pytest.raises(InputError, match=r"no layer of the road is asphalt.*1 'gravel', 2 'soil'"):
        layer_of_role(road(("gravel", SOFT)), "lowest asphalt layer")
    with pytest.raises(InputError, match="bound by cement, so that it has no lowest cement-bound layer"):
        layer_of_role(road(("asphalt", ASPHALT)), "lowest cement-bound layer")


def test_a_criterion_names_a_role_and_a_layer_of_that_name_comes_first():
    criterion = (
        '[[criteria]]\nname = "base"\nlaw = "french-bituminous"\nrisk = 0.05\nlayer = "lowest asphalt layer"\n'
    )
    case = tl.Case.from_text(ONE_AXLE + criterion)
    assert case.build_criteria()[0].layer == 1
    three = ONE_AXLE.replace("6 BBSG3 / 15 GB3", "6 BBSG3 / 8 GB3 / 8 GB3") + criterion
    assert tl.Case.from_text(three).build_criteria()[0].layer == 2
    layers = """[[pavement.layers]]
        name = "subgrade"
        thickness = 0.2
        mix = "EB-GB3"
        [[pavement.layers]]
        name = "soil"
        material = { kind = "elastic", modulus = 6e7, poisson = 0.4 }
        """
    named = ONE_AXLE.replace('pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }', "") + layers
    named = tl.Case.from_text(named + criterion.replace("lowest asphalt layer", "subgrade"))
    assert named.build_criteria()[0].layer == 0
    with pytest.raises(InputError, match="did you mean 'lowest asphalt layer'"):
        tl.Case.from_text(ONE_AXLE + criterion.replace("lowest asphalt layer", "lowest asfalt layer"))


LAYERS = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
rolling = { normal_load = "30 kN", friction = 0.7 }
[pavement]
temperature = 15
[[pavement.layers]]
name = "old asphalt"
thickness = "10 cm"
material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 }
[[pavement.layers]]
name = "base"
thickness = "10 cm"
mix = "EB-GB3"
[[pavement.layers]]
name = "soil"
material = { kind = "elastic", modulus = "60 MPa", poisson = 0.4 }
"""


def test_keys_of_layers_by_their_names():
    case = tl.Case.from_text(LAYERS)
    assert find_key(case, "thickness Old Asphalt") == "pavement.layers.0.thickness"
    assert find_key(case, "modulus soil") == "pavement.layers.2.material.modulus"
    assert find_key(case, "mix base") == "pavement.layers.1.mix"
    with pytest.raises(InputError, match="no layer has the name 'sol'; did you mean 'soil'"):
        find_key(case, "modulus sol")
    twice = tl.Case.from_text(LAYERS.replace('"base"', '"soil"'))
    with pytest.raises(InputError, match=r"2 layers have the name 'soil'; write pavement\.layers\.1\.thickness"):
        find_key(twice, "thickness soil")
    with pytest.raises(InputError, match="the case has no key 'frictoin'"):
        find_key(case, "frictoin")


def test_a_layer_whose_modulus_depends_on_stress_is_not_asphalt():
    granular = tl.materials.StressDependent(tl.materials.KTheta(60e6, 0.5))
    layered = tl.Pavement([tl.Layer(ASPHALT, 0.1, name="asphalt"), tl.Layer(granular, 0.3, name="base"), SOIL])
    assert layer_of_role(layered, "lowest asphalt layer") == 0
