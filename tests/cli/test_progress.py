"""Progress where there is no terminal: a line now and then, none for short work, none when it is not wanted."""

import io
import subprocess
import sys
import threading
import time

import pytest
from rich.console import Console

from cases import COARSE_CASE
from treadload.cli.progress import AGAIN, SHORT, Lines, counts, stages


def lines_of(happens):
    """Lines of stages and counts at given seconds, the clock looked at every half second."""
    said = []
    lines = Lines(said.append, began=0.0)
    for half in range(2 * 60):
        now = half / 2
        for call in happens.get(now, ()):
            call(lines)
        lines.tick(now)
    return said


def stage(text):
    return lambda lines: lines.stage(text)


def test_short_work_says_nothing():
    assert SHORT == 3.0
    assert AGAIN == 10.0
    ends = stage("")
    assert lines_of({0.0: [stage("reading")], 1.0: [stage("normal contact")], 2.5: [ends]}) == []


def test_a_stage_is_told_once_it_lasts_and_again_every_while():
    happens = {0.0: [stage("long")], 25.0: [stage("short")], 25.5: [stage("next")], 50.0: [stage("")]}
    assert lines_of(happens) == [
        "    3 s  long",
        "   13 s  long",
        "   23 s  long",
        "   26 s  next",
        "   36 s  next",
        "   46 s  next",
    ]


def test_counts_are_told_with_the_newest_number_and_no_more_often():
    happens = {0.0: [stage("reading")]}
    for done in range(1, 41):
        happens[done + 4.0] = [lambda lines, done=done: lines.count(done, 40, "contact")]
    happens[45.0] = [stage("")]
    assert lines_of(happens) == [
        "    3 s  reading",
        "   13 s  9 of 40 contacts",
        "   23 s  19 of 40 contacts",
        "   33 s  29 of 40 contacts",
        "   43 s  39 of 40 contacts",
    ]


def test_the_clock_is_looked_at_while_the_work_goes_on(monkeypatch):
    monkeypatch.setattr("treadload.cli.progress.SHORT", 0.05)
    told, said = threading.Event(), []
    with Lines(lambda text: (said.append(text), told.set())) as lines:
        lines.stage("long")
        assert told.wait(60)
    assert said[0].endswith("s  long")


def test_nothing_is_said_when_it_is_not_wanted():
    stream = io.StringIO()
    console = Console(file=stream)
    with stages(console, quiet=True) as tell:
        tell("loud")
    with counts(console, quiet=True) as tell:
        tell(1, 2, "contact")
    assert stream.getvalue() == ""


def test_a_terminal_gets_a_spinner_and_a_bar():
    stream = io.StringIO()
    console = Console(file=stream, force_terminal=True, width=80)
    with stages(console, quiet=False) as tell:
        tell("normal contact")
        time.sleep(0.3)
    with counts(console, quiet=False) as tell:
        tell(1, 2, "contact")
        time.sleep(0.3)
    assert "normal contact" in stream.getvalue()
    assert "contacts" in stream.getvalue()


@pytest.mark.slow
def test_a_pipe_gets_lines_on_stderr_and_a_quiet_one_none(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(COARSE_CASE)
    # As in CI, with a pace that even the coarse case does not outrun.
    run = "import treadload.cli.progress as p; p.SHORT = 0.02; from treadload.cli import app; app()"
    loud = subprocess.run([sys.executable, "-c", run, "run", str(case)], capture_output=True, text=True, check=True)
    assert "contact" in loud.stderr
    assert all(" s  " in line for line in loud.stderr.splitlines())
    assert "\x1b" not in loud.stderr
    quiet = subprocess.run(
        [sys.executable, "-c", run, "run", str(case), "--quiet"], capture_output=True, text=True, check=True
    )
    assert quiet.stderr == ""
    assert quiet.stdout.splitlines()[0] == loud.stdout.splitlines()[0]
