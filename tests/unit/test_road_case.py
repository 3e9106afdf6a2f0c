"""The road of a case: structures and mixes, temperatures, viscoelastic materials, wheels, footprints."""

import math

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from cases import COARSE_CASE
from treadload.materials import (
    WLF,
    Arrhenius,
    HuetSayegh,
    Model2S2P1D,
    PowerLawCreep,
    Prony,
    QuadraticShift,
    TabulatedShift,
    Thermorheological,
)
from treadload.pavement import HALF_BONDED, layer_rows
from treadload.reporting import write_report

HEAD = COARSE_CASE[: COARSE_CASE.index("[[pavement.layers]]")]
TAIL = COARSE_CASE[COARSE_CASE.index("[rolling]") :]
STRUCTURE = '[pavement]\nstructure = "6 BBSG3 / 15 GB3 / PF3"\ntemperature = 15\n\n'
MIXES = """
[pavement]
temperature = [35, "308.15 K", 15]
frequency = "10 Hz"

[[pavement.layers]]
mix = "EB-BBSG3"
thickness = "60 mm"
bond = "half-bonded"

[[pavement.layers]]
name = "base"
mix = "EB-GB3"
thickness = "150 mm"

[[pavement.layers]]
mix = "PF3"

"""
HUET = (
    'material = { kind = "huet-sayegh", glassy_modulus = "40995 MPa", static_modulus = "18 MPa", delta = 2.356, '
    'k = 0.186, h = 0.515, tau = "9.381 s", poisson = 0.35, '
    'shift = { kind = "quadratic", a1 = -0.3996, a2 = 0.00152 } }'
)


def case_of(pavement, tail=TAIL):
    return tl.Case.from_text(HEAD + pavement + tail)


def viscoelastic(material, temperature="temperature = 15\n", speed="speed = 20\n"):
    pavement = f'[pavement]\n{temperature}[[pavement.layers]]\nthickness = "80 mm"\n{material}\n'
    pavement += '[[pavement.layers]]\nmaterial = { modulus = "120 MPa", poisson = 0.35 }\n\n'
    return pavement, TAIL.replace("depths", f"{speed}depths")


def written_back(case):
    again = tl.Case.from_text(case.to_toml())
    assert again == case
    return again


def test_a_catalogued_structure_at_a_temperature():
    case = case_of(STRUCTURE)
    road = written_back(case).pavement.build()
    assert road == tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    # NF P98-086, E(15 °C, 10 Hz).
    assert [row.modulus for row in layer_rows(road)] == pytest.approx([7000e6, 9000e6, 120e6], rel=1e-9)
    assert case.pavement.layer_temperatures() == [15, 15, None]


def test_mixes_with_a_temperature_a_layer():
    case = case_of(MIXES)
    road = written_back(case).pavement.build()
    assert [layer.name for layer in road.layers] == ["EB-BBSG3", "base", "PF3"]
    assert road.layers[0].bond == HALF_BONDED
    # Half-way between the moduli printed for 30 and 40 °C: 1800 and 1000, 2700 and 1000 MPa.
    assert [row.modulus for row in layer_rows(road)] == pytest.approx([1400e6, 1850e6, 120e6])
    assert case.pavement.layer_temperatures() == [35, 35, None]


def test_a_temperature_over_depth():
    text = MIXES.replace('[35, "308.15 K", 15]', '{ depths = ["0 mm", "210 mm"], values = ["40 degC", 19] }')
    case = case_of(text)
    # Linear between them: middles at 30 and 135 mm.
    assert case.pavement.layer_temperatures() == pytest.approx([37, 26.5, None])
    assert written_back(case).pavement.build() == case.pavement.build()


def test_frequency_reads_the_mixes_elsewhere():
    slow = case_of(MIXES.replace('"10 Hz"', "1")).pavement.build()
    assert slow.layers[0].material == tl.catalogue.mixes["EB-BBSG3"].at(35, frequency=1.0)


def test_extrapolation_only_when_asked_for():
    text = MIXES.replace('[35, "308.15 K", 15]', "48")
    with pytest.raises(tl.InputError, match=r"48 °C lies outside its data, -10 to 40 °C"):
        case_of(text)
    hot = case_of(text.replace("temperature", "extrapolate = true\ntemperature")).pavement.build()
    assert hot.layers[0].material.modulus < 1000e6


MATERIALS = {
    'material = { kind = "prony", modulus = "10 GPa", terms = [[0.9, "10 ms"]], poisson = 0.3 }': Prony(
        10e9, ((0.9, 0.01),), 0.3
    ),
    HUET.split(", shift")[0] + " }": HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 9.381, 0.35),
    (
        'material = { kind = "2s2p1d", glassy_modulus = "40 GPa", static_modulus = "18 MPa", delta = 2.3, k = 0.2, '
        'h = 0.5, beta = 300, tau = "10 ms", poisson = 0.35 }'
    ): Model2S2P1D(40e9, 18e6, 2.3, 0.2, 0.5, 300, 0.01, 0.35),
    (
        'material = { kind = "power-law-creep", instantaneous_compliance = "2.5e-5 1/MPa", '
        "long_term_compliance = 1e-8, tau = 1000, exponent = 0.35, poisson = 0.3 }"
    ): PowerLawCreep(2.5e-11, 1e-8, 1000, 0.35, 0.3),
}


@pytest.mark.parametrize("material", MATERIALS)
def test_viscoelastic_materials(material):
    case = case_of(*viscoelastic(material, ""))
    assert written_back(case).pavement.build().layers[0].material == MATERIALS[material]
    assert case.speed == 20


SHIFTS = {
    '{ kind = "wlf", c1 = 15, c2 = "120 K", reference = 10 }': WLF(15, 120, 10),
    '{ kind = "arrhenius", activation_energy = "200 kJ/mol", reference = "10 degC" }': Arrhenius(200e3, 10),
    '{ kind = "quadratic", a1 = -0.4, a2 = 0.0015 }': QuadraticShift(-0.4, 0.0015),
    '{ kind = "table", temperatures = [0, 30], log_factors = [2, -2], reference = 15 }': TabulatedShift(
        (0, 30), (2, -2), 15
    ),
}


@pytest.mark.parametrize("shift", SHIFTS)
def test_shifts_make_materials_wait_for_their_temperature(shift):
    material = HUET[: HUET.index("shift")] + f"shift = {shift} }}"
    case = case_of(*viscoelastic(material, "temperature = 25\n"))
    waiting = case.pavement.untempered().layers[0].material
    assert waiting == Thermorheological(HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 9.381, 0.35), SHIFTS[shift])
    assert written_back(case).pavement.build().layers[0].material == waiting.at(25)


def test_tested_temperatures_of_a_shift():
    material = HUET.replace("a2 = 0.00152", "a2 = 0.00152, tested = [0, 30]")
    with pytest.raises(tl.InputError, match="tested from 0 to 30 °C, got 35 °C"):
        case_of(*viscoelastic(material, "temperature = 35\n"))
    assert case_of(*viscoelastic(material, "temperature = 35\nextrapolate = true\n")).pavement.build()


def test_a_published_material_is_the_paper_s():
    case = case_of(*viscoelastic('material = { kind = "published", name = "ViscoRoute" }'))
    row = layer_rows(written_back(case).pavement.build(), case.pavement.layer_temperatures())[0]
    # The modulus that its source gives at 15 °C and 10 Hz.
    assert row.modulus == pytest.approx(11356e6, rel=1e-4)
    assert (row.frequency, row.temperature) == (10.0, 15.0)


def test_speed_of_the_response_before_that_of_rolling():
    pavement, tail = viscoelastic(HUET, speed="")
    tail = tail.replace("[rolling]", "[rolling]\nspeed = 20")
    assert case_of(pavement, tail).speed == 20
    assert case_of(pavement, tail.replace("depths", 'speed = "36 km/h"\ndepths')).speed == 10


def test_contact_on_layers_is_asked_for_at_the_top():
    case = written_back(tl.Case.from_text('road_compliance = "layers"\n' + HEAD + STRUCTURE + TAIL))
    assert case.road_compliance == "layers"
    with pytest.raises(tl.InputError, match=r"road_compliance: Input should be 'half_space' or 'layers'"):
        tl.Case.from_text('road_compliance = "layer"\n' + HEAD + STRUCTURE + TAIL)


@pytest.mark.slow
def test_contact_on_layers_gives_way_a_little_more():
    coarse = (HEAD + STRUCTURE + TAIL).replace('"12 mm"', '"20 mm"')
    shares = []
    for word in ("layers", "half_space"):
        result = tl.run(tl.Case.from_text(f'road_compliance = "{word}"\n{coarse}'))
        assert result.contact.stats["layers_solved"] == (word == "layers")
        shares.append(float(result.contact.dataset.approach))
    # The layers give way more than the stiff top one alone, but next to nothing beside the tire.
    assert 1 < shares[0] / shares[1] < 1.01


def test_wheels_stand_on_the_cells_of_the_first():
    wheels = 'wheels = [{ y = "-170 mm" }, { x = "4 mm", y = "170 mm", mirror = true }]\ndepths'
    case = written_back(case_of(STRUCTURE, TAIL.replace("depths", wheels)))
    load = tl.response.GridLoad.from_arrays([[1.0, 2.0], [0.0, 3.0]], traction_y=np.ones((2, 2)), spacing=0.012)
    left, right = case.response.place(load)
    assert left.grid.y0 == pytest.approx(load.grid.y0 - 0.17)
    apart = (right.grid.y0 - left.grid.y0) / 0.012
    assert apart == pytest.approx(round(0.34 / 0.012), abs=1e-9)
    # 4 mm is nearer to no cell than to one.
    assert right.grid.x0 == pytest.approx(left.grid.x0)
    np.testing.assert_array_equal(right.array[0], load.array[0][::-1])
    np.testing.assert_array_equal(right.array[2], -load.array[2])


def test_slices_reach_below_the_last_interface_but_not_below_rock():
    response = case_of(STRUCTURE).response
    assert response.slices_to([], rigid_base=False) == 0.06
    assert response.slices_to([0.06, 0.2], rigid_base=False) == pytest.approx(0.25)
    assert response.slices_to([0.06, 0.2], rigid_base=True) == 0.2
    assert response.slices_to([3.0], rigid_base=True) == 0.6


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('structure = "6', 'structure = "B', "pavement: no structure .*; did you mean '[68] BBSG3 / 15 GB3 / PF3'"),
        ("15 GB3", "15 GB9", "pavement: no structure .*; as layers it cannot be read: no mix 'GB9'; did you mean"),
        ("structure", "struture", r"unknown key 'pavement\.struture'; did you mean 'structure'"),
        ("temperature = 15", "", r"pavement: the road needs a temperature.*EB-BBSG3"),
        ("temperature = 15", "temperature = 288", r"hotter than 100 °C; if it is in kelvin"),
        ("temperature = 15", 'temperature = "15 mm"', r"pavement\.temperature: cannot read '15 mm'"),
        ("temperature = 15", "temperature = [15, 15]", "one for each of the 3 layers"),
        (
            "temperature = 15",
            "temperature = { depth = [0, 1], values = [1, 2] }",
            r"unknown key 'pavement\.temperature\.depth'; did you mean 'depths'",
        ),
        ("temperature = 15", "temperature = 15\nrigid_base = true", "rigid_base belongs to layers"),
        ("temperature = 15", "temperature = 15\n[[pavement.layers]]\nmix = 'PF3'", "got both of them"),
    ],
)
def test_bad_structures(old, new, message):
    assert old in STRUCTURE
    with pytest.raises(tl.InputError, match=message):
        case_of(STRUCTURE.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('mix = "EB-GB3"', 'mix = "EB-GB9"', r"pavement.*EB-GB9.*EB-GB"),
        ('mix = "EB-GB3"', "", r"pavement\.layers\.1: .*either a material or the name of a mix, got none"),
        ('mix = "EB-GB3"', 'mix = "EB-GB3"\nmaterial = { modulus = 1e9, poisson = 0.3 }', "got both of them"),
        ("half-bonded", "half bonded", "'half-bonded'"),
        ("temperature = [35", "temperature = [450", "kelvin"),
    ],
)
def test_bad_mixes(old, new, message):
    assert old in MIXES
    with pytest.raises(tl.InputError, match=message):
        case_of(MIXES.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("huet-sayegh", "huet-sayeg", "no material of the kind 'huet-sayeg'; did you mean 'huet-sayegh'"),
        ('kind = "quadratic"', 'kind = "arhenius"', "no shift of the kind 'arhenius'; did you mean 'arrhenius'"),
        ("a1 =", "a_1 =", r"unknown key 'pavement\.layers\.0\.material\.shift\.a_1'; did you mean 'a1'"),
        ("delta =", "dleta =", r"unknown key 'pavement\.layers\.0\.material\.dleta'; did you mean 'delta'"),
        ("k = 0.186", "k = 0.9", "0 < k < h < 1"),
        ('"9.381 s"', '"9.381 m"', r"pavement\.layers\.0\.material\.tau: cannot read '9.381 m'"),
    ],
)
def test_bad_viscoelastic_materials(old, new, message):
    assert old in HUET
    with pytest.raises(tl.InputError, match=message):
        case_of(*viscoelastic(HUET.replace(old, new)))


def test_what_changes_nothing_is_refused():
    elastic = COARSE_CASE[COARSE_CASE.index("[[pavement.layers]]") : COARSE_CASE.index("[rolling]")]
    with pytest.raises(tl.InputError, match="temperature changes nothing here"):
        case_of(f"[pavement]\ntemperature = 15\n{elastic}")
    with pytest.raises(tl.InputError, match="frequency changes nothing here"):
        case_of(f"[pavement]\nfrequency = 15\n{elastic}")
    asphalt = viscoelastic(HUET, "temperature = 15\nfrequency = 10\n")
    with pytest.raises(tl.InputError, match="frequency changes nothing here"):
        case_of(*asphalt)


@pytest.mark.parametrize(
    ("response", "message"),
    [
        ("wheels = []", "wheels needs at least one wheel"),
        ("wheels = [{ y = 0.1 }, { y = 0.1 }]", "two of the wheels are at the same place"),
        ("wheels = [{ z = 0.1 }]", r"unknown key 'response\.wheels\.0\.z'"),
        ("speed = -1", "speed must be >= 0 m/s, got -1"),
        ('side = "under"', r"response\.side: Input should be 'above' or 'below'"),
        ("slice_depth = 0", "slice_depth must be a positive number of metres, got 0; leave it out"),
    ],
)
def test_bad_responses(response, message):
    with pytest.raises(tl.InputError, match=message):
        case_of(STRUCTURE, TAIL.replace("depths", f"{response}\ndepths"))


def footprint(tmp_path, extra=""):
    # 3 x 2 cells of 10 mm under 700 kPa but for one.
    (tmp_path / "stress.csv").write_text("700,700,700\n700,0,700\n")
    spot = f'[footprint]\nfile = "stress.csv"\nunits = {{ pressure = "kPa" }}\nspacing = "10 mm"\n{extra}\n'
    text = spot + STRUCTURE + TAIL[TAIL.index("[response]") :]
    return tl.Case.from_text(text, folder=tmp_path)


def test_a_recorded_footprint_in_place_of_a_tire(tmp_path):
    case = footprint(tmp_path)
    assert tl.Case.from_text(case.to_toml(), folder=tmp_path) == case
    result = tl.run(case)
    assert result.contact is result.footprint
    assert isinstance(result.footprint, tl.footprint.Footprint)
    assert result.footprint.normal_load == pytest.approx(5 * 700e3 * 1e-4)
    # On layers the map has a margin of 10 cells of 10 mm; the footprint lies in its middle.
    inside = result.response.dataset.isel(x=slice(10, -10), y=slice(10, -10)).strain_xx
    alone = tl.solve_response(result.footprint, result.road, depths=[0.0, 0.02]).dataset.strain_xx
    # The wavenumbers follow the extent of the points: a few digits less than the kernels' own accuracy.
    np.testing.assert_allclose(inside, alone, atol=1e-7 * float(np.abs(alone).max()))
    assert "Recorded footprint" in result.summary()
    tree = result.to_tree()
    assert float(tree["contact"].normal_load) == pytest.approx(350)
    assert "Kalker" not in tree.attrs["citations"]
    assert "Kennett" in tree.attrs["citations"]


def test_a_recorded_footprint_tells_what_was_read(tmp_path):
    result = tl.run(footprint(tmp_path))
    told = "0.35 kN on 500 mm² (3 x 2 cells of 10 x 10 mm), peak pressure 700 kPa"
    how = "stress.csv: commas between cells, decimal points, pressure in kPa"
    assert told in result.summary()
    assert how in result.summary()
    tire = result.to_tree()["contact"].attrs["tire"]
    assert told in tire
    assert how in tire


def test_a_footprint_from_netcdf_may_be_told_its_units(tmp_path):
    values = (("y", "x"), np.full((2, 3), 700.0))
    places = {"x": ("x", [0.0, 10.0, 20.0], {"units": "mm"}), "y": ("y", [0.0, 10.0], {"units": "mm"})}
    xr.Dataset({"pressure": values}, places).to_netcdf(tmp_path / "stress.nc", engine="h5netcdf")
    text = '[footprint]\nfile = "stress.nc"\n' + STRUCTURE + TAIL[TAIL.index("[response]") :]
    with pytest.raises(tl.InputError, match="pressure names no unit"):
        tl.Case.from_text(text, folder=tmp_path).footprint.build(tmp_path)
    case = tl.Case.from_text(text.replace('.nc"', '.nc"\nunits = { pressure = "kPa" }'), folder=tmp_path)
    assert case.footprint.build(tmp_path).normal_load == pytest.approx(6 * 70.0)


def test_a_height_map_of_a_case_in_the_french_way(tmp_path):
    x = np.arange(-20, 21) * 3.0
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / 800
    rows = "\n".join(";".join(f"{value:.3f}".replace(".", ",") for value in row) for row in gap)
    (tmp_path / "map.csv").write_text(rows)
    tire = '[tire]\nheight_map = "map.csv"\ncell = "3 mm"\nunits = "mm"\n'
    material = 'material = { kind = "elastic", modulus = "3 MPa", poisson = 0.5 }\n'
    rest = COARSE_CASE[COARSE_CASE.index("[[pavement") :].replace("32.5 kN", "0.3 kN").replace("10 kN", "50 N")
    case = tl.Case.from_text(tire + material + rest, folder=tmp_path)
    assert tl.Case.from_text(case.to_toml(), folder=tmp_path) == case
    result = tl.run(case)
    told = (
        "41 x 41 cells of 3 x 3 mm, gap up to 9 mm, no holes; read from map.csv: semicolons between cells, decimal "
    )
    assert told + "commas, gap in mm" in result.summary()
    assert told in result.to_tree()["contact"].attrs["tire"]
    (tmp_path / "map.csv").write_text(rows[: rows.rindex(";") + 1] + "ERR")
    with pytest.raises(tl.InputError, match="line 41: the gap is 'ERR', not a number"):
        case.build_tire()
    for old, new, message in (
        ('units = "mm"', 'units = { heigth = "mm" }', "units names 'heigth'"),
        (
            'height_map = "map.csv"\ncell = "3 mm"',
            'profile = "315/80R22.5"',
            "units belongs to a scan or a height_map",
        ),
    ):
        text = (tire + material + rest).replace(old, new)
        with pytest.raises(tl.InputError, match=message):
            tl.Case.from_text(text, folder=tmp_path).build_tire()


@pytest.mark.slow
def test_report_of_a_recorded_footprint(tmp_path):
    tree = tl.run(footprint(tmp_path)).to_tree()
    page = write_report({"sensor": tree}, tmp_path / "r.html").read_text(encoding="utf-8")
    for wanted in ("Recorded footprint", "stress.csv", "peak pressure", "EB-GB3", "Vertical section"):
        assert wanted in page


def test_a_footprint_leaves_no_place_for_a_tire(tmp_path):
    with pytest.raises(tl.InputError, match="a footprint replaces a tire; leave out tire"):
        footprint(tmp_path, '[tire]\nprofile = "315/80R22.5"')
    with pytest.raises(tl.InputError, match="leave out rolling"):
        footprint(tmp_path, "[rolling]\nnormal_load = 1\nfriction = 1")
    with pytest.raises(tl.InputError, match=r"'rolling' is missing; or give a recorded \[footprint\]"):
        tl.Case.from_text(HEAD + STRUCTURE)
    with pytest.raises(tl.InputError, match=r"spacing belongs to a CSV file; stress\.nc is NetCDF"):
        tl.Case.from_text('[footprint]\nfile = "stress.nc"\nspacing = 1\n' + STRUCTURE)
    with pytest.raises(tl.InputError, match="no tire"):
        footprint(tmp_path).build_tire()


def test_rows_of_viscoelastic_and_rigid_roads():
    material = HuetSayegh(40e9, 18e6, 2.3, 0.2, 0.5, 0.01, 0.35)
    road = tl.Pavement([tl.Layer(material, 0.08, name="asphalt")], rigid_base=True)
    (row,) = layer_rows(road)
    assert row.modulus == pytest.approx(abs(material.complex_modulus(20 * math.pi)))
    assert (row.bond, row.temperature) == ("bonded to a rigid base", None)
