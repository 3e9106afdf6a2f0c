"""How commands end: signals, pipes that nobody reads, full disks behind stdout, exit codes."""

import io
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from typer.testing import CliRunner

from treadload.cli import app, ending
from treadload.cli.shell import _Screen
from treadload.errors import WriteError
from treadload.life.threads import pool_of

posix = pytest.mark.skipif(os.name == "nt", reason="signals and pipes as on POSIX")


@pytest.fixture
def fresh(monkeypatch):
    """Signals, hook and memory as at the start of a process, and back again."""
    names = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP")]
    before = {number: signal.getsignal(number) for number in names}
    for number in names:
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    for name, value in (("number", signal.SIGINT), ("since", None), ("is_answered", False)):
        monkeypatch.setattr(ending._Signal, name, value)
    monkeypatch.setattr(ending, "_LOST", [])
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def ended(act):
    with pytest.raises(SystemExit) as end, ending.orderly():
        act()
    return end.value.code


@posix
@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_signal_unwinds_what_is_open_and_ends_in_a_sentence_and_its_code(fresh, capsys, name, code):
    seen = []

    def act():
        try:
            signal.raise_signal(getattr(signal, name))
        finally:
            # The same signal twice, as launchers send it, does not stop the tidying up.
            signal.raise_signal(getattr(signal, name))
            seen.append("tidy")

    assert ended(act) == code
    assert seen == ["tidy"]
    said = capsys.readouterr().err
    assert said.startswith("error: interrupted; no file was changed")
    assert said.endswith("the same command starts again\n")


@posix
def test_an_interruption_that_a_library_wraps_into_its_error_is_one(fresh, capsys):
    """pydantic's core, while it builds a schema, raises SchemaError from a KeyboardInterrupt."""

    def act():
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt as error:
            raise RuntimeError("Error building a validator") from error

    assert ended(act) == 130
    assert capsys.readouterr().err.startswith("error: interrupted; no file was changed")
    with pytest.raises(RuntimeError, match="without a signal"), ending.orderly():
        raise RuntimeError("without a signal")


@posix
def test_what_a_user_chose_to_ignore_stays_ignored(fresh):
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    assert ended(lambda: signal.raise_signal(signal.SIGHUP)) == 0


@posix
def test_an_interruption_that_python_drops_comes_again(fresh):
    class Goes:
        def __del__(self):
            signal.raise_signal(signal.SIGTERM)
            time.sleep(0)

    def act():
        gone = Goes()
        del gone
        threading.Event().wait(20)

    began = time.monotonic()
    assert ended(act) == 143
    assert time.monotonic() - began < 10


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_what_was_half_made_when_an_interruption_came_goes_without_a_word(fresh, capsys):
    """As an event loop does, interrupted before it has its first attribute."""

    class HalfMade:
        def __del__(self):
            raise AttributeError("'_loop'")

    def act(interrupted):
        half = HalfMade()
        if interrupted:
            try:
                signal.raise_signal(signal.SIGTERM)
                time.sleep(0)
            finally:
                del half

    assert ended(lambda: act(True)) == 143
    assert "AttributeError" not in capsys.readouterr().err
    assert ended(lambda: act(False)) == 0
    assert "AttributeError" in capsys.readouterr().err


def test_exit_codes_pass(fresh):
    assert ended(lambda: sys.exit(2)) == 2
    assert ended(lambda: None) == 0


class Unread(io.StringIO):
    def write(self, text):
        raise BrokenPipeError

    def flush(self):
        raise BrokenPipeError


class Full(io.StringIO):
    def flush(self):
        raise OSError(28, "No space left on device")


def test_who_stops_reading_misses_the_rest_and_nothing_else_changes(fresh, monkeypatch):
    done = []

    def act():
        monkeypatch.setattr(sys, "stdout", Unread())
        _Screen().print("a summary")
        ending.say("more", sys.stdout)
        done.append(True)

    assert ended(act) == 0
    assert done


def test_a_full_disk_behind_stdout_is_a_sentence_after_the_work(fresh, monkeypatch, capsys):
    done = []

    def act():
        monkeypatch.setattr(sys, "stdout", Full())
        _Screen().print("a summary")
        done.append(True)

    assert ended(act) == 1
    assert done
    assert "what was printed could not be written: No space left" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "kept"),
    [(["--state", "s.json"], r"kept in s.json; the same command goes on"), ([], "with --state FILE")],
)
def test_an_interrupted_calibration_says_what_is_kept(monkeypatch, tmp_path, options, kept):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("treadload.steps.run", stopped)
    monkeypatch.chdir(tmp_path)
    run = CliRunner()
    assert run.invoke(app, ["init", "calibrate", "-o", "c.toml"]).exit_code == 0
    done = run.invoke(app, ["calibrate", "c.toml", *options])
    assert done.exit_code == 130, done.output
    assert kept in " ".join(done.output.split())


def test_a_disk_that_refuses_the_result_comes_after_its_summary_and_is_no_wrong_usage(monkeypatch, tmp_path):
    class Solved:
        def summary(self):
            return "peak pressure 812 kPa"

        def to_tree(self):
            return None

    def full(tree, path):
        raise WriteError(f"cannot write {path}: No space left on device (458 kB needed, 12 kB free)")

    monkeypatch.setattr("treadload.steps.run", lambda case, **_: Solved())
    monkeypatch.setattr("treadload.results.exports.write", full)
    monkeypatch.chdir(tmp_path)
    run = CliRunner()
    run.invoke(app, ["init", "-o", "c.toml"])
    done = run.invoke(app, ["run", "c.toml", "-q"])
    assert done.exit_code == 1
    assert "peak pressure 812 kPa" in done.stdout
    assert "458 kB needed, 12 kB free" in done.stderr
    assert os.listdir(tmp_path) == ["c.toml"]


def test_threads_end_with_what_they_solve_and_begin_nothing_more():
    begun = []

    def solve(number):
        begun.append(number)
        time.sleep(0.05)

    def all_of_it():
        with pool_of(1) as pool:
            for number in range(100):
                pool.submit(solve, number)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        all_of_it()
    assert len(begun) < 5


@pytest.mark.slow
@posix
def test_a_process_of_the_page_ends_in_silence_where_the_page_is_gone():
    done = subprocess.Popen(
        [sys.executable, "-m", "treadload.app.engine"],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    done.stdout.close()
    assert done.stderr.read() == b""
    assert done.wait(60) == 0


@pytest.mark.slow
@posix
def test_a_real_command_whose_reader_leaves_says_nothing():
    done = subprocess.Popen(
        [sys.executable, "-m", "treadload", "catalogue"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    done.stdout.close()
    assert done.stderr.read() == b""
    assert done.wait(60) == 0


def test_an_interruption_while_its_handlers_are_set_is_one_sentence():
    """It fell between the first handler and the last in one of a hundred kills."""
    program = """
import signal, sys
from treadload.cli import main
# A command in the background has inherited that interruptions are ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
set_handler = signal.signal
def interrupted(number, handler):
    before = set_handler(number, handler)
    signal.raise_signal(number)
    return before
signal.signal = interrupted
sys.argv = ["treadload", "criteria"]
main()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr.startswith("error: interrupted; no file was changed")
    assert done.stderr.count("\n") == 1


@posix
def test_an_interruption_in_an_executed_text_ends_with_the_code_all_the_same(tmp_path):
    """As of SIGTERM while classes of data are loaded: `python -m` would remember it and end by SIGINT."""
    (tmp_path / "command.py").write_text(
        "import os, signal; from treadload.cli import ending\n"
        "with ending.orderly():\n"
        "    exec('os.kill(os.getpid(), signal.SIGTERM); [None for _ in range(10**6)]')\n"
    )
    command = [sys.executable, "-m", "command"]
    ran = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (ran.returncode, ran.stderr.count("error: interrupted; ")) == (143, 1)
