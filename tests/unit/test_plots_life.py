"""Figures and the report of a life: what they show is what the data say."""

import warnings

import numpy as np
import pytest
from matplotlib.text import Text

from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchSubgrade, Traffic, Wander, miner
from treadload.errors import InputError
from treadload.life import Sensitivity
from treadload.plots import life_damage, life_inputs, life_shares, life_works, life_years
from treadload.reporting import write_report
from treadload.reporting.life import exhausted, life_report
from treadload.reporting.reading import ReportCase
from treadload.results import open_results, save_results, to_tree
from treadload.variables import dataset

LINE = FatigueLine(100e-6, -0.2)
CRITERIA = (Criterion("top-down", LINE, place="top"), Criterion("soil", FrenchSubgrade(), -1, "top"))
Y = np.arange(-40, 41) * 0.02


def a_life(years=20.0, passes=1e5):
    peaks = np.array([[[150e-6, 80e-6], [100e-6, 60e-6]], [[300e-6, 250e-6], [200e-6, 150e-6]]])
    values = peaks[..., None] * np.exp(-0.5 * (Y / 0.1) ** 2)
    classes = (AxleClass("light", 0.7, 20e3, 7e5), AxleClass("heavy", 0.3, 35e3, 8e5))
    traffic = Traffic(classes, passes, 0.02, wander=Wander.normal(0.2), years=years)
    angle = np.full(values.shape, np.pi / 2)
    dip = np.where(np.arange(2)[:, None, None, None] == 1, np.nan, np.pi / 2) * np.ones(values.shape)
    life = miner(values, CRITERIA, traffic, Climate.equal_parts([5.0, 25.0], ["cold", "warm"]), y=Y,
                 cracks=(angle, dip))  # fmt: skip
    return life


def a_tree(**asked):
    names = ["thickness of base", "temperature (per °C)", "passes"]
    more = dataset({"elasticity": (("input",), [3.0, -0.05, -0.8])}, {"input": names}, criterion="top-down",
                   coverage=0.9, contacts=3, responses=4)  # fmt: skip
    return to_tree([a_life(**asked), Sensitivity(more, "top-down", 0.9, 3, 4)], title="a road")


def test_bars_are_as_long_as_the_lives():
    life = a_life()
    ax = life_years(life).axes[0]
    bars = sorted(patch.get_width() for patch in ax.patches)
    assert bars == pytest.approx(sorted(life.dataset["life_years"].to_numpy()), rel=1e-9)
    assert any("design, 20 years" in text.get_text() for text in ax.texts)


def test_the_damage_is_that_of_the_design_life():
    life = a_life()
    lines = life_damage(life).axes[0].get_lines()
    peaks = [np.nanmax(line.get_ydata()) for line in lines if len(line.get_xdata()) > 2]
    assert peaks == pytest.approx(life.dataset["design_damage"].to_numpy(), rel=1e-9)
    words = [text.get_text() for text in life_damage(life).findobj(Text)]
    assert any("normal wander of 200 mm, except for laws that include it" in text for text in words)


def test_the_map_holds_the_shares():
    life = a_life()
    mesh = life_shares(life).axes[0].collections[0]
    share = life.dataset["damage_share"].sel(criterion=life.governing).to_numpy()
    assert np.asarray(mesh.get_array()) == pytest.approx(100 * share)
    assert float(np.sum(mesh.get_array())) == pytest.approx(100, rel=1e-9)
    with pytest.raises(InputError, match="no criterion 'nothing'"):
        life_shares(life, "nothing")


def with_works(tearing):
    works = dataset(
        {
            "largest_polishing_work": (("axle_class",), [1.5, 183.0]),
            "largest_tearing_work": (("axle_class", "season"), np.array(tearing)),
        },
        {"axle_class": ["light", "heavy"], "season": ["cold", "warm"]},
    )
    return a_life().dataset.merge(works)


@pytest.mark.usefixtures("figures_as_dots")
def test_the_works_are_those_of_each_class_and_season():
    tearing = [[2e-9, 4e-9], [0.02, 0.128]]
    data = with_works(tearing)
    bars, cells = life_works(data).axes
    assert [patch.get_width() for patch in bars.patches] == [1.5, 183.0]
    assert [text.get_text() for text in bars.texts[:2]] == ["1.5", "180"]
    # What is left of a wheel that rolls freely is drawn as nothing.
    assert [text.get_text() for text in cells.texts[:4]] == ["0", "0", "0.02", "0.13"]
    drawn = np.ma.asarray(cells.collections[0].get_array())
    assert drawn.mask.tolist() == [[True, True], [False, False]]
    assert drawn[1].tolist() == tearing[1]
    titles = [one.title for one in life_report("a road", data).pictures]
    assert titles.count("What polishes and tears the surface") == 1


@pytest.mark.usefixtures("figures_as_dots")
@pytest.mark.parametrize("nothing", [1e-10, np.nan])
def test_without_shear_there_is_no_figure_of_works(nothing):
    data = with_works([[nothing, nothing]] * 2)
    with pytest.raises(InputError, match="none shears a surface of known modulus"):
        life_works(data)
    with pytest.raises(InputError, match="largest_polishing_work"):
        life_works(a_life())
    titles = [one.title for one in life_report("a road", data).pictures]
    assert "What polishes and tears the surface" not in titles


def test_inputs_are_changed_by_five_per_cent_and_a_degree():
    bars = [patch.get_width() for patch in life_inputs(a_tree()["sensitivity"].to_dataset()).axes[0].patches]
    assert bars == pytest.approx([100 * (1.05**3 - 1), 100 * (np.exp(-0.05) - 1), 100 * (1.05**-0.8 - 1)])
    with pytest.raises(InputError, match="elasticity"):
        life_inputs(a_life())


def test_the_sentence_tells_the_margin():
    life = a_life(years=20.0, passes=1e3)
    used = float(life.dataset["design_damage"].sel(criterion=life.governing))
    assert f"20 years, reached with a damage of {used:.2g}" in life.rows()[-1].text
    assert not exhausted(life.dataset)
    early = a_life(passes=1e7)
    missing = 20 - early.years(early.governing)
    assert f"20 years, not reached: {missing:.3g} years too short" in early.rows()[-1].text
    assert exhausted(early.dataset)
    assert "no criterion fails" in a_life(passes=0.0).rows()[-1].text


@pytest.mark.usefixtures("figures_as_dots")
def test_the_report_holds_verdict_criteria_laws_and_solves(tmp_path):
    save_results(a_tree(), tmp_path / "life.nc")
    tree = open_results(tmp_path / "life.nc").tree
    written = life_report("a road", ReportCase.of("a road", tree).groups["life"])
    assert written.first is not None
    crack = written.first.columns.index("first crack")
    cracks = {line[0]: line[crack] for line in written.first.rows}
    assert set(cracks) == {"top-down", "soil"}
    assert cracks["top-down"].startswith("transverse (100 %")
    assert cracks["soil"] == "ruts, no crack"
    assert len(written.pictures) == 4
    page = write_report({"a road": tree}, tmp_path / "r.html").read_text()
    for words in (
        "depends most on thickness of base (+5 %)",
        "life +16 %",
        "NF P98-086",
        "Damage by axle class and season",
        "every axle",
    ):
        assert words in page


def test_a_life_of_one_place_is_drawn_without_a_range():
    """Every other place across was below what shows: matplotlib warned of equal limits."""
    life = a_life()
    damage = life.dataset["damage_per_year"]
    lone = life.dataset.assign(damage_per_year=damage.where(damage["y"] == damage["y"][40], 0.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        left, right = life_damage(lone).axes[0].get_xlim()
    assert left < right


def test_lists_of_a_life_are_lists_of_texts(tmp_path):
    """Torn ends of life and groups of wheels once were JSONDecodeErrors."""
    for name, told in (("ends", "["), ("groups", ""), ("ends", '["one of two"]')):
        tree = a_tree()
        tree["life"].attrs[name] = told
        with pytest.raises(InputError, match=f"the attribute {name} must"):
            write_report({"life": tree}, tmp_path / "life.html")


def test_the_table_of_works_prints_no_noise_of_a_wheel_that_rolls_freely():
    from treadload.reporting.life import _works

    data = with_works([[2e-10, 1e-10], [3e-3, 2e-4]])
    free, driven = _works(data)
    assert free[2:] == ("0", "–")
    assert driven[2] == "0.003"
    assert _works(data.assign(largest_polishing_work=data["largest_polishing_work"] * 0 + 3e-12))[0][1] == "0"
