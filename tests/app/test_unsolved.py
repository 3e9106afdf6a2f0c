"""What a case asks for and the page does not solve is named, whatever the case may learn besides."""

import pytest
import tomli_w

from treadload.app.form import Form
from treadload.app.unsolved import left_out, unsolved, unsolved_sentence
from treadload.case import Case
from treadload.steps.crossing import CrossingStep


def case_with(**tables):
    return Case.from_dict({**Form.first().table, **tables})


def test_the_first_case_is_solved_whole():
    assert unsolved(Case.from_dict(dict(Form.first().table))) == []
    assert unsolved_sentence(Form.first("life").check(".").case) == ""
    assert unsolved_sentence(None) == ""


def test_every_step_is_solved_at_once_or_named():
    """Whatever a case learns: no table is dropped in silence."""
    wheel = {"fatigue": {"epsilon_6": 1e-4, "slope": -0.2}}
    tables = {
        "passes": {}, "crossing": {"step": {"rise": "2 mm"}}, "response": {"depths": [0.0]}, "damage": wheel,
        "aggregates": {
            "material": {"kind": "elastic", "modulus": "60 GPa", "poisson": 0.2}, "fraction": 0.2,
            "radii": ["4 mm"], "window": {"length": "24 mm", "width": "24 mm", "depth": "12 mm"},
        },
    }  # fmt: skip
    layers = [{**layer} for layer in Form.first().table["pavement"]["layers"]]
    layers[1] = {**layers[1], "plasticity": {"kind": "mohr-coulomb", "cohesion": "1 MPa", "friction_angle": "35 deg"}}
    layers[1]["material"] = {"kind": "elastic", "modulus": "500 MPa", "poisson": 0.35}
    layers[1].pop("mix", None)
    case = case_with(pavement={"layers": layers}, **tables)
    assert unsolved(case) == ["[passes]", "[aggregates]", "[crossing]"]
    assert left_out(case) == ("bowl", "slices", "passes", "aggregates", "crossing")
    kinds = {type(step).name for step in case.steps}
    assert kinds == {"contact", "response", "damage", *left_out(case)}


def test_an_error_estimate_is_solved():
    damage = dict(Form.first().table["damage"])
    assert unsolved(case_with(damage={**damage, "error_estimate": True})) == []


def test_a_texture_under_the_tire_is_solved_and_a_patch_is_not():
    spectrum = {"size": "20 mm", "spacing": "1 mm", "hurst": 0.8, "shortest": "4 mm", "rms_height": "0.2 mm"}
    resolved = case_with(texture={**spectrum, "resolved": True})
    assert unsolved(resolved) == []
    rubber = {"kind": "elastic", "modulus": "3 MPa", "poisson": 0.5}
    assert unsolved(case_with(texture={**spectrum, "rubber": rubber})) == ["[texture]"]


def test_the_sentence_names_the_tables_and_the_command():
    case = case_with(crossing={"step": {"rise": "10 mm"}})
    assert isinstance(case.crossing, CrossingStep)
    said = unsolved_sentence(case)
    assert "[crossing]" in said
    assert "`treadload run case.toml`" in said
    damage = {**Form.first().table["damage"], "error_estimate": True}
    assert "[crossing]" in unsolved_sentence(case_with(crossing={"step": {"rise": "10 mm"}}, damage=damage))


ABOVE = """() => {
  const box = of => document.querySelector(of)?.getBoundingClientRect();
  const note = box("#unsolved"), row = box("[data-row=normal_load]");
  return note && row && note.height > 0 && row.height > 0 && note.bottom <= row.top;
}"""


@pytest.mark.browser
def test_what_is_not_solved_stands_above_the_numbers(visit):
    """Below all of them it lay outside of a window of usual height."""
    crossing = tomli_w.dumps(
        {**Form.first().table, "spacing": "16 mm", "crossing": {"joint": {"width": "18 mm", "depth": "30 mm"}}}
    )
    visit.chosen("open a TOML …", {"name": "a.toml", "mimeType": "text/plain", "buffer": crossing.encode()})
    note = visit.page.locator("#verdict > #card + #unsolved")
    note.wait_for()
    assert note.inner_text().startswith("This page did not solve [crossing]. Take the TOML home and run `treadload")
    # In one look, since the panel is drawn again while the case is solved.
    visit.page.wait_for_function(ABOVE)
