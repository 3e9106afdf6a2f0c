"""The example of a layered road says what it means to."""

from pathlib import Path

import treadload as tl


def test_layers_are_read():
    case = tl.Case.from_toml(Path(__file__).parents[2] / "examples" / "layers.toml")
    road = case.pavement.build()
    assert [layer.bond for layer in road.layers] == [tl.pavement.Bond(1e9), tl.pavement.BONDED, tl.pavement.BONDED]
    assert [layer.thickness for layer in road.layers] == [0.06, 0.15, None]
    assert tl.Case.from_text(case.to_toml(), folder=case.folder) == case
