"""A run as the process of a browser keeps it, and the signal that the user does not want the rest."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.steps.loaded import Loaded


class Stopped(Exception):
    """The user did not want the rest."""


@dataclass
class StoredRun:
    """What is known of one run. parts: by their names in a file. load: of the case, to be read elsewhere.

    opened: it was read from a file, so that no solve of this process brings the block of road below its maps.
    """

    case: Case | None
    parts: dict[str, BaseResult] = field(default_factory=dict)
    load: Loaded | None = None
    block: Any = None
    opened: bool = False
