"""Viscoelastic materials of papers: what they are, and files that are none."""

import numpy as np
import pytest

from treadload.catalogue import materials, read_materials
from treadload.errors import InputError
from treadload.materials import (
    HuetSayegh,
    Model2S2P1D,
    Prony,
    Thermorheological,
)


def test_all_are_materials_with_a_source():
    found = materials
    assert set(found) == {"ViscoRoute", "ELLVA1", "SBS-AC13", "SBS-AC20", "A70-AC25"}
    for name, entry in found.items():
        material = entry.material.at(15.0) if isinstance(entry.material, Thermorheological) else entry.material
        assert (np.diff(np.abs(material.complex_modulus(np.logspace(-3, 4, 20)))) > 0).all(), name
        assert len(entry.source) > 40
        assert name in str(entry)


def test_the_mix_of_viscoroute():
    mix = materials["viscoroute"].material.at(15.0)
    assert isinstance(mix, HuetSayegh)
    # As the file's source says.
    modulus = mix.complex_modulus(2 * np.pi * 10)
    assert abs(modulus) / 1e6 == pytest.approx(11356, abs=0.5)
    assert np.degrees(np.angle(modulus)) == pytest.approx(17.5, abs=0.05)


@pytest.mark.parametrize(("name", "remains"), [("SBS-AC13", 0.01373), ("SBS-AC20", 0.00454), ("A70-AC25", 0.00245)])
def test_the_printed_shares_leave_a_solid(name, remains):
    entry = materials[name]
    assert isinstance(entry.material, Prony)
    # 1 less the sum of the nine printed shares, added up by hand.
    assert entry.material.long_term_modulus == pytest.approx(remains * entry.material.modulus, rel=1e-9)
    assert entry.temperature == 20.0


def test_files_of_others(tmp_path):
    path = tmp_path / "ours.toml"
    numbers = "glassy_modulus = 3e10\nstatic_modulus = 1e7\ndelta = 2\nk = 0.2\nh = 0.6\nbeta = 300\npoisson = 0.35\n"
    path.write_text(f'[a]\nkind = "2s2p1d"\n{numbers}tau = 0.1\ntemperature = 15\n')
    (found,) = read_materials(path)
    assert found.material == Model2S2P1D(3e10, 1e7, 2, 0.2, 0.6, 300, 0.1, 0.35)
    assert "at 15 °C" in str(found)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ('[a]\nkind = "maxwell"\n', "a: no material of the kind 'maxwell'; known are 2s2p1d, .*elastic, "),
        ('[a]\nkind = "prony"\nmodulus = 1e9\npoisson = 0.3\n', "'a.terms' is missing"),
        ('[a]\nkind = "prony"\nmodulus = 1e9\nterms = [[0.5]]\npoisson = 0.3\n', "'a.terms.0.1' is missing"),
        ('[a]\nkind = "prony"\nmodulus = -1\nterms = [[0.5, 1]]\npoisson = 0.3\n', "a: modulus must be"),
        ('[a]\nkind = "power-law-creep"\ntua = 1\n', "unknown key 'a.tua'; did you mean 'tau'"),
    ],
)
def test_bad_files(tmp_path, text, word):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=word):
        read_materials(path)


def test_an_unknown_name():
    with pytest.raises(InputError, match="did you mean 'ViscoRoute'"):
        materials["viscorute"]
