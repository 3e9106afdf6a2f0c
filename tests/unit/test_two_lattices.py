"""Verdicts of cases under the mean of two lattices of cells."""

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE
from sweeps import same
from treadload.errors import InputError
from treadload.steps import loaded

FATIGUE = "slope = -0.2 }"


def asked(what):
    assert FATIGUE in COARSE_CASE
    return COARSE_CASE.replace(FATIGUE, f"{FATIGUE}\n{what}")


def test_a_case_reads_two_lattices_unless_told_otherwise():
    """Its digits are those of the verbs and of a sweep, and not those of one lattice."""
    case = tl.Case.from_text(COARSE_CASE)
    result = tl.run(case)
    both = float(result.verdict.dataset["worst_passes"])
    assert result.verdict.dataset.attrs["lattices"] == 2
    assert "the mean of two contacts whose grids are offset by half a cell" in result.summary()
    one = tl.run(tl.Case.from_text(asked("lattices = 1"))).verdict
    assert float(one.dataset["worst_passes"]) != pytest.approx(both, rel=1e-3)
    assert "half a cell" not in one.summary()

    line = case.damage.fatigue.build()
    assert float(one.dataset["worst_passes"]) == pytest.approx(
        float(tl.assess(result.response, line).dataset["worst_passes"]), rel=1e-12
    )
    shifted = tl.solve_contact(
        case.build_tire(), case.build_road(), case.build_rolling(), spacing=case.spacing,
        tolerance=case.source.tolerance_of(case), offset=(0.5, 0.5),
    )  # fmt: skip
    verdict = tl.assess(result.response, line, shifted=shifted)
    assert float(verdict.dataset["worst_passes"]) == pytest.approx(both, rel=1e-12)
    for wrong, words in (
        ({"shifted": shifted, "depth": 0.0}, "points at a depth belong to the cells of one contact"),
        ({"shifted": [shifted, shifted]}, r"the response has 1 load\(s\), but 2 shifted"),
        ({"shifted": tl.UniformRectangle(0.2, 0.2, 8e5)}, "a disc or a rectangle has no cells"),
    ):
        with pytest.raises(InputError, match=words):
            tl.assess(result.response, line, **wrong)
    mean = tl.solve_response(result.contact, case.build_road(), depths=[0.0], mean_over=0.01)
    with pytest.raises(InputError, match="with a response of solve_response at points"):
        tl.assess(mean, line, shifted=shifted)

    swept = tl.sweep(case, {"rolling.normal_load": [case.rolling.normal_load]}).dataset
    # Both are searched from means over the same points, solved together there and one by one here.
    assert float(swept["worst_passes"].squeeze()) == pytest.approx(both, rel=1e-4)


@pytest.mark.parametrize(("more", "solves"), [({}, 2), ({"error_estimate": True}, 4)])
def test_a_study_of_the_verdict_alone_solves_each_contact_once(more, solves, monkeypatch):
    """Both lattices, and both of the coarser cells: the numbers of every case are those of a study of it alone."""
    table = tl.Case.from_text(COARSE_CASE.replace('["0 mm", "20 mm"]', '["0 mm"]')).as_tables()
    case = tl.Case.from_dict({**table, "damage": {**table["damage"], **more}})
    solved = []
    original = loaded.solve_contact
    monkeypatch.setattr(loaded, "solve_contact", lambda *args, **how: solved.append(how) or original(*args, **how))
    key, slopes = "damage.fatigue.slope", [-0.2, -0.25]
    study = tl.sweep(case, {key: slopes}).dataset
    assert len(solved) == solves
    assert sum(how["offset"] != (0.0, 0.0) for how in solved) == solves // 2
    for slope in slopes:
        alone = tl.sweep(case, {key: [slope]}).dataset
        assert same(alone.isel({key: 0}, drop=True), study.sel({key: slope}, drop=True))
    assert len(solved) == 3 * solves
    strain = study["worst_strain"].to_numpy()
    assert strain[0] == strain[1] > 0
    # The law of the case: (strain / epsilon_6)^(1 / slope) million passes.
    assert study["worst_passes"].to_numpy() == pytest.approx(
        1e6 * (strain / 120e-6) ** (1 / np.array(slopes)), rel=1e-9
    )


def test_one_contact_twice_is_that_contact():
    case = tl.Case.from_text(COARSE_CASE)
    contact = tl.solve_contact(case.build_tire(), case.build_road(), case.build_rolling(), spacing=case.spacing)
    response = tl.solve_response(contact, case.build_road(), depths=[0.0])
    line = case.damage.fatigue.build()
    twice, once = tl.assess(response, line, shifted=contact), tl.assess(response, line)
    assert float(twice.dataset["worst_strain"]) == pytest.approx(float(once.dataset["worst_strain"]), rel=1e-9)


def test_what_has_one_lattice_is_read_on_it(tmp_path):
    """A height map is not known between its cells: no second lattice by default, and none can be asked for."""
    rise = 1e3 * np.add.outer(np.linspace(-0.1, 0.1, 41) ** 2, np.linspace(-0.1, 0.1, 41) ** 2)
    np.savetxt(tmp_path / "map.csv", rise, delimiter=",")
    case = {
        "tire": {"height_map": "map.csv", "cell": 5e-3, "units": "mm", "inflation_pressure": 8e5},
        "pavement": {"layers": [{"material": {"modulus": 5e9, "poisson": 0.35}}]},
        "rolling": {"normal_load": 5e3, "friction": 0.5},
        "damage": {"fatigue": {"epsilon_6": 120e-6, "slope": -0.2}},
    }
    verdict = tl.run(tl.Case.from_dict(case, folder=tmp_path)).verdict
    assert "lattices" not in verdict.dataset.attrs
    case["damage"]["lattices"] = 2
    with pytest.raises(InputError, match="a height map has one lattice of cells"):
        tl.run(tl.Case.from_dict(case, folder=tmp_path))
    with pytest.raises(InputError, match="depth reads the points of one lattice of cells"):
        tl.Case.from_text(asked('lattices = 2\ndepth = "0 mm"'))
