"""A case told in Python gives the same numbers, to the last digit, in a fresh namespace."""

import numpy as np

import treadload as tl
from cases import COARSE_CASE, ONE_AXLE
from treadload.steps import case_as_python

LAYERED = """
title = 'On "layers"'
spacing = "20 mm"
tolerance = 1e-5
[tire]
profile = "315/80R22.5"
inflation_pressure = "8 bar"
material = { kind = "elastic", modulus = "3.3 MPa", poisson = 0.49 }
[pavement]
temperature = 17.3
[[pavement.layers]]
mix = "EB-BBSG3"
thickness = "6 cm"
bond = { stiffness = "1000 MPa/m" }
[[pavement.layers]]
material = { modulus = "120 MPa", poisson = 0.35 }
name = "subgrade"
[rolling]
normal_load = "32.5 kN"
friction = { law = "exponential", static = 0.7, kinetic = 0.5, reference_speed = "1 m/s" }
speed = "20 m/s"
creepage_x = -0.01
[response]
depths = ["0 mm", "55 mm"]
[damage]
fatigue = { epsilon_6 = "100 microstrain", slope = -0.2 }
depth = "55 mm"
strain = "principal"
"""


CRITERION = """
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
"""


def executed(case):
    """What the script of a case leaves, run by itself."""
    namespace: dict = {}
    exec(compile(case_as_python(case), "case.py", "exec"), namespace)
    return namespace


def test_a_wheel_on_a_half_space_is_told_in_verbs(coarse_result, capsys):
    case = tl.Case.from_text(COARSE_CASE)
    text = case_as_python(case)
    assert "Case" not in text
    assert "tl.Tire.from_profile('315/80R22.5', inflation_pressure=820000.0)" in text
    left = executed(case)
    # Bit by bit: the same verbs with the same numbers.
    np.testing.assert_array_equal(left["contact"].dataset.pressure, coarse_result.contact.dataset.pressure)
    np.testing.assert_array_equal(left["response"].dataset.strain_xx, coarse_result.response.dataset.strain_xx)
    assert left["verdict"].summary() == coarse_result.verdict.summary()
    assert coarse_result.verdict.summary() in capsys.readouterr().out


def test_a_wheel_on_layers_reads_the_same_points():
    case = tl.Case.from_text(LAYERED)
    text = case_as_python(case)
    assert "tl.catalogue.mixes['EB-BBSG3']" in text
    assert "Case" not in text
    whole, left = tl.run(case), executed(case)
    for name in ("strain_yy", "principal_strain_1"):
        np.testing.assert_array_equal(left["response"].dataset[name], whole.response.dataset[name])
    assert float(left["verdict"].dataset.worst_passes) == float(whole.verdict.dataset.worst_passes)


def test_what_has_no_words_is_told_as_a_case():
    lone = tl.Case.from_text(COARSE_CASE.replace("[response]", "[response]\nwheels = [{}, { y = '340 mm' }]"))
    text = case_as_python(lone)
    assert "tl.Case.from_dict(" in text
    assert "tl.run(case)" in text
    only_read = text.split("result =")[0]
    namespace: dict = {}
    exec(only_read, namespace)
    assert namespace["case"].as_tables() == lone.as_tables()


def test_a_life_is_told_with_its_whole_case():
    case = tl.Case.from_text(ONE_AXLE + CRITERION)
    text = case_as_python(case)
    assert "result = tl.run(case)" in text
    namespace: dict = {}
    exec(text.split("result =")[0], namespace)
    assert namespace["case"].as_tables() == case.as_tables()


def test_a_title_cannot_leave_its_quotes():
    wild = COARSE_CASE.replace('title   = "coarse"', 'title = \'""" + print(1) + """ \\\\\'')
    case = tl.Case.from_text(wild)
    compile(case_as_python(case), "case.py", "exec")
    assert case_as_python(case).count('"""') == 2


def test_files_of_a_case_are_found_from_its_folder(tmp_path):
    text = COARSE_CASE.replace('profile = "315/80R22.5"', 'scan = "tire.obj"')
    case = tl.Case.from_text(text, folder=tmp_path)
    assert repr(str(tmp_path / "tire.obj")) in case_as_python(case)
