"""Tires as .tir files: read, refused, and evaluated by the Magic Formula."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.tire import MagicFormula

DATA = Path(__file__).parents[1] / "data" / "tir"
TEXTBOOK = Path(__file__).parents[2] / "examples" / "magic_formula" / "315_80R22_5_textbook.tir"
CALSPAN = DATA / "335_65R22_5_G275MSA_60psi.tir"
INVENTED = DATA / "invented_6_1.tir"

# Load over the nominal one, κ, α in rad, γ in rad, pressure over the nominal one; Fx, Fy in N, Mz, Mx and the rolling
# resistance moment in N m, ISO signs. Independent programs evaluated the same files:
# 5.2: OpenTirePython, class PAC2002 (MIT; github.com/OpenTire/OpenTirePython, commit 6652c490).
WITNESSES_5_2 = [
    (1.6, 0.02, 0.015, 0.05, 1, 9816.43157, -4561.07117, 100.008501, 0, 245.504),
    (1, 0.08, 0.04, -0.02, 1, 23649.4885, -5188.75293, -329.10837, 0, 153.44),
    (0.5, -0.03, -0.03, 0.05, 1, -8466.26565, 3072.52662, -151.904325, 0, 76.72),
    (1.6, -0.3, 0, 0.05, 1, -34731.4508, -1180.66934, 354.456506, 0, 245.504),
    (0.5, 0.08, -0.06, 0, 1, 13691.1326, 3182.96097, -152.505464, 0, 76.72),
    (1.6, -0.03, -0.01, -0.02, 1, -15917.1064, 2135.95497, 30.5928603, 0, 245.504),
    (1.4, -0.1, 0.06, 0, 1, -28678.6966, -12039.2406, 585.618019, 0, 214.816),
    (1, 0, 0.015, 0, 1, -452.252696, -3526.44575, 142.04077, 0, 153.44),
    (1, 0.25, 0.04, 0.03, 1, 25296.1206, -2325.35961, -205.435234, 0, 153.44),
    (1.4, 0.02, -0.01, 0.05, 1, 10361.454, 1596.4816, -218.548196, 0, 214.816),
]
# 6.1: MFeval.jl (MIT; github.com/matheusft/MFeval_julia, commit a3b3ba49), translated line by line by a script.
WITNESSES_6_1 = [
    (1, -0.1, 0.04, -0.06, 1.1, -3689.53194, -1214.97486, 9.14544447, 13.9634073, -53.9720942),
    (1.4, -0.3, -0.06, 0, 0.85, -5082.65434, 1237.17401, -23.2088543, 23.5036209, -119.458073),
    (0.5, 0, 0.06, 0, 1.1, -28.21093, -1455.04321, 18.449768, -17.6843119, 6.70318911),
    (1.6, 0.08, 0.015, 0, 1, 5931.46026, -802.357685, 53.2176584, -23.1981213, 189.789888),
    (0.8, 0, -0.01, -0.02, 1.1, -53.5909658, 435.083865, -13.4503412, 14.3678368, 9.77859987),
    (0.5, -0.3, -0.03, 0.05, 1.1, -1989.82611, 304.222428, -27.3425432, -14.2633191, -12.611563),
    (1.6, -0.1, 0.04, -0.02, 1, -5816.20489, -1635.32527, -22.7041217, -23.1019429, -146.413822),
    (0.5, 0.02, 0.04, 0.03, 0.85, 621.235993, -1271.37574, 22.4140565, -24.9777973, 14.8017111),
    (1, -0.1, 0.06, 0.05, 0.85, -3542.52187, -2058.05012, -34.3210234, -68.79586, -57.2546124),
    (1, 0.25, 0.04, 0.03, 1, 3889.51049, -831.127065, 37.3187019, -35.3658136, 87.4484534),
    (0.5, 0.08, 0, -0.06, 0.85, 1974.86638, 12.1112219, -2.84771117, 18.9167316, 30.2396404),
    (1, 0.08, 0, 0.03, 1.1, 3760.62509, -210.598151, 33.830496, -24.444945, 81.7396679),
    (1.4, -0.03, 0.015, 0, 0.85, -3184.67457, -943.651025, 9.96955963, -24.1940796, -67.7484084),
    (0.5, 0.02, -0.01, 0, 0.85, 704.98741, 269.185932, -2.78340552, 1.77652668, 15.6065328),
]
# Beyond 0.06 rad both programs take cos(tan α) where the book has the cosine of α: moments there differ by 8e-6 of
# load times radius at 0.3 rad, forces do not.
WIDE_6_1 = [
    (0.8, 0.02, 0.3, -0.02, 1, 262.540985, -3037.68896, -4.13715199, -37.1954625, 15.1201309),
    (1.4, 0.25, -0.3, 0, 1, 2850.44562, 3620.22307, 27.374941, 75.1419324, 90.4440618),
    (1, -0.3, -0.2, -0.02, 1.1, -2888.5673, 2086.05437, -0.282764605, 45.7537421, -39.9849371),
]
# MFeval.jl (commit 23fd9ff7), calc_Re, _rho_Rl_61 and calc_relax translated line by line: load over the nominal one,
# pressure over the nominal one, speed in m/s; deflection, loaded and effective radius, relaxation lengths, m.
FREE_6_1 = [
    (1.7, 1, 40.0, 0.0317156334, 0.285949963, 0.30733658, 0.366437395, 0.576665285),
    (0.3, 0.8, 5.0, 0.00766321768, 0.3085357, 0.308402479, 0.0830640126, 0.27136623),
    (1.4, 1, 5.0, 0.0287630298, 0.287436192, 0.306389986, 0.301609104, 0.568912458),
    (1.4, 1, 16.7, 0.027971236, 0.288465447, 0.306627447, 0.301609104, 0.568912458),
    (0.3, 1.15, 40.0, 0.00548750216, 0.312137794, 0.311579797, 0.0612886678, 0.193568977),
    (0.6, 0.8, 16.7, 0.0145523307, 0.30188365, 0.307041192, 0.160600039, 0.466369861),
]
# The same program, version 5.2, of the textbook set: load over the nominal one, relaxation lengths, m.
RELAXATION_5_2 = [
    (0.5, 0.361399703, 0.252923077),
    (1, 0.822, 0.453517241),
    (1.6, 1.12600342, 0.597139614),
]


def textbook():
    return MagicFormula.from_file(TEXTBOOK, signs="ISO")


def invented():
    return MagicFormula.from_file(INVENTED)


def with_coefficients(tire, **values):
    """The tire with other coefficients, wherever they stand."""
    sections = {
        name: {key: values.get(key, value) for key, value in entries.items()}
        for name, entries in tire.sections.items()
    }
    return replace(tire, sections=sections)


def edited(tmp_path, change, source=INVENTED):
    path = tmp_path / "tire.tir"
    path.write_text(change(source.read_text(encoding="utf-8")), encoding="utf-8")
    return path


def off(tire, witness):
    """Differences from a witness: forces over the load, moments over load times radius."""
    share, slip, angle, lean, pressure, *expected = witness
    load = share * tire.nominal_load
    out = tire.forces(
        load, slip=slip, slip_angle=-angle, inclination=lean, inflation_pressure=pressure * tire.nominal_pressure
    )
    # The files are ISO: y to the left, z up.
    numbers = [
        out.tractive_force, -out.lateral_force, -out.aligning_moment, out.overturning_moment,
        out.rolling_resistance_moment,
    ]  # fmt: skip
    lever = tire.unloaded_radius
    return np.abs(np.array(numbers) - expected) / load / [1, 1, lever, lever, lever]


@pytest.mark.parametrize("witness", WITNESSES_5_2)
def test_version_5_2_is_that_of_an_independent_program(witness):
    assert off(textbook(), witness).max() < 1e-6


@pytest.mark.parametrize("witness", WITNESSES_6_1)
def test_version_6_1_is_that_of_an_independent_program(witness):
    assert off(invented(), witness).max() < 1e-6


@pytest.mark.parametrize("witness", WIDE_6_1)
def test_wide_angles_differ_in_the_cosine_of_a_moment_only(witness):
    differences = off(invented(), witness)
    assert np.delete(differences, 2).max() < 1e-6
    assert differences[2] < 1e-5


@pytest.mark.parametrize("witness", FREE_6_1)
def test_free_rolling_of_6_1_is_that_of_an_independent_program(witness):
    share, pressure, speed, *expected = witness
    tire = invented()
    out = tire.free_rolling(
        share * tire.nominal_load, inflation_pressure=pressure * tire.nominal_pressure, speed=speed
    )
    found = [
        out.deflection, out.loaded_radius, out.effective_rolling_radius, out.relaxation_length_x,
        out.relaxation_length_y,
    ]  # fmt: skip
    # The program ends its iteration of the radius at 1e-9 m.
    np.testing.assert_allclose(found, expected, rtol=1e-8)


@pytest.mark.parametrize("witness", RELAXATION_5_2)
def test_relaxation_of_5_2_is_that_of_an_independent_program(witness):
    share, *expected = witness
    out = textbook().free_rolling(share * 35e3)
    np.testing.assert_allclose([out.relaxation_length_x, out.relaxation_length_y], expected, rtol=1e-8)
    # Without Q_FZ2 the load is the stiffness times the deflection.
    assert out.deflection == pytest.approx(share * 35e3 / 1e6, rel=1e-12)


def test_deflection_is_a_root_of_the_load():
    tire = invented()
    c = {**tire.sections["VERTICAL"]}
    load = np.linspace(500, 9e3, 9)
    x = tire.free_rolling(load, speed=1e-9).deflection / tire.unloaded_radius
    first = math.sqrt((c["VERTICAL_STIFFNESS"] * tire.unloaded_radius / 4e3) ** 2 - 4 * c["Q_FZ2"])
    np.testing.assert_allclose((first * x + c["Q_FZ2"] * x**2) * 4e3, load, rtol=1e-7)
    # The slope at the nominal load is the vertical stiffness.
    near = tire.free_rolling([3999.0, 4001.0], speed=1e-9).deflection
    assert 2 / float(np.diff(near)[0]) == pytest.approx(c["VERTICAL_STIFFNESS"], rel=1e-5)


def test_free_rolling_asks_for_what_it_lacks(tmp_path):
    def without(text):
        return text.replace("VERTICAL_STIFFNESS = 200000\n", "").replace("LATERAL_STIFFNESS = 103000\n", "")

    with pytest.raises(InputError, match="no VERTICAL_STIFFNESS above 0"):
        MagicFormula.from_file(edited(tmp_path, without)).free_rolling(4e3)
    half = MagicFormula.from_file(
        edited(tmp_path, lambda text: text.replace("LATERAL_STIFFNESS = 103000\n", ""))
    ).free_rolling(4e3)
    assert half.relaxation_length_y is None
    assert half.relaxation_length_x > 0
    bent = edited(tmp_path, lambda text: text.replace("Q_FZ2 = 14.3", "Q_FZ2 = -40"))
    with pytest.raises(InputError, match=r"cannot carry 20000 N: .* ends near 1\.03e\+04 N; give a smaller load"):
        MagicFormula.from_file(bent).free_rolling([4e3, 20e3])
    steep = edited(tmp_path, lambda text: text.replace("Q_FZ2 = 14.3", "Q_FZ2 = 80"))
    with pytest.raises(InputError, match=r"Q_FZ2 must be 62\.8 at most .*Q_FZ2 = 80"):
        MagicFormula.from_file(steep).free_rolling(4e3)
    with pytest.raises(InputError, match="normal_load must be > 0 N, got 0"):
        invented().free_rolling(0.0)


def test_methods_of_a_tire_are_cited():
    from treadload.citations import CITATIONS

    assert "(2012)" in CITATIONS[textbook().cites()[0]]
    assert [key for key in invented().cites() if "48(S1), 337-352" in CITATIONS[key]]


def test_the_textbook_tire_has_the_stiffnesses_that_its_numbers_are_cited_with():
    tire = textbook()
    along, across, aligning = tire.slopes(tire.nominal_load)
    assert along / tire.nominal_load == pytest.approx(14.85, abs=0.01)
    assert across / tire.nominal_load == pytest.approx(5.66, abs=0.01)
    assert aligning / across == pytest.approx(0.047, abs=0.0005)
    text = tire.summary()
    assert "35.00 kN" in text
    assert "548.0 mm" in text
    assert "version 5.2, ISO signs" in text


def test_signs_are_those_of_treadload():
    tire = textbook()
    load = tire.nominal_load
    assert tire.forces(load, slip=0.05).tractive_force > 0.5 * load  # drives
    right = tire.forces(load, slip_angle=0.05)  # the wheel moves to the right: the road pushes to the left
    assert right.lateral_force < -0.2 * load
    # behind the centre, so that the moment about z (down) turns the wheel to where it moves
    assert right.aligning_moment > 0
    upright, leaning = tire.forces(load), tire.forces(load, inclination=0.05)
    assert leaning.lateral_force > upright.lateral_force  # leans to the right
    assert upright.rolling_resistance_moment > 0


def test_slip_zero_leaves_the_shifts_and_nothing_else():
    tire = invented()
    shifts = ("PHX", "PVX", "PHY", "PVY", "QHZ", "QDZ6", "QDZ7", "RHX", "RHY", "QSX1")
    plain = with_coefficients(tire, **{name: 0.0 for name in tire.coefficients if name.startswith(shifts)})
    load = np.array([1e3, 4e3, 7e3])
    rolling = plain.forces(load)
    for values in (
        rolling.tractive_force,
        rolling.lateral_force,
        rolling.aligning_moment,
        rolling.overturning_moment,
    ):
        assert np.abs(values).max() < 1e-12 * load.max()
    c = tire.coefficients
    df = load / tire.nominal_load - 1
    slip = -(c["PHX1"] + c["PHX2"] * df)
    rise = load * (c["PVX1"] + c["PVX2"] * df)
    assert tire.forces(load, slip=slip).tractive_force == pytest.approx(rise, rel=1e-12)


def test_no_force_exceeds_friction_and_large_slip_tends_to_the_sine_of_the_shape():
    tire = textbook()
    load, slip = tire.nominal_load, np.linspace(-60, 60, 4001)
    along, _ = tire.friction(load)
    force = tire.forces(load, slip=slip).tractive_force
    c = tire.coefficients
    assert np.abs(force).max() <= along * load * (1 + 1e-4)
    far = tire.forces(load, slip=1e9).tractive_force
    assert far == pytest.approx(along * load * math.sin(c["PCX1"] * math.pi / 2), rel=1e-3)


def test_combined_slip_leaves_pure_slip_where_the_second_one_is_zero():
    tire = with_coefficients(invented(), RHX1=0.0, RHY1=0.0, RHY2=0.0, RVY1=0.0, RVY2=0.0, RVY3=0.0)
    load, slip = 4e3, np.linspace(-0.2, 0.2, 9)
    pure = with_coefficients(tire, RBX1=0.0, RBX3=0.0, RBY1=0.0, RBY4=0.0)
    assert tire.forces(load, slip=slip).tractive_force == pytest.approx(
        pure.forces(load, slip=slip).tractive_force, rel=1e-13
    )
    both, alone = tire.forces(load, slip=0.1, slip_angle=slip), pure.forces(load, slip=0.1, slip_angle=slip)
    assert (np.abs(both.tractive_force) <= np.abs(alone.tractive_force) * (1 + 1e-13)).all()
    assert (np.abs(both.lateral_force) <= np.abs(alone.lateral_force) * (1 + 1e-13)).all()


def test_the_opposite_side_is_the_mirror_image():
    tire = invented()
    mirror = tire.mirrored()
    assert (tire.side, mirror.side) == ("left", "right")
    state = {"slip": 0.04, "slip_angle": np.array([-0.1, 0.0, 0.05]), "inclination": 0.03}
    facing = {"slip": 0.04, "slip_angle": -state["slip_angle"], "inclination": -0.03}
    here, there = tire.forces(5e3, **state), mirror.forces(5e3, **facing)
    for name, sign in (
        ("tractive_force", 1), ("lateral_force", -1), ("aligning_moment", -1), ("overturning_moment", -1),
        ("rolling_resistance_moment", 1),
    ):  # fmt: skip
        assert getattr(there, name) == pytest.approx(sign * getattr(here, name), rel=1e-13)
    again = mirror.mirrored().forces(5e3, **state)
    assert again.lateral_force == pytest.approx(here.lateral_force, rel=1e-13)


def test_systems_of_axes_describe_the_same_tire():
    tire = invented()
    state = {"slip": 0.03, "slip_angle": np.array([-0.2, 0.01, 0.06]), "inclination": -0.04}
    wanted = tire.forces(5e3, **state)
    c = tire.coefficients
    # In adapted SAE, α is that of ISO while F_y and M_z turn round.
    turned = [name for name in c if name.startswith(("PKY1", "PKY6", "PKY7", "PVY", "RVY1", "RVY2", "RVY3", "QDZ"))]
    turned = [name for name in turned if name not in ("QDZ1", "QDZ2", "QDZ3", "QDZ4")]
    turned += ["QBZ10", "SSZ1", "SSZ3", "SSZ4", "QSX3", "QSX9", "QSX13", "QSX14"]
    sections = {
        name: {key: -value if key in turned else value for key, value in entries.items()}
        for name, entries in tire.sections.items()
    }
    adapted = replace(tire, sections=sections, signs="adapted SAE")
    for name in ("tractive_force", "lateral_force", "aligning_moment", "overturning_moment"):
        assert getattr(adapted.forces(5e3, **state), name) == pytest.approx(getattr(wanted, name), rel=1e-12)
    # The same numbers under SAE: everything sideways is the mirror image, but for the lean, which both count alike.
    there = replace(tire, signs="SAE").forces(5e3, slip=0.03, slip_angle=-state["slip_angle"], inclination=-0.04)
    assert there.lateral_force == pytest.approx(-wanted.lateral_force, rel=1e-13)
    assert there.aligning_moment == pytest.approx(-wanted.aligning_moment, rel=1e-13)


def test_pressure_changes_what_the_coefficients_say():
    tire = invented()
    soft, hard = (tire.forces(4e3, slip_angle=0.01, inflation_pressure=p).lateral_force for p in (180e3, 260e3))
    assert hard != pytest.approx(soft, rel=1e-3)
    nominal = tire.forces(4e3, slip_angle=0.01, inflation_pressure=220e3).lateral_force
    assert nominal == tire.forces(4e3, slip_angle=0.01).lateral_force
    # PPX1 and PPX2 are those of the slope along travel.
    dp = 0.1
    steps = np.array([-1e-5, 1e-5])
    rise = np.diff(tire.forces(4e3, slip=steps, inflation_pressure=(1 + dp) * 220e3).tractive_force)
    ratio = rise / np.diff(tire.forces(4e3, slip=steps).tractive_force)
    assert ratio == pytest.approx(1 - 0.34 * dp + 0.07 * dp**2, rel=1e-4)


def test_units_of_the_file_are_converted(tmp_path):
    def in_pieces(text):
        pairs = {
            "'meter'": "'mm'", "'newton'": "'kilonewton'", "'Pascal'": "'bar'",
            "UNLOADED_RADIUS = 0.317": "UNLOADED_RADIUS = 317", "FNOMIN = 4000": "FNOMIN = 4",
            "NOMPRES = 220000": "NOMPRES = 2.2", "LONGVL = 16.7": "LONGVL = 16700",
            "VERTICAL_STIFFNESS = 200000": "VERTICAL_STIFFNESS = 0.2",
        }  # fmt: skip
        for old, new in pairs.items():
            assert old in text
            text = text.replace(old, new)
        return text

    def in_inches(text):
        text = text.replace("'meter'", "'inch'").replace("'newton'", "'pound_force'")
        return text.replace("RADIUS = 0.317", "RADIUS = 12.480315").replace("FNOMIN = 4000", "FNOMIN = 899.2358")

    state = {"slip": 0.03, "slip_angle": 0.05, "inclination": 0.02, "speed": 20.0}
    wanted = invented().forces(5e3, inflation_pressure=200e3, **state)
    for change, close in ((in_pieces, 1e-12), (in_inches, 1e-6)):
        tire = MagicFormula.from_file(edited(tmp_path, change))
        speed = 20.0 if change is in_pieces else 20.0 * 0.0254
        out = tire.forces(5e3, inflation_pressure=200e3, **state | {"speed": speed})
        for name in vars(wanted):
            assert getattr(out, name) == pytest.approx(getattr(wanted, name), rel=close)
    assert "200 N/mm" in MagicFormula.from_file(edited(tmp_path, in_pieces)).summary()


def test_a_maker_s_file_states_what_is_doubtful():
    tire = MagicFormula.from_file(CALSPAN)
    assert (tire.version, tire.signs, tire.side) == ("5.2", "ISO", "")
    assert tire.deflection.shape == (2, 21)  # the first of two tables
    assert tire.deflection[1, -1] == pytest.approx(54758.0)
    text = " ".join(tire.warnings)
    assert "is given twice" in text
    assert "5.0" in text
    assert "Default value" in text
    assert tire.forces(tire.nominal_load, slip=0.1).tractive_force > 0
    with pytest.raises(InputError, match="FE_METHOD = 'NO'"):
        tire.forces(tire.nominal_load, slip=0.1, slip_angle=0.1)


def test_signs_unsaid_are_asked_for(tmp_path):
    with pytest.raises(InputError, match='signs="ISO"'):
        MagicFormula.from_file(TEXTBOOK)
    with pytest.raises(InputError, match=r"PKY1 must be positive, got -10\.289"):
        MagicFormula.from_file(TEXTBOOK, signs="adapted SAE")
    with pytest.raises(InputError, match="ISO, SAE, adapted SAE"):
        MagicFormula.from_file(TEXTBOOK, signs="DIN")
    with pytest.raises(InputError, match="states ISO signs and the caller SAE"):
        MagicFormula.from_file(INVENTED, signs="sae")
    both = edited(tmp_path, lambda text: "! SAE J670\n" + text)
    with pytest.raises(InputError, match="states SAE and ISO signs"):
        MagicFormula.from_file(both)
    assert MagicFormula.from_file(both, signs="ISO").signs == "ISO"
    named = edited(tmp_path, lambda text: text.replace("ISO 8855", "SAE"))
    assert MagicFormula.from_file(named).signs == "SAE"


@pytest.mark.parametrize(
    ("comment", "signs"),
    [
        ("rolling resistance after ISO 28580, SAE J2452", None),
        ("ISO/TS 28580", None),
        ("isotropic rubber", None),
        ("ISO 8855", "ISO"),
        ("ISO-W", "ISO"),
        ("MF-TYRE 5.0 (W-axis system)", "ISO"),
        ("axes: SAE J670", "SAE"),
        ("SAE axes", "SAE"),
        ("adapted SAE", "adapted SAE"),
    ],
)
def test_a_standard_of_measurement_states_no_signs(tmp_path, comment, signs):
    def change(text):
        text = text.replace("Signs: ISO 8855.", comment)
        return text.replace("PKY1 = -16.3", "PKY1 = 16.3") if signs == "adapted SAE" else text

    path = edited(tmp_path, change)
    if signs is None:
        with pytest.raises(InputError, match="does not state its signs"):
            MagicFormula.from_file(path)
    else:
        assert MagicFormula.from_file(path).signs == signs


SECTIONS = [line for line in INVENTED.read_text(encoding="utf-8").splitlines() if line.startswith("[")]


@pytest.mark.parametrize("section", [name for name in SECTIONS if name != "[MDI_HEADER]"])
def test_a_file_that_ends_before_a_section_is_refused(tmp_path, section):
    cut = edited(tmp_path, lambda text: text[: text.index(section)])
    with pytest.raises(InputError, match=r"cut off|no FITTYP"):
        MagicFormula.from_file(cut)


@pytest.mark.parametrize("key", ["PCX1", "PKX3", "RHX1", "PKY2", "RVY6", "QBZ1", "QHZ4", "SSZ4"])
def test_a_file_that_ends_in_a_section_is_refused(tmp_path, key):
    whole = INVENTED.read_text(encoding="utf-8")
    place = whole.index(f"\n{key} =")
    cut = edited(tmp_path, lambda text: text[:place])
    with pytest.raises(InputError, match="cut off"):
        MagicFormula.from_file(cut)
    cut = edited(tmp_path, lambda text: text[: place + 4])
    with pytest.raises(InputError, match="cut off"):
        MagicFormula.from_file(cut)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("FITTYP = 61", "FITTYP = 62", "FITTYP = 62 is another version"),
        ("FITTYP = 61", "PROPERTY_FILE_FORMAT = 'PAC94'", "the format 'PAC94'"),
        ("ANGLE = 'radians'", "ANGLE = 'degree'", "ANGLE = 'radian'"),
        ("LENGTH = 'meter'", "LENGTH = 'cubit'", "line 7: LENGTH = 'cubit' .* inch"),
        ("LENGTH = 'meter'", "", "LENGTH = 'meter'"),
        ("PKX1 = 19.5", "PKX1 = 19.5.1", "PKX1 is '19.5.1'"),
        ("PKX1 = 19.5", "PKX1 = inf", "PKX1 is 'inf'"),
        ("PKX1 = 19.5", "PKX1 = 19.5\nPKX1 = 20", "PKX1 = 20 is already given in line"),
        ("PKX1 = 19.5", "PKX1 19.5", "neither KEY = value nor a row"),
        ("PKY1 = -16.3", "PKY1 = 16.3", "PKY1 must be negative, got 16.3"),
        ("NOMPRES = 220000", "", "NOMPRES"),
        ("LMX = 1", "LMX = 1\nLMUV = 0.1", "LMUV"),
        ("FNOMIN = 4000", "FNOMIN = -4000", "FNOMIN must be"),
        ("FNOMIN = 4000", "FNOMIN =", "no FNOMIN"),
        ("FITTYP = 61", "FITTYP = 52", "whose equations have no PEY5"),
        ("PRESSURE = 'Pascal'", "", None),
        ("LENGTH = 'meter'", "LENGTH = 'METRE'", None),
    ],
)
def test_what_cannot_be_evaluated_is_refused(tmp_path, old, new, words):
    path = edited(tmp_path, lambda text: text.replace(old, new, 1))
    if words is None:
        assert MagicFormula.from_file(path).nominal_pressure == 220e3
        return
    with pytest.raises(InputError, match=words):
        MagicFormula.from_file(path)


def test_pressure_without_a_unit_needs_si(tmp_path):
    def change(text):
        return text.replace("PRESSURE = 'Pascal'", "").replace("'meter'", "'mm'").replace("= 0.317", "= 317")

    with pytest.raises(InputError, match="write PRESSURE = 'pascal'"):
        MagicFormula.from_file(edited(tmp_path, change))


@pytest.mark.parametrize("content", [b"", b"\0\1\2", b"x = 1\n", b"just words\n"])
def test_another_file_is_refused(tmp_path, content):
    path = tmp_path / "tire.tir"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"give a \.tir file"):
        MagicFormula.from_file(path)
    with pytest.raises(InputError, match="cannot read"):
        MagicFormula.from_file(tmp_path / "none.tir")


@pytest.mark.parametrize(
    ("state", "words"),
    [
        ({"normal_load": 0.0}, "normal_load must be > 0 N, got 0"),
        ({"normal_load": [1e3, math.nan]}, "normal_load must be finite"),
        ({"slip_angle": 1.6}, "within ±1.5708 rad, got 1.6"),
        ({"slip": "much"}, "slip must be numbers"),
        ({"inflation_pressure": -1.0}, "inflation_pressure must be > 0 Pa, got -1"),
    ],
)
def test_states_that_no_wheel_has_are_refused(state, words):
    with pytest.raises(InputError, match=words):
        invented().forces(**{"normal_load": 4e3} | state)


def test_states_broadcast():
    out = invented().forces(np.array([[2e3], [4e3]]), slip=np.linspace(-0.1, 0.1, 3), slip_angle=0.02)
    assert all(values.shape == (2, 3) for values in vars(out).values())


def test_a_file_without_moments_of_lean_and_rolling_has_none(tmp_path):
    def change(text):
        start, end = text.index("[OVERTURNING"), text.index("[LATERAL")
        text = text[:start] + text[end:]
        start, end = text.index("[ROLLING"), text.index("[ALIGNING")
        return text[:start] + text[end:]

    out = MagicFormula.from_file(edited(tmp_path, change)).forces(4e3, slip=0.1)
    assert out.overturning_moment is None
    assert out.rolling_resistance_moment is None
    assert tl.tire.MagicFormula is MagicFormula
