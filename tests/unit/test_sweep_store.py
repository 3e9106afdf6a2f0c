"""The store of a study: it resumes, is read while it grows, and breaks with nothing."""

import errno
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from cases import BASE_AND_SOIL, ONE_AXLE
from sweeps import same, small_case
from treadload import variables
from treadload.errors import InputError
from treadload.results import to_tree
from treadload.steps import run
from treadload.sweeps import open_sweep, places
from treadload.sweeps import store as stores
from treadload.sweeps.arrays import _in_json
from treadload.sweeps.manifest import sealed

zarr = pytest.importorskip("zarr")
VARY = {"modulus": [1e9, 2e9, 4e9], "poisson": [0.25, 0.35]}
FIELDS = ["stress_zz", "max(strain_xx)"]
HERE = Path(__file__).parents[1]


def journal(path):
    return [json.loads(line) for line in (path / ".records.jsonl").read_text().splitlines()]


def test_a_store_holds_what_memory_does_and_opens_with_xarray(tmp_path):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    kept = tl.sweep(case, VARY, fields=FIELDS, store=path)
    memory = tl.sweep(case, VARY, fields=FIELDS)
    # Arrays are read when they are used: nothing is loaded by opening.
    assert not kept.dataset["stress_zz"].variable._in_memory
    assert same(kept.dataset, memory.dataset)
    assert list(kept.dataset.data_vars) == list(memory.dataset.data_vars)
    plain = xr.open_zarr(path, chunks=None)
    assert plain["stress_zz"].dims == ("modulus", "poisson", "depth", "y", "x")
    assert plain["worst_strain"].attrs["units"] == "1"
    assert plain["modulus"].attrs == {
        "key": "pavement.layers.0.material.modulus",
        "units": "Pa",
        "long_name": "modulus",
    }
    assert not (path / ".fields").exists()
    assert open_sweep(path).case.to_toml() == case.to_toml()


def test_a_study_of_lives_is_kept_with_its_texts(tmp_path):
    """What fails first is a text of every case, in a store as in memory; a run of a case alone says the same."""
    both = ONE_AXLE + BASE_AND_SOIL
    case, path = tl.Case.from_text(both), tmp_path / "lives.zarr"
    vary = {"axle_load": ["60 kN", "130 kN"], "traffic.classes.0.inflation_pressure": ["7 bar", "9 bar"]}
    kept = tl.sweep(case, vary, store=path).dataset
    memory = tl.sweep(case, vary).dataset
    assert same(kept, memory)
    assert set(kept["governing"].to_numpy().ravel().tolist()) <= {"base", "soil"}
    alone = run(tl.Case.from_text(both.replace("100 kN", "60 kN").replace("8 bar", "9 bar"))).life
    here = xr.open_zarr(path, chunks=None).isel({"axle_load": 0, "traffic.classes.0.inflation_pressure": 1})
    assert str(here["governing"].to_numpy()) == alone.governing
    assert float(here["governing_years"]) == pytest.approx(alone.years(alone.governing), rel=1e-9)
    with pytest.raises(InputError, match="is the store of a study: `treadload study report"):
        tl.open_results(path)
    # Its mixes have no temperature of their own; the methods are told all the same.
    tree = to_tree(open_sweep(path))
    assert any("Miner" in one for one in json.loads(tree.attrs["citations"]))


def test_an_interrupted_study_goes_on_and_recomputes_nothing(tmp_path):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"

    def stop(done, total, what):
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match=r"4 of 6 cases are kept in .*study\.zarr; the same command goes on"):
        tl.sweep(case, VARY, fields=FIELDS, store=path, progress=stop)
    half = open_sweep(path)
    assert half.stats["solved"], half.stats["unsolved"] == (4, 2)
    assert "2 not solved yet" in half.summary()
    assert np.isfinite(half.dataset["stress_zz"]).any(("depth", "y", "x")).sum() == 4
    seen = []
    whole = tl.sweep(case, VARY, fields=FIELDS, store=path, progress=lambda done, total, what: seen.append(done))
    assert seen == [4, 5, 6]
    assert [one["number"] for one in journal(path)] == [0, 1, 2, 3, 4, 5]
    assert same(whole.dataset, tl.sweep(case, VARY, fields=FIELDS).dataset)


def test_an_array_that_was_being_made_when_its_process_was_stopped_is_made_again(tmp_path):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"

    def stop(done, total, what):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tl.sweep(case, VARY, store=path, progress=stop)
    # zarr writes the shape of an array first, then its dimensions, then its values.
    (path / "status" / ".zattrs").unlink()
    whole = tl.sweep(case, VARY, store=path)
    assert same(whole.dataset, tl.sweep(case, VARY).dataset)
    assert same(open_sweep(path).dataset, whole.dataset)


def test_what_failed_is_tried_again(tmp_path, monkeypatch):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    from treadload.steps import scene

    original = scene.load_case
    with monkeypatch.context() as patch:

        def fails(one, *args, **more):
            if one.as_tables()["pavement"]["layers"][0]["material"]["modulus"] == 2e9:
                raise MemoryError
            return original(one, *args, **more)

        patch.setattr(scene, "load_case", fails)
        study = tl.sweep(case, VARY, store=path)
        assert study.stats["failed"] == 2
        assert "out of memory" in study.failures[0][1]
    again = tl.sweep(case, VARY, store=path)
    assert again.stats["failed"] == 0
    assert len(journal(path)) == 8


def test_a_line_that_was_cut_off_counts_as_not_written(tmp_path):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    tl.sweep(case, VARY, store=path)
    lines = (path / ".records.jsonl").read_bytes().splitlines(keepends=True)
    for rest in (lines[3][:-1], lines[3][:40], b"\0\0\0\0", b'{"number": 3}\n', b"\xff\xfe\n"):
        (path / ".records.jsonl").write_bytes(b"".join(lines[:3]) + rest)
        assert open_sweep(path).stats["solved"] == 3
        assert tl.sweep(case, VARY, store=path).stats["solved"] == 6
        assert len(journal(path)) == 6


def test_another_study_is_refused(tmp_path):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    tl.sweep(case, {"poisson": [0.3]}, store=path)
    before = (path / ".records.jsonl").read_bytes()
    for vary, fields in (({"poisson": [0.4]}, ()), ({"poisson": [0.3]}, ["stress_zz"])):
        with pytest.raises(InputError, match="holds another study"):
            tl.sweep(case, vary, fields=fields, store=path)
    # The file that the case reads belongs to it.
    (tmp_path / "print.csv").write_text((tmp_path / "print.csv").read_text().replace("400000", "500000"))
    with pytest.raises(InputError, match="its files"):
        tl.sweep(case, {"poisson": [0.3]}, store=path)
    assert (path / ".records.jsonl").read_bytes() == before
    told = json.loads((path / "study.json").read_text())
    del told["check"]
    (path / "study.json").write_text(sealed({**told, "version": "0.0.1", "name": "x"}))
    with pytest.raises(InputError, match=r"treadload 0\.0\.1 began it"):
        tl.sweep(case, {"poisson": [0.3]}, store=path)


def test_folders_that_are_no_study(tmp_path):
    case = small_case(tmp_path)
    (tmp_path / "mine.zarr").mkdir()
    (tmp_path / "mine.zarr" / "precious").write_text("mine")
    with pytest.raises(InputError, match="is no study; give another name"):
        tl.sweep(case, {"poisson": [0.3]}, store=tmp_path / "mine.zarr")
    with pytest.raises(InputError, match="no study that"):
        open_sweep(tmp_path / "mine.zarr")
    with pytest.raises(InputError, match="no study that"):
        open_sweep(tmp_path / "none.zarr")
    with pytest.raises(InputError, match="cannot make the store"):
        tl.sweep(case, {"poisson": [0.3]}, store=tmp_path / "no" / "study.zarr")


@pytest.mark.skipif(os.name != "posix", reason="locks of files as POSIX has them")
def test_a_store_has_one_writer(tmp_path):
    import fcntl

    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    tl.sweep(case, {"poisson": [0.3]}, store=path)
    with (path / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(InputError, match="is being written by another study"):
            tl.sweep(case, {"poisson": [0.3]}, store=path)
    assert open_sweep(path).stats["solved"] == 1


def test_a_full_disk_is_one_sentence_and_keeps_what_is_done(tmp_path, monkeypatch):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    append, calls = stores.Store.append, []

    class Full:
        """A journal on a disk that has room for half a line."""

        def __init__(self, stream):
            self.stream = stream

        def write(self, text):
            self.stream.write(text[:50])
            self.stream.flush()
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def fill(self, record):
        calls.append(1)
        if len(calls) == 4:
            self._journal = Full(self._journal)
        append(self, record)

    with monkeypatch.context() as patch:
        patch.setattr(stores.Store, "append", fill)
        with pytest.raises(InputError, match=r"No space left on device; 3 of 6 cases are kept"):
            tl.sweep(case, VARY, store=path)
    assert open_sweep(path).stats["solved"] == 3
    assert tl.sweep(case, VARY, store=path).stats["solved"] == 6


@pytest.mark.slow
def test_processes_give_the_same_numbers(tmp_path):
    case = small_case(tmp_path)
    assert same(tl.sweep(case, VARY, fields=FIELDS, jobs=2).dataset, tl.sweep(case, VARY, fields=FIELDS).dataset)


@pytest.mark.slow
def test_a_process_that_dies_takes_only_its_case(tmp_path):
    case = small_case(tmp_path)
    # A worker that is killed over one case, as the kernel does where memory ends.
    code = f"""
import os, signal, sys
sys.path.insert(0, {str(HERE)!r})
import treadload as tl
from treadload.sweeps import work

solve = work.Worker.solve
def killed(self, number, values):
    if number == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(self, number, values)
work.Worker.solve = killed

if __name__ == "__main__":
    case = tl.Case.from_toml({str(tmp_path / "case.toml")!r})
    study = tl.sweep(case, {VARY!r}, jobs=2)
    print(study.stats["solved"], study.failures)
"""
    (tmp_path / "run.py").write_text(code)
    done = subprocess.run([sys.executable, tmp_path / "run.py"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"5 {((1, places.DIED),)}"
    assert case.title == "small"


@pytest.mark.slow
@pytest.mark.parametrize("more", ["jobs=2, store='study.zarr'", "jobs=2, scheduler='local'"])
def test_a_script_without_a_guard_is_told_so(tmp_path, more):
    small_case(tmp_path)
    code = f"import treadload as tl\ntl.sweep(tl.Case.from_toml('case.toml'), {VARY!r}, {more})\n"
    (tmp_path / "run.py").write_text(code)
    done = subprocess.run([sys.executable, "run.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "needs 'if __name__ ==" in done.stderr.splitlines()[-1]
    # The processes that import it end without a traceback of their own.
    assert "bootstrapping" not in done.stderr


DYING = """
import os, pathlib, signal, sys
import treadload as tl
from treadload.sweeps import places

serve = places._serve
def dying(pipe, question):
    if sys.argv[1] == "once":
        try:
            pathlib.Path("died").touch(exist_ok=False)
        except FileExistsError:
            return serve(pipe, question)
    os.kill(os.getpid(), signal.SIGKILL)
places._serve = dying

if __name__ == "__main__":
    case, vary = tl.Case.from_toml("case.toml"), {"poisson": [0.2, 0.3, 0.4]}
    print(tl.sweep(case, vary, jobs=2, store="s.zarr").stats["solved"])
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("once", ()),
        ("always", ("killed by SIGKILL while it started, twice", "fewer processes than 2", "0 of 3 cases are kept")),
    ],
)
def test_a_process_that_dies_while_it_starts_is_started_once_more(tmp_path, how, words):
    small_case(tmp_path)
    (tmp_path / "run.py").write_text(DYING)
    command = [sys.executable, "run.py", how]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.split() == ([] if words else ["3"])
    last = done.stderr.splitlines()[-1] if words else ""
    assert all(word in last for word in words), last
    assert "__main__" not in last


def test_how_a_process_ended_and_what_helps():
    assert places._end(-signal.SIGKILL) == "was killed by SIGKILL"
    assert places._end(-200) == "was killed by signal 200"
    assert places._end(3) == "ended with exit code 3"
    assert "use fewer processes than 8" in places._remedy(-9, 8)
    assert "what it printed before" in places._remedy(3, 8)


def test_a_system_that_starts_no_more_processes_is_one_sentence(tmp_path, monkeypatch):
    def refused(*_, **__):
        raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN))

    monkeypatch.setattr(places.multiprocessing.get_context("spawn").Process, "start", refused)
    with pytest.raises(places.WorkersLost, match=r"Resource temporarily unavailable.*use fewer processes"):
        tl.sweep(small_case(tmp_path), VARY, jobs=2)


@pytest.mark.slow
def test_twenty_kills_at_random_moments_lose_no_case(tmp_path):
    small_case(tmp_path)
    path, vary = (
        tmp_path / "study.zarr",
        {"modulus": np.geomspace(1e9, 1e10, 20).tolist(), "poisson": np.linspace(0.1, 0.4, 9).tolist()},
    )
    code = f"""
import sys
import treadload as tl
if __name__ == "__main__":
    case = tl.Case.from_toml({str(tmp_path / "case.toml")!r})
    tl.sweep(case, {vary!r}, fields={FIELDS!r}, store={str(path)!r}, jobs=int(sys.argv[1]))
"""
    (tmp_path / "run.py").write_text(code)
    rng, before = random.Random(7), 0
    for number in range(20):
        # Every fourth in two processes, which take as long again to start.
        one = subprocess.Popen([sys.executable, tmp_path / "run.py", "2" if number % 4 == 0 else "1"])
        until = time.monotonic() + 60
        target = before + rng.randrange(1, 9)
        while one.poll() is None and time.monotonic() < until:
            if path.exists() and (path / ".records.jsonl").exists() and len(journal_safely(path)) >= target:
                break
            time.sleep(0.01)
        time.sleep(rng.random() * 0.05)
        one.send_signal(signal.SIGKILL)
        one.wait()
        study = open_sweep(path)
        # What a case wrote stays, and the store opens at any moment.
        assert study.stats["solved"] >= before
        assert study.stats["failed"] == 0
        before = study.stats["solved"]
    assert 20 <= before < 180
    whole = tl.sweep(tl.Case.from_toml(tmp_path / "case.toml"), vary, fields=FIELDS, store=path)
    # Every case was written once: none of those that were kept was solved again.
    numbers = [one["number"] for one in journal(path)]
    assert sorted(numbers) == list(range(180))
    assert same(whole.dataset, tl.sweep(tl.Case.from_toml(tmp_path / "case.toml"), vary, fields=FIELDS).dataset)


def journal_safely(path):
    return (path / ".records.jsonl").read_bytes().splitlines()


@pytest.mark.parametrize("name", ["state", "depth", "pressure"])
def test_attributes_of_a_field_are_what_a_store_keeps(name):
    """Flags of a contact's state are an array beside the data, and a list in Zarr's JSON."""
    about = variables.attributes(name)
    kept = _in_json(about)
    assert json.loads(json.dumps(kept)) == kept
    assert set(kept) == set(about)
    if name == "state":
        assert kept["flag_values"] == [0, 1, 2]
