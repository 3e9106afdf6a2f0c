"""Stopwatch and plain tables."""

import gc
import time


def best_of(run, repeats=3, clock=time.perf_counter):
    """Seconds of the fastest of some runs, and what the last one returned. clock: process_time on a busy machine."""
    fastest = float("inf")
    for _ in range(repeats):
        gc.collect()
        began = clock()
        result = run()
        fastest = min(fastest, clock() - began)
    return fastest, result


def print_table(title, header, rows):
    """A title and right-aligned columns."""
    cells = [header, *(tuple(_text(value) for value in row) for row in rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(header))]
    print(title)
    for number, row in enumerate(cells):
        print("  " + "   ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)))
        if number == 0:
            print("  " + "   ".join("-" * width for width in widths))
    print()


def _text(value):
    return f"{value:.3g}" if isinstance(value, float) else str(value)
