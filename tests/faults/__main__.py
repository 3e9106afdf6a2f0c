"""`python -m faults disks`, `kills --count 100` or `races --count 300`, in the folder tests."""

from __future__ import annotations

import argparse
import sys

from faults import kills, pages, places, races


def main() -> int:
    """Run the faults of a kind; 1 if any broke something."""
    parser = argparse.ArgumentParser(prog="python -m faults", description="Full disks, races and kills.")
    parser.add_argument("kind", choices=["disks", "kills", "races"])
    parser.add_argument("--only", help="the one writer or command to try")
    parser.add_argument("--count", type=int, default=10, help="kills of each command by each signal")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    if asked.kind == "races":
        for signals in kills.SIGNALS:
            print(f"{signals} while writing:", dict(kills.stopped_while_writing(signals, asked.count, asked.seed)))
        print("replaced whole:", dict(races.read_while_replaced(asked.count, whole=True)))
        print("truncated and written:", dict(races.read_while_replaced(asked.count, whole=False)))
        races.two_writers_of_a_file(asked.count)
        print("second writer of a store:", races.two_writers_of_a_store())
        return 0
    if asked.kind == "disks":
        return places.main(asked.only)
    broken = 0
    if asked.only != "app":
        broken += kills.kills(asked.count, [asked.only] if asked.only else list(kills.COMMANDS), asked.seed)
    if asked.only in (None, "app"):
        broken += pages.stopped_pages(asked.count, asked.seed)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
