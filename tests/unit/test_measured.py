"""Files of measured viscoelasticity: columns, units, temperatures, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.materials import (
    FrequencySweep,
    RelaxationTest,
    read_isotherms,
    read_master_curve,
    read_shift_factors,
)

# DMTA of a polymer, NREL/pyvisco, BSD-3-Clause: see SOURCE.md beside.
DATA = Path(__file__).parents[1] / "data" / "viscoelastic"


def test_a_master_curve_in_frequency():
    curve = read_master_curve(DATA / "freq_user_master.csv", temperature=20.0)
    assert isinstance(curve, FrequencySweep)
    # The first row of the file: 1e-12 Hz, 88.79651575665739 and 10.502460140936773 MPa.
    assert curve.omega[0] == pytest.approx(2 * np.pi * 1e-12)
    assert curve.modulus[0] == pytest.approx(88.79651575665739e6 + 10.502460140936773e6j)
    assert curve.omega.size == 206
    assert curve.temperature == 20.0


def test_a_master_curve_in_time():
    curve = read_master_curve(DATA / "time_user_master.csv")
    assert isinstance(curve, RelaxationTest)
    assert (curve.time[0], curve.modulus[0]) == pytest.approx((0.00281764, 1714.266e6))


@pytest.mark.parametrize("name", ["freq_user_raw.csv", "time_user_raw.csv"])
def test_isotherms_behind_a_byte_order_mark(name):
    isotherms = read_isotherms(DATA / name)
    assert len(isotherms) == 21
    temperatures = [data.temperature for data in isotherms]
    assert temperatures == sorted(temperatures)
    # The means of sets 0 and 20 of the file.
    assert (temperatures[0], temperatures[-1]) == pytest.approx((-49.9094, 99.9852), abs=1e-3)


def test_rows_of_one_temperature_are_one_isotherm(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        "f,E_stor,E_loss,T\nrad/s,GPa,GPa,K\n1,2,0.1,293.15\n10,3,0.1,293.25\n1,1,0.1,313.15\n10,2,0.1,313\n"
    )
    cold, warm = read_isotherms(path)
    assert (cold.temperature, warm.temperature) == pytest.approx((20.05, 39.925))
    assert cold.omega == pytest.approx([1.0, 10.0])
    assert warm.storage == pytest.approx([1e9, 2e9])


def test_shift_factors():
    temperatures, logs = read_shift_factors(DATA / "time_user_raw__shift_factors.csv")
    assert logs[temperatures.index(3.0)] == 0.0
    assert len(logs) == 21


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("f,E_stor\nHz,MPa\n1,2\n2,3\n", "needs f, E_stor, E_loss"),
        ("f,E_stor,E_loss\nHz,psi,psi\n1,2,3\n2,3,4\n", "'psi'"),
        ("f,E_stor,E_loss\nHz,MPa,MPa\n1,2\n2,3,4\n", "row 3"),
        ("f,E_stor,E_loss\nHz,MPa,MPa\n1,two,3\n2,3,4\n", "two"),
        ("f,E_stor,E_loss\nHz,MPa,MPa\n1,2,-3\n2,3,4\n", "negative"),
        ("f,E_stor,E_loss\nHz,MPa,MPa\n1,-2,3\n2,3,4\n", "storage"),
        ("t,E_relax\ns,MPa\n0,2\n2,3\n", "time"),
        ("t,E_relax\ns,MPa\n1,2\n", "2 or more"),
        ("t,E_relax\n", "1 rows"),
        ("t,E_relax,T\ns,MPa,C\n1,2,20\n2,3,20\n", "read_isotherms"),
    ],
)
def test_bad_files(tmp_path, text, word):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=word):
        read_master_curve(path)


def test_files_without_temperature_or_not_there(tmp_path):
    with pytest.raises(InputError, match="column T"):
        read_isotherms(DATA / "freq_user_master.csv")
    with pytest.raises(InputError, match="cannot read"):
        read_master_curve(tmp_path / "none.csv")
    with pytest.raises(InputError, match="log_aT"):
        read_shift_factors(DATA / "freq_user_raw.csv")
    with pytest.raises(InputError, match="one length"):
        FrequencySweep([1.0, 2.0], [1.0], [1.0, 2.0])
