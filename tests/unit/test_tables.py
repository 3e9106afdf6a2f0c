"""Numbers from text files: what could be read in two ways is refused."""

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.tables import finite_list, read_table


@pytest.fixture
def read(tmp_path):
    def reader(text, **told):
        path = tmp_path / "table.csv"
        path.write_text(text, encoding="utf-8")
        return read_table(path, **told).values()[0]

    return reader


@pytest.mark.parametrize(
    "text",
    [
        # One of 62021.2 and 28966.6 in each line, to six digits: both lines have eight cells.
        "258787,214372,254756,214995,123853,554431,62021,2\n308935,28966,6,187239,446526,367937,582021,556544\n",
        # To nine digits, with a zero cut off of some.
        "488062,475,28882,9862,58996,9888,289446,23\n559224,3,557267,879,470695,978,459565,943\n",
        # Two decimals, and a cell without a value in each line.
        "1,25,NaN,3,75\n,2,35,4,15\n",
        "4,12345e+05,NaN\nNaN,1,12345e+05\n",
    ],
)
def test_decimal_commas_between_commas_are_refused(read, text):
    """Each was once read as that many whole numbers."""
    with pytest.raises(InputError, match=r"in line \d may be two whole numbers or one with a decimal comma"):
        read(text)
    assert read(text, decimal=".").shape == (2, text.split("\n")[0].count(",") + 1)


@pytest.mark.parametrize("form", [".3g", ".4g", ".6g", ".9g", ".17g", ".1f", ".3f", ".5e"])
def test_no_writer_of_decimal_commas_between_commas_is_read_wrong(read, form):
    rng = np.random.default_rng(0)
    for _ in range(400):
        values = 10 ** rng.uniform(0, 6) * rng.random(rng.integers(2, 8, 2))
        cells = [[format(value, form).replace(".", ",") for value in row] for row in values]
        if "," in "".join(map("".join, cells)):
            with pytest.raises(InputError):
                read("\n".join(map(",".join, cells)))


@pytest.mark.parametrize(
    "text",
    [
        # A zero line of a sensor has no decimals, so no line has.
        "0,0,0,0\n0,12,115,0\n0,240,90,0\n",
        "12,7,103\n115,90,8\n41,260,77\n",
        "-1,-20\n-3,-4\n",
        "120,,35\n80,60,\n",
    ],
)
def test_whole_numbers_that_no_decimals_explain_are_read(read, text):
    wanted = [[float(cell or "nan") for cell in line.split(",")] for line in text.split()]
    np.testing.assert_array_equal(read(text), wanted)


@pytest.mark.parametrize("values", [0.5, [0.5], (0.5,), np.array([0.5])])
def test_one_number_is_a_list_of_one(values):
    np.testing.assert_array_equal(finite_list(values, "angles"), [0.5])


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ([], r"angles must be a list of finite numbers in rad, at least one, got shape \(0,\)"),
        ([[1.0]], r"at least one, got shape \(1, 1\)"),
        ([1.0, np.nan], "at least one, got nan"),
        ([np.inf], "at least one, got inf"),
        (["far"], "angles must be an array of numbers"),
        (None, "angles must be an array of numbers"),
    ],
)
def test_what_is_no_list_of_finite_numbers_is_refused(values, words):
    with pytest.raises(InputError, match=words):
        finite_list(values, "angles", "rad")
