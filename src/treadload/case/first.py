"""Cases to start from: every key with its unit, its default and its reason."""

from __future__ import annotations

from pathlib import Path

from treadload.case.schema import check_kind

_HERE = Path(__file__).parent


def first_case(name: str = "run") -> str:
    """TOML text of a case that runs as it is, each key explained.

    name: "run", "life" or "calibrate". Raises InputError.
    """
    check_kind(name)
    return (_HERE / f"first_{name}.toml").read_text(encoding="utf-8")
