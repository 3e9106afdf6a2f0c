"""A small OpenCRG road in each of the four formats, written as the specification has it."""

import numpy as np

HEAD = """$CT
a road of the tests
$
$ROAD_CRG
REFERENCE_LINE_START_U = 2.0   ! where it begins
REFERENCE_LINE_END_U = 4.0
REFERENCE_LINE_INCREMENT = 0.5
LONG_SECTION_V_RIGHT = -0.75
LONG_SECTION_V_LEFT = 0.75
LONG_SECTION_V_INCREMENT = 0.5
$
{more}$KD_Definition
#:{kind}
U:reference line u,m,2.0,0.5
D:reference line phi,rad
D:reference line banking,m/m
D:reference line slope,m/m
D:long section 1,m
D:long section 2,m
D:long section 3,m
D:long section 4,m
$
"""
GRID = 0.01 * np.array([[1.0, 2, 3, 2], [2, -1, 4, 1], [3, 2, 1, 5], [0, 1, 2, 3], [2, 2, -2, 1]])
BANKING, SLOPE = [0.02, 0.01, 0.0, -0.01, -0.02], [0, 0.1, 0.1, -0.05, 0.0]
KINDS = ("LRFI", "LDFI", "KRBI", "KDBI")


def crg(kind, more="", grid=GRID):
    """The bytes of a file. more: further blocks of its head."""
    rows = np.column_stack([np.zeros(5), BANKING, SLOPE, grid])
    head = HEAD.format(kind=kind, more=more).encode() + b"$" * 79 + b"\n"
    double = kind[1] == "D"
    if kind.startswith("K"):
        number = np.dtype(">f8" if double else ">f4")
        body = rows.astype(number).tobytes()
        return head + body + np.full(-len(body) % 80 // number.itemsize, np.nan, number).tobytes()
    wide, digits = (20, 15) if double else (10, 7)
    lines = []
    for row in rows:
        cells = ["*missing*".ljust(wide) if np.isnan(value) else f"{value:{wide}.{digits}f}" for value in row]
        lines += ["".join(cells[k : k + 80 // wide]) for k in range(0, len(cells), 80 // wide)]
    return head + ("\n".join(lines) + "\n").encode()
