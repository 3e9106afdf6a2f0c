"""Attacks on the doors of the package: every input is answered rightly, or refused in one sentence.

`python -m fuzz --help`, in the folder tests, runs them; tests/fuzz/test_short.py runs a few hundred of each kind.
"""
