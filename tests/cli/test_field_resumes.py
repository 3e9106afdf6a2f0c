"""`treadload field --solve` that is interrupted goes on from its file, with the numbers of a run in one go."""

import hashlib
import json

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.cli.commands import app
from treadload.life.field import mechanics
from treadload.life.field.mechanics import HARDENINGS, SectionDamage

run = CliRunner()


def damage_by_name(section, *rest):
    """A stand-in of the chain that takes no time: damage that depends on the section alone, to the last bit."""
    draw = np.random.default_rng(int(hashlib.sha256(section.name.encode()).hexdigest()[:8], 16))
    surface = 10 ** draw.uniform(-3.5, -1.5)
    return SectionDamage(
        section.name, tuple(surface * (1 + h) for h in HARDENINGS), tuple(0.01 * surface for _ in HARDENINGS),
        10 ** draw.uniform(-3, -1), 1e-4, 2e-4, section.traffic is None, 1e-3,
    )  # fmt: skip


@pytest.mark.slow
def test_an_interrupted_solve_goes_on_to_the_same_results(tmp_path, monkeypatch):
    names = []

    def counted(section, *rest):
        if len(names) == stops_at:
            raise KeyboardInterrupt
        names.append(section.name)
        return damage_by_name(section)

    monkeypatch.setattr(mechanics, "section_damage", counted)
    kept, output = tmp_path / "kept.json", tmp_path / "resumed.nc"
    command = ["field", "LTPP", "--solve", "--kept", str(kept), "--workers", "1", "-q"]
    stops_at = 60
    done = run.invoke(app, [*command, "-o", str(output)])
    assert done.exit_code == 130, done.output
    assert f"kept in {kept}; the same command goes on from there" in " ".join(done.stderr.split())
    assert not output.exists()
    first = list(names)
    assert len(first) == 60
    # A second interruption loses nothing either.
    stops_at = 100
    assert run.invoke(app, [*command, "-o", str(output)]).exit_code == 130
    stops_at = -1
    done = run.invoke(app, [*command, "-o", str(output)])
    assert done.exit_code == 0, done.output
    # At most the section that was being written is solved twice.
    assert len(set(names)) == 149
    assert len(names) <= 149 + 2
    names.clear()
    whole = tl.life.predict_sections(tl.life.field_tables["LTPP"], kept=tmp_path / "whole.json", workers=1)
    assert len(names) == 149
    resumed = tl.open_results(output).field_bench.dataset
    np.testing.assert_array_equal(resumed["predicted_surface"].to_numpy(), whole.surface)
    np.testing.assert_array_equal(resumed["predicted_bottom"].to_numpy(), whole.bottom)
    sections = [json.loads(path.read_text("utf-8")) for path in (kept, tmp_path / "whole.json")]
    assert sections[0] == sections[1]
