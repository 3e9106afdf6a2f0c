"""Meshes that a scanner of ours writes as JSON."""

import json
from pathlib import Path

import numpy as np


def read(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in the unit of the file, and faces (m, 3)."""
    mesh = json.loads(path.read_text(encoding="utf-8"))
    return np.array(mesh["vertices"], float), np.array(mesh["faces"], int)
