"""A study on Dask: a scheduler and workers as real processes, one of them killed; slow, for they start slowly."""

import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import treadload as tl
from sweeps import same, small_case
from treadload.errors import InputError
from treadload.sweeps import SchedulerLost, open_sweep

pytest.importorskip("distributed")
pytest.importorskip("zarr")
VARY = {"modulus": np.geomspace(1e9, 1e10, 20).tolist(), "poisson": [0.2, 0.3, 0.4]}


def _start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )


def _address(process):
    """Where a scheduler says that it listens."""
    until = time.monotonic() + 60
    for line in process.stdout:
        if "tcp://" in line and "Scheduler at" in line:
            return line.split("Scheduler at:")[-1].strip()
        assert time.monotonic() < until, line
    raise AssertionError("the scheduler ended")


@pytest.fixture
def cluster():
    scheduler = _start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    address = _address(scheduler)
    workers = [
        _start("distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        for _ in range(2)
    ]
    try:
        yield scheduler, address, workers
    finally:
        for one in (*workers, scheduler):
            one.kill()
            one.wait()
            one.stdout.close()


@pytest.mark.slow
def test_a_worker_killed_in_the_middle_loses_nothing_and_a_lost_scheduler_is_one_sentence(tmp_path, cluster):
    scheduler, address, workers = cluster
    case = small_case(tmp_path)
    serial = tl.sweep(case, VARY, fields=["stress_zz"])
    killed = []

    def kill(process, at):
        def told(done, total, what):
            if done >= at and process not in killed:
                killed.append(process)
                process.send_signal(signal.SIGKILL)

        return told

    study = tl.sweep(
        case, VARY, fields=["stress_zz"], store=tmp_path / "a.zarr", scheduler=address, progress=kill(workers[0], 15)
    )
    assert killed == [workers[0]]
    assert study.stats["solved"] == 60
    assert same(study.dataset, serial.dataset)

    with pytest.raises(
        SchedulerLost, match=r"the scheduler went away.*of 60 cases are kept.*the same command goes on"
    ):
        tl.sweep(
            case,
            VARY,
            fields=["stress_zz"],
            store=tmp_path / "b.zarr",
            scheduler=address,
            progress=kill(scheduler, 9),
        )
    before = open_sweep(tmp_path / "b.zarr").stats["solved"]
    assert 9 <= before < 60
    done = []
    whole = tl.sweep(
        case, VARY, fields=["stress_zz"], store=tmp_path / "b.zarr", progress=lambda n, total, what: done.append(n)
    )
    assert done[0] == before
    assert same(whole.dataset, serial.dataset)
    shutil.rmtree(tmp_path / "a.zarr")


@pytest.mark.slow
def test_a_local_cluster_gives_the_same(tmp_path):
    case = small_case(tmp_path)
    vary = {"poisson": [0.2, 0.3, 0.4, 0.9]}
    rows = [{"poisson": value} for value in vary["poisson"]]
    assert same(tl.sweep(case, rows, scheduler="local", jobs=2).dataset, tl.sweep(case, rows).dataset)


@pytest.mark.slow
def test_nobody_at_an_address(tmp_path, monkeypatch):
    from treadload.sweeps import cluster

    monkeypatch.setattr(cluster, "_REACH", 2)
    with pytest.raises(InputError, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        tl.sweep(small_case(tmp_path), {"poisson": [0.3]}, scheduler="tcp://127.0.0.1:9")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sent", "code"),
    [("os.killpg, (0, signal.SIGINT)", 130), ("os.kill, (os.getpid(), signal.SIGTERM)", 143),
     ("os.killpg, (0, signal.SIGTERM)", 143)],
)  # fmt: skip
def test_an_interruption_while_a_local_cluster_starts_is_one_sentence(tmp_path, sent, code):
    """As from a terminal, or a scheduler, which interrupts the study alone or also the processes that it starts."""
    small_case(tmp_path)
    program = """
import os, signal, sys, threading
if __name__ == "__main__":
    import distributed
    start = distributed.LocalCluster.__init__
    def interrupted(self, *args, **more):
        threading.Timer(0.1, SENT).start()
        return start(self, *args, **more)
    distributed.LocalCluster.__init__ = interrupted
    from treadload.cli import main
    sys.argv = ["treadload", "sweep", "case.toml", "--vary", "poisson=0.2:0.4:5", "--scheduler", "local"]
    main()
""".replace("SENT", sent)
    (tmp_path / "run.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "run.py"], cwd=tmp_path, capture_output=True, text=True, check=False, start_new_session=True
    )
    # That of shells, 128 and the number of the signal.
    assert done.returncode == code
    # Where the machine is slow progress is told before it.
    ours = [line for line in done.stderr.splitlines() if " s  " not in line]
    assert ours == ["error: interrupted; 0 of 5 cases are kept in case.zarr; the same command goes on from there"]
    assert tl.sweeps.open_sweep(tmp_path / "case.zarr").stats["unsolved"] == 5
