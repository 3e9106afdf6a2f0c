"""Benchmarks are no tests, but they run: what they reach into moves with the code."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
SHORT = ("whole_chain", "normal_contact", "rolling_contact", "belt", "layered")


@pytest.mark.slow
def test_the_benchmark_of_large_studies_runs_on_few_cases():
    done = subprocess.run(
        [sys.executable, str(FOLDER / "ten_thousand.py"), "200", "1"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("kept") == 2, done.stdout


@pytest.mark.slow
def test_short_benchmarks_run_to_their_end():
    asked = [sys.executable, str(FOLDER / "run_all.py"), "--short", *SHORT]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for name in SHORT:
        assert f"  {name}: " in done.stdout


def test_a_benchmark_that_there_is_not_is_told_with_those_that_there_are():
    done = subprocess.run(
        [sys.executable, str(FOLDER / "run_all.py"), "lives"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "no benchmark lives" in done.stderr
    assert "life" in done.stderr
