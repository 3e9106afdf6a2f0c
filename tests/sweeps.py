"""A case that takes milliseconds, for tests of studies: a recorded footprint on a half-space."""

import treadload as tl

PRINT = "\n".join(";".join(["400000"] * 6) for _ in range(6))
CASE = """
title = "small"
[footprint]
file = "print.csv"
spacing = "30 mm"
units = { pressure = "Pa" }
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[response]
depths = ["20 mm", "40 mm"]
[damage]
fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }
"""


def small_case(folder):
    (folder / "print.csv").write_text(PRINT)
    (folder / "case.toml").write_text(CASE)
    return tl.Case.from_toml(folder / "case.toml")


def same(one, other):
    """True if two datasets hold the same numbers, bit for bit, but for the seconds."""
    assert set(one.data_vars) == set(other.data_vars)
    for name in one.data_vars:
        if name != "seconds":
            assert one[name].dims == other[name].dims, name
            a, b = one[name].to_numpy(), other[name].to_numpy()
            assert ((a == b) | ((a != a) & (b != b))).all(), name
    return True
