"""Pictures of a page: what cannot be drawn leaves a sentence in its place."""

import os
import signal
import time
import warnings

import pytest
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.reporting.pictures import picture
from treadload.results.schema import read_json


def one_place():
    figure = Figure()
    figure.subplots().set_xlim(0.1, 0.1)
    return figure


def one_row():
    figure = Figure(figsize=(0.1, 0.1), layout="constrained")
    figure.subplots().set_ylabel("y (mm)")
    return figure


def nothing():
    raise InputError("nothing to draw")


@pytest.mark.parametrize("draw", [one_place, one_row, nothing])
def test_a_figure_without_extent_leaves_a_sentence(draw):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (one,) = picture("title", "caption", draw)
    assert not one.source
    assert one.missing in (
        "This figure could not be drawn: nothing to draw.",
        "This figure could not be drawn: there is no extent to draw, a single row of cells or a single place.",
    )


def test_citations_too_deep_in_each_other_are_none():
    assert read_json("[" * 3000, []) == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_a_forked_process_encodes_its_pictures_too():
    """It inherited the pool of its parent and none of its threads, and waited for ever."""
    assert len(picture("Parent", "", Figure)) == 1
    child = os.fork()
    if not child:
        # 0 if there is a picture, else 1; nothing of pytest's may run in this process.
        code = 1
        try:
            code = int(not picture("Child", "", Figure)[0].source.startswith("data:"))
        finally:
            os._exit(code)
    until = time.monotonic() + 60
    done, status = 0, -1
    while not done and time.monotonic() < until:
        done, status = os.waitpid(child, os.WNOHANG)
        time.sleep(0.02)
    if not done:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    assert (done, os.waitstatus_to_exitcode(status)) == (child, 0)
