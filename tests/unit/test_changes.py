"""Keys of a case set from outside."""

import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.case.changes import changed


@pytest.mark.parametrize(
    ("change", "read"),
    [
        ("rolling.friction=0.6", lambda case: case.rolling.friction == 0.6),
        ("rolling.normal_load=40 kN", lambda case: case.rolling.normal_load == 40e3),
        ('rolling.normal_load = "32,5 kN"', lambda case: case.rolling.normal_load == 32.5e3),
        ("response.depths=[0, '20 mm', 0.06]", lambda case: case.response.depths == (0.0, 0.02, 0.06)),
        ("response.depths.1=40 mm", lambda case: case.response.depths == (0.0, 0.04)),
        ("response.side=below", lambda case: case.response.side == "below"),
        ("pavement.layers.0.material.modulus=7 GPa", lambda case: case.pavement.layers[0].material.modulus == 7e9),
        ("pavement.layers.0.name=a = b", lambda case: case.pavement.layers[0].name == "a = b"),
        ("title=2024-01-01", lambda case: case.title == "2024-01-01"),
        (
            "tire.material={ kind = 'elastic', modulus = 3e6, poisson = 0.49 }",
            lambda c: c.tire.material.modulus == 3e6,
        ),
        ("rolling.tractive_force=", lambda case: case.rolling.tractive_force is None),
        ("damage=", lambda case: case.damage is None),
        ("footprint.file=x.csv", None),
    ],
)
def test_a_value_is_toml_or_text(change, read):
    if read is None:
        with pytest.raises(tl.InputError, match="replaces a tire"):
            tl.Case.from_text(COARSE_CASE, changes=[change])
        return
    case = tl.Case.from_text(COARSE_CASE, changes=[change])
    assert read(case)
    # The result keeps the case as it was run.
    assert tl.Case.from_text(case.to_toml()) == case


def test_changes_are_made_in_their_order_and_leave_the_tables_alone():
    table = {"rolling": {"friction": 0.7}}
    assert changed(table, ["rolling.friction=0.6", "rolling.friction=0.5", "spacing=3 mm"]) == {
        "rolling": {"friction": 0.5},
        "spacing": "3 mm",
    }
    assert table == {"rolling": {"friction": 0.7}}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("rolling.frictoin=0.6", r"unknown key 'rolling\.frictoin'; did you mean 'friction'"),
        ("rolng.friction=0.6", r"unknown key 'rolng'; did you mean 'rolling'"),
        ("rolling.friction", "write key=value"),
        ("=3", "write key=value"),
        ("rolling..friction=3", "write key=value"),
        ("pavement.layers.1.thickness=8 cm", "a list of 1, whose rows are 0 to 0, got '1'"),
        ("pavement.layers.first.thickness=8 cm", "got 'first'"),
        ("pavement.layers.-1.thickness=8 cm", "got '-1'"),
        ("pavement.layers.²=8", "got '²'"),
        ("spacing.x=3 mm", "spacing is '12 mm' and has no keys"),
        ("rolling.spin=", "the case does not give it; it has normal_load"),
        ("rolling.friction=0,700", None),
        ("rolling.normal_load=1,000 kN", "may mean 1000 or 1"),
    ],
)
def test_what_cannot_be_set_is_told_in_one_sentence(change, message):
    if message is None:
        assert tl.Case.from_text(COARSE_CASE, changes=[change]).rolling.friction == 0.7
        return
    with pytest.raises(tl.InputError, match=message) as refused:
        tl.Case.from_text(COARSE_CASE, changes=[change])
    assert "\n" not in str(refused.value)
