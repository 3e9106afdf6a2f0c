"""The report on paper and in the post: small, whole, with what a reader needs to cite and to check it."""

import base64
import io
import json
import re

import pytest
from PIL import Image

import treadload as tl
from cases import COARSE_CASE
from treadload.results.bibtex import bibtex
from treadload.steps import run


@pytest.fixture(scope="module")
def page(coarse_result, tmp_path_factory):
    path = tl.report(coarse_result, tmp_path_factory.mktemp("report") / "page.html")
    return path.read_text(encoding="utf-8")


def test_methods_stand_in_the_page_as_bibtex(page, coarse_result):
    for line in bibtex(json.loads(coarse_result.to_tree().attrs["citations"])).splitlines():
        if line.startswith("@"):
            assert line in page
    assert "treadload validate" in page


def test_pictures_keep_every_pixel_and_are_small(page):
    found = re.findall(r'src="data:image/(png|webp);base64,([^"]+)"', page)
    assert len(found) > 8
    for kind, coded in found:
        picture = Image.open(io.BytesIO(base64.b64decode(coded)))
        assert picture.format.lower() == kind
        # Paper is white to the last bit: nothing was rounded.
        assert picture.convert("RGB").getpixel((0, 0)) == (255, 255, 255)
    # One case of 12 mm was 2.4 MB as PNG.
    assert len(page) < 1.9e6


def test_the_page_is_made_for_paper(page):
    style = page.split("<style>")[1].split("</style>")[0]
    paper = style[style.index("@media print") :]
    assert "size: A4" in paper
    assert 'counter(page) " / " counter(pages)' in paper
    assert "table-header-group" in paper
    # Texts with columns of numbers keep their lines; only a case folds into two columns.
    assert re.search(r"\n\s+pre \{[^}]*columns", paper) is None


@pytest.mark.slow
def test_a_report_of_two_cases_of_3_mm_is_under_5_mb(tmp_path):
    text = COARSE_CASE.replace('"12 mm"', '"3 mm"')
    free = tl.Case.from_text(text.replace('"10 kN"', '"0 kN"'))
    path = tl.report({"driven": run(tl.Case.from_text(text)), "free": run(free)}, tmp_path / "two.html")
    assert path.stat().st_size < 5e6
