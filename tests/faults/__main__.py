"""`python -m faults disks` and `python -m faults kills --count 100`, in the folder tests."""

from __future__ import annotations

import argparse
import sys

from faults import kills, places


def main() -> int:
    """Run the faults of a kind; 1 if any broke something."""
    parser = argparse.ArgumentParser(prog="python -m faults", description="Full disks, races and kills.")
    parser.add_argument("kind", choices=["disks", "kills"])
    parser.add_argument("--only", help="the one writer or command to try")
    parser.add_argument("--count", type=int, default=10, help="kills of each command by each signal")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    if asked.kind == "disks":
        return places.main(asked.only)
    return 1 if kills.kills(asked.count, [asked.only] if asked.only else list(kills.COMMANDS), asked.seed) else 0


if __name__ == "__main__":
    sys.exit(main())
