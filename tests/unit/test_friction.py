"""Friction laws: their numbers, what they refuse, and how the wheel and the case speak of them."""

import math

import numpy as np
import pytest

from cases import COARSE_CASE
from treadload.case import Case
from treadload.contact import Rolling, solve_contact
from treadload.contact.friction import (
    Anisotropic,
    Coulomb,
    Exponential,
    FlashHeating,
    FrictionMap,
    Heat,
    LinearFalling,
    PressureDependent,
    Rational,
)
from treadload.contact.friction.heat import flash_temperature, strip_kernel
from treadload.contact.friction.laws import Interface
from treadload.errors import ConvergenceError, InputError
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.validation.tires import contact_conditions

RUBBER, ASPHALT = Heat(0.25, 2e6), Heat(1.2, 2.1e6)
FALLING = (LinearFalling, Rational, Exponential)


def interface(pressure, slip_x=0.0, slip_y=0.0, speed=10.0, dx=2e-3):
    pressure = np.atleast_2d(np.asarray(pressure, float))
    slip = np.stack([np.broadcast_to(slip_x, pressure.shape), np.broadcast_to(slip_y, pressure.shape)])
    ny, nx = pressure.shape
    return Interface(
        pressure,
        slip.astype(float),
        dx * (np.arange(nx) - (nx - 1) / 2),
        dx * (np.arange(ny) - (ny - 1) / 2),
        dx,
        speed,
    )


@pytest.mark.parametrize("law", [kind(0.9, 0.5, 2.0) for kind in FALLING])
def test_half_of_the_fall_is_gone_at_the_reference_speed(law):
    # A slip of (0.12, 0.16) at 10 m/s is 2 m/s.
    at = interface([1e5, 0.0], 0.12, 0.16)
    np.testing.assert_allclose(law.coefficient(at), 0.7, rtol=1e-12)
    np.testing.assert_allclose(law.bound(at), [[0.7e5, 0.0]], rtol=1e-12)
    assert law.coefficient(interface([1e5]))[0, 0] == 0.9
    assert law.coefficient(interface([1e5], 1e9))[0, 0] == pytest.approx(0.5, abs=1e-6)


def test_the_forms_of_falling_friction():
    at = interface(np.ones(4), np.array([0.1, 0.2, 0.4, 0.8]))
    np.testing.assert_allclose(LinearFalling(1.0, 0.0, 2.0).coefficient(at), [[0.75, 0.5, 0.0, 0.0]], atol=1e-15)
    np.testing.assert_allclose(Rational(1.0, 0.0, 2.0).coefficient(at), [[2 / 3, 1 / 2, 1 / 3, 1 / 5]])
    np.testing.assert_allclose(Exponential(1.0, 0.0, 2.0).coefficient(at), [[0.5**0.5, 0.5, 0.25, 0.0625]])


def test_rubber_falls_with_pressure_and_is_bounded_where_there_is_little():
    law = PressureDependent(0.8, 4e5, 1 / 3)
    mu = law.coefficient(interface([0.0, 1.0, 4e5, 32e5]))
    np.testing.assert_allclose(mu, [[1.6, 1.6, 0.8, 0.4]], rtol=1e-12)
    assert law.largest == 1.6
    assert PressureDependent(0.8, 4e5, 0.2, upper=1.0).coefficient(interface([1.0]))[0, 0] == 1.0


def test_an_ellipse_has_its_mean_and_its_axes():
    law = Anisotropic(0.9, 0.4, PressureDependent(0.5, 1e5, 0.0))
    mu = law.coefficient(interface([1e5]))[0, 0]
    assert mu == pytest.approx(0.3, rel=1e-12)
    assert np.array(law.axes) * mu == pytest.approx([0.45, 0.2], rel=1e-12)
    assert math.prod(law.axes) == pytest.approx(1.0)


def test_a_map_is_linear_between_its_centres_and_multiplies_its_base():
    values = np.array([[0.2, 0.4], [0.6, 0.8]])
    at = interface(np.ones((1, 5)), dx=0.5)
    np.testing.assert_allclose(FrictionMap(values, 1.0).coefficient(at), [[0.4, 0.4, 0.5, 0.6, 0.6]])
    np.testing.assert_allclose(FrictionMap(values, 1.0, base=Coulomb(2.0)).coefficient(at)[0, 2], 1.0)
    uneven = FrictionMap(values, x=[-0.5, 1.5], y=[-1.0, 1.0])
    np.testing.assert_allclose(uneven.coefficient(at), [[0.4, 0.4, 0.45, 0.5, 0.55]])
    path = FrictionMap([[0.3], [0.7]], 1.0)
    np.testing.assert_allclose(path.coefficient(interface(np.ones((1, 50)))), 0.5)


def test_maps_compare_and_print():
    a, b = FrictionMap(np.full((3, 2), 0.5), 0.1), FrictionMap(np.full((3, 2), 0.5), (0.1, 0.1))
    assert a == b
    assert hash(a) == hash(b)
    assert a != FrictionMap(np.full((3, 2), 0.5), 0.2)
    assert a != FrictionMap(np.full((3, 2), 0.5), 0.1, base=Coulomb(1.0))
    assert str(a) == "map 2 x 3, 0.5 to 0.5"
    with pytest.raises(ValueError, match="read-only"):
        a.values[0, 0] = 1.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([0.5, 0.6], 0.1), r"array \(ny, nx\)"),
        (([["a"]], 0.1), "array of numbers"),
        (([[0.5, math.nan]], 0.1), "row 0, column 1 .* is nan"),
        (([[0.5], [-0.1]], 0.1), "-0.1 in row 1, column 0"),
        (([[0.5]], 0.0), "positive number of metres"),
        (([[0.5]],), "either spacing"),
        (([[0.5]], 0.1, [0.0], [0.0]), "either spacing"),
        (([[0.5]], None, [0.0]), "both x and y"),
        (([[0.5, 0.6]], None, [0.0], [0.0]), "needs 2 of x, got 1"),
        (([[0.5, 0.6]], None, [1.0, 0.0], [0.0]), "ascending"),
        (([[0.5]], 0.1, None, None, 0.7), "must be a friction law"),
    ],
)
def test_maps_refuse(arguments, message):
    with pytest.raises(InputError, match=message):
        FrictionMap(*arguments)


def test_a_map_must_cover_the_contact():
    law = FrictionMap(np.full((4, 4), 0.5), 0.01)
    pressure = np.zeros((3, 9))
    pressure[1, 2:8] = 1.0
    with pytest.raises(InputError, match=r"x of the contact is -20.0 to 30.0 mm, of the map -20.0 to 20.0 mm"):
        law.coefficient(interface(pressure, dx=0.01))
    pressure[1, 6:] = 0.0
    assert law.coefficient(interface(pressure, dx=0.01)).shape == (3, 9)


def test_maps_from_files(tmp_path):
    values = np.array([[0.2, 0.4, 0.3], [0.6, 0.8, 0.7]])
    np.save(tmp_path / "a.npy", values)
    np.savetxt(tmp_path / "a.csv", values, delimiter=",")
    np.savetxt(tmp_path / "a.txt", values)
    maps = [FrictionMap.from_file(tmp_path / name, 0.1) for name in ("a.npy", "a.csv", "a.txt")]
    assert maps[0] == maps[1] == maps[2] == FrictionMap(values, 0.1)
    (tmp_path / "b.csv").write_text("0.1,wet\n")
    for name, message in (
        ("none.csv", "cannot read"),
        ("a.png", "not a friction map"),
        ("b.csv", "not a table of numbers"),
    ):
        with pytest.raises(InputError, match=message):
            FrictionMap.from_file(tmp_path / name, 0.1)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Coulomb(-0.1), "friction must be >= 0, got -0.1"),
        (lambda: Exponential(0.5, 0.9, 1.0), "at most the static, got 0.9 > 0.5"),
        (lambda: Rational(0.5, -0.1, 1.0), "kinetic friction must be >= 0"),
        (lambda: LinearFalling(math.nan, 0.1, 1.0), "static friction must be a finite"),
        (lambda: LinearFalling(0.5, 0.1, 0.0), "reference_speed must be a positive number of m/s, got 0"),
        (lambda: PressureDependent(0.5, 0.0, 0.1), "reference_pressure"),
        (lambda: PressureDependent(0.5, 1e5, 0.5), r"must lie in \[0, 1/3\], got 0.5"),
        (lambda: PressureDependent(0.5, 1e5, 0.1, 0.4), "at least the reference 0.5, got 0.4"),
        (lambda: Anisotropic(0.0, 0.5), "along travel"),
        (lambda: Anisotropic(0.5, math.inf), "across travel"),
        (lambda: Anisotropic(0.5, 0.5, 0.7), "must be a friction law"),
        (lambda: Heat(0.0, 1e6), "conductivity"),
        (lambda: Heat(1.0, -1e6), "heat_capacity"),
        (lambda: FlashHeating(0.7, RUBBER, ASPHALT, 0, 1, 0.5), "another friction law"),
        (lambda: FlashHeating(Coulomb(0.7), RUBBER, 1.0, 0, 1, 0.5), "road of flash heating"),
        (lambda: FlashHeating(Coulomb(0.7), RUBBER, ASPHALT, -1, 1, 0.5), "onset"),
        (lambda: FlashHeating(Coulomb(0.7), RUBBER, ASPHALT, 0, 0, 0.5), "span"),
        (lambda: FlashHeating(Coulomb(0.7), RUBBER, ASPHALT, 0, 1, 1.5), "hot"),
        (lambda: Anisotropic(1, 2, FlashHeating(Coulomb(1), RUBBER, ASPHALT, 0, 1, 0.5)), "put an ellipse inside it"),
        (lambda: Rolling(normal_load=1.0, friction="dry"), "a coefficient such as 0.7 or a friction law"),
        (lambda: Rolling(normal_load=1.0, friction=Exponential(0.9, 0.5, 1.0)), r"give the rolling speed \(m/s\)"),
    ],
)
def test_laws_refuse(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_laws_are_frozen_comparable_and_printable():
    assert Exponential(0.9, 0.5, 2.0) == Exponential(0.9, 0.5, 2.0)
    assert Exponential(0.9, 0.5, 2.0) != Rational(0.9, 0.5, 2.0)
    with pytest.raises(AttributeError):
        Coulomb(0.5).number = 0.6
    assert str(Exponential(0.9, 0.5, 2.0)) == "0.9 → 0.5 (Exponential, half-way at 2 m/s)"
    assert "μ = (0.9 along, 0.6 across)" in str(Rolling(normal_load=1e3, friction=Anisotropic(0.9, 0.6)))


def test_on_the_ellipse_the_direction_of_the_force_counts():
    law = Anisotropic(0.9, 0.4)
    Rolling(normal_load=1e3, friction=law, tractive_force=899.0).check_friction_limit(1e3)
    with pytest.raises(InputError, match="400 N"):
        Rolling(normal_load=1e3, friction=law, lateral_force=-401.0).check_friction_limit(1e3)
    # At 45°: 1/√(½/0.81 + ½/0.16) = 0.516930.
    with pytest.raises(InputError, match=r"gross sliding.*is 516.93 N"):
        Rolling(normal_load=1e3, friction=law, tractive_force=400.0, lateral_force=400.0).check_friction_limit(1e3)


def test_other_problems_know_coulomb_only():
    assert Rolling(normal_load=1e3, friction=Coulomb(0.6)).coefficient == 0.6
    with pytest.raises(InputError, match="Coulomb's friction only"):
        _ = Rolling(normal_load=1e3, friction=Anisotropic(0.9, 0.6)).coefficient


def test_flash_heating_finds_the_point_where_heat_and_friction_meet():
    """In every column, the coefficient it tells and the temperature that its own heat makes fit each other."""
    law = FlashHeating(Coulomb(0.8), RUBBER, ASPHALT, onset=20.0, span=30.0, hot=0.3)
    at = interface(np.full((1, 40), 8e5), -0.15, 0.1, speed=20.0)
    mu, rise = law.coefficient(at), law.temperature(at)
    flux = mu * at.pressure * np.hypot(0.15, 0.1) * 20.0
    np.testing.assert_allclose(
        flash_temperature(flux, at.dx, 20.0, RUBBER.effusivity + ASPHALT.effusivity), rise, rtol=1e-12
    )
    np.testing.assert_allclose(mu, 0.8 * (1 - 0.7 * np.clip((rise - 20.0) / 30.0, 0.0, 1.0)), rtol=1e-12)
    # Cold at the leading edge, on the line behind it; at a hundred times the pressure, hot.
    assert mu[0, -1] == 0.8
    assert 0.24 < mu[0].min() < 0.5
    assert law.coefficient(interface(np.full((1, 40), 4e7), -0.15, speed=20.0))[0, 0] == pytest.approx(0.24)


def test_flash_heating_needs_speed_enough():
    law = FlashHeating(Coulomb(0.8), RUBBER, ASPHALT, 20.0, 30.0, 0.3)
    with pytest.raises(InputError, match=r"at least 0.0029 m/s on cells of 2 mm, got 0.001 m/s"):
        law.coefficient(interface([1e5], speed=1e-3))
    with pytest.raises(InputError, match="needs the rolling speed"):
        law.coefficient(interface([1e5], speed=None))


def test_the_kernel_of_strips_sums_up_to_the_root_law():
    kernel = strip_kernel(100, 1e-3, 5.0, 2000.0)
    assert kernel.sum() == pytest.approx(2 * math.sqrt(99.5e-3 / (math.pi * 5.0)) / 2000.0, rel=1e-12)


def bowl(n=32, spacing=3e-3, radius=0.4):
    x = spacing * (np.arange(n) - (n - 1) / 2)
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius)


def drive(friction, poisson=0.5, **rolling):
    tire = Tire.from_height_map(bowl(), 3e-3, material=Elastic(3e6, poisson))
    wheel = Rolling(**{"normal_load": 150.0, "speed": 15.0, "friction": friction, **rolling})
    return solve_contact(tire, Pavement.half_space(Elastic(5.4e9, 0.35)), wheel)


LAWS = [
    Coulomb(0.6),
    Exponential(0.9, 0.5, 1.0),
    PressureDependent(0.7, 1e5, 0.2),
    Anisotropic(0.8, 0.5, Rational(1.0, 0.7, 1.0)),
    FrictionMap(np.linspace(0.4, 0.9, 11)[:, None], 0.01),
    FrictionMap(np.linspace(0.4, 0.9, 11)[:, None], 0.01, base=LinearFalling(1.0, 0.8, 2.0)),
    FlashHeating(Coulomb(0.8), RUBBER, ASPHALT, 1.0, 3.0, 0.5),
]


@pytest.mark.parametrize("poisson", [0.5, 0.45])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_a_whole_contact_with_every_law(law, poisson):
    contact = drive(law, poisson, tractive_force=40.0, lateral_force=-20.0)
    data = contact.dataset
    failed = [check for check in contact_conditions("", contact) if not check.passed]
    assert not failed, failed
    # The coefficient is the law's at the pressure and slip that were found.
    at = Interface(
        data.pressure.to_numpy(), np.stack([data.slip_x, data.slip_y]), data.x.values, data.y.values, 3e-3, 15.0
    )
    touching = data.pressure.to_numpy() > 0
    # Twice the tolerance of pressure and of friction, and the steepest law falls by 0.1 over a slip of 0.01.
    np.testing.assert_allclose(data.friction_coefficient.values[touching], law.coefficient(at)[touching], atol=2e-4)
    assert not data.friction_coefficient.values[~touching].any()
    assert float(data.friction) == pytest.approx(
        float((data.friction_coefficient * data.pressure).sum() / data.pressure.sum())
    )
    assert ("flash_temperature" in data) == isinstance(law, FlashHeating)
    assert "units" in data.friction_work.attrs


def test_work_and_power_of_friction():
    contact = drive(0.6, tractive_force=60.0)
    data = contact.dataset
    work = (data.traction_x * data.slip_x + data.traction_y * data.slip_y).values
    np.testing.assert_allclose(data.friction_work, work, atol=1e-9 * work.max())
    assert float(data.friction_work_total) == pytest.approx(work.sum() * contact.cell_area)
    np.testing.assert_allclose(data.friction_power, 15.0 * data.friction_work)
    assert float(data.friction_power_total) == pytest.approx(15.0 * float(data.friction_work_total))
    assert f"{float(data.friction_work_total):.3f} J/m" in contact.summary()
    assert " W" in contact.summary()
    assert "friction_power" not in drive(0.6, tractive_force=60.0, speed=None).dataset


def test_the_largest_force_counts_every_cell():
    law = FrictionMap([[0.2], [0.8]], 0.03)
    with pytest.raises(InputError, match="gross sliding") as caught:
        drive(law, tractive_force=100.0)
    # The map is 0.5 on the average of a symmetric patch.
    assert "75 N" in str(caught.value)


def test_a_force_that_friction_carries_at_rest_only():
    with pytest.raises(ConvergenceError, match="falls with slip"):
        drive(Exponential(0.9, 0.3, 0.05), tractive_force=120.0)


def in_a_case(friction, extra='speed = "20 m/s"'):
    return Case.from_text(COARSE_CASE.replace("friction       = 0.7", f"friction = {friction}\n{extra}"))


FLASH = (
    '{law = "flash", base = {law = "linear", static = 0.9, kinetic = 0.5, reference_speed = "2 m/s"}, onset = 50, '
    'span = 100, hot = 0.5, tire = {conductivity = "0.25 W/(m K)", heat_capacity = "2 MJ/(m^3 K)"}, '
    "road = {conductivity = 1.2, heat_capacity = 2.1e6}}"
)


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("0.7", 0.7),
        ('{law = "coulomb", coefficient = 0.7}', Coulomb(0.7)),
        ('{law = "linear", static = 0.9, kinetic = 0.5, reference_speed = 2}', LinearFalling(0.9, 0.5, 2.0)),
        ('{law = "rational", static = 0.9, kinetic = 0.5, reference_speed = "200 cm/s"}', Rational(0.9, 0.5, 2.0)),
        ('{law = "exponential", static = 0.9, kinetic = 0.5, reference_speed = 2}', Exponential(0.9, 0.5, 2.0)),
        (
            '{law = "pressure", reference = 1, reference_pressure = "7 bar", exponent = 0.2}',
            PressureDependent(1.0, 7e5, 0.2),
        ),
        ('{law = "anisotropic", along = 0.9, across = 0.5, base = 0.8}', Anisotropic(0.9, 0.5, Coulomb(0.8))),
        (FLASH, FlashHeating(LinearFalling(0.9, 0.5, 2.0), RUBBER, ASPHALT, 50.0, 100.0, 0.5)),
    ],
)
def test_laws_in_a_case(text, law):
    case = in_a_case(text)
    assert case.rolling.build().friction == law
    again = Case.from_text(case.to_toml())
    assert again == case
    assert again.rolling.build() == case.rolling.build()


def test_a_map_in_a_case_is_read_from_its_folder(tmp_path):
    np.save(tmp_path / "wet.npy", np.full((60, 60), 0.4))
    text = COARSE_CASE.replace("friction       = 0.7", 'friction = {law = "map", file = "wet.npy", cell = "10 mm"}')
    case = Case.from_text(text, folder=tmp_path)
    law = case.rolling.build(case.folder).friction
    assert law == FrictionMap(np.full((60, 60), 0.4), 0.01)
    assert Case.from_text(case.to_toml(), folder=tmp_path) == case


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{law = "exponental", static = 0.9}', r"rolling.friction: no law 'exponental'; did you mean 'exponential'"),
        ('{law = "frog"}', "known are anisotropic, coulomb, .*linear"),
        ("{static = 0.9}", "needs its name"),
        (
            '{law = "linear", statik = 0.9, kinetic = 0.5, reference_speed = 2}',
            r"unknown key 'rolling.friction.statik'; did you mean 'static'\?; 'rolling.friction.static' is missing",
        ),
        ('{law = "linear", static = 0.9, kinetic = 0.5, reference_speed = "2 mm"}', "'2 mm' as a quantity in m/s"),
        (FLASH.replace("kinetic", "knetic"), "unknown key 'rolling.friction.base.knetic'; did you mean 'kinetic'"),
        (FLASH.replace("2 MJ/(m^3 K)", "2 MJ"), "quantity in J/"),
        ('{law = "map", file = "none.csv", cell = "10 mm"}', "cannot read the friction map"),
        ('"slippery"', "cannot read 'slippery'"),
    ],
)
def test_bad_laws_in_a_case(text, message):
    with pytest.raises(InputError, match=message):
        in_a_case(text)


def test_a_law_of_speed_in_a_case_needs_the_speed():
    with pytest.raises(InputError, match="give the rolling speed"):
        in_a_case('{law = "linear", static = 0.9, kinetic = 0.5, reference_speed = 2}', extra="")
