"""Decimal commas between commas: no spelling of them becomes twice as many numbers in silence."""

import numpy as np
import pytest

import treadload as tl


@pytest.mark.parametrize(
    "text",
    [
        # Decimals of as many digits as they need, as programs write them.
        "0,689803,0,78396\n0,813724,0,1211\n0,535413,0,972362\n",
        "6,89803e+05,7,8396e+05\n8,13724e+05,1,211e+05\n",
        "12,75,130,25\n9,50,141,00\n",
    ],
)
def test_they_are_refused(text, tmp_path):
    (tmp_path / "stress.csv").write_text(text)
    with pytest.raises(tl.InputError, match="one with a decimal comma"):
        tl.response.GridLoad.from_csv(tmp_path / "stress.csv", spacing=5e-3)


def test_whole_numbers_between_commas_are_read(tmp_path):
    (tmp_path / "stress.csv").write_text("0,12,130,20\n5,245,655,0\n")
    load = tl.response.GridLoad.from_csv(tmp_path / "stress.csv", spacing=5e-3)
    np.testing.assert_array_equal(np.asarray(load.array)[0], [[0, 12, 130, 20], [5, 245, 655, 0]])
