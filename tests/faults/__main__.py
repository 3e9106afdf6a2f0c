"""`python -m faults disks`, in the folder tests: whatever breaks, and a line for each writer."""

from __future__ import annotations

import argparse
import sys

from faults import places


def main() -> int:
    """Run the faults of a kind; 1 if any broke something."""
    parser = argparse.ArgumentParser(prog="python -m faults", description="Full disks, races and kills.")
    parser.add_argument("kind", choices=["disks"])
    parser.add_argument("--only", help="the one writer to try")
    asked = parser.parse_args()
    return places.main(asked.only)


if __name__ == "__main__":
    sys.exit(main())
