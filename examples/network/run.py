"""Twelve sections of a county's roads: how much of their service life is left, and which come first.

Two of the rows are wrong, as in real tables: they fail alone, and the result names them.
"""

from pathlib import Path

import treadload as tl

HERE = Path(__file__).parent


def main(folder: Path) -> tl.sweeps.Network:
    """Solve the sections, keep them in a store that a second call goes on in, and write a report that ranks them."""
    case = tl.Case.from_toml(HERE / "network.toml")
    network = tl.sweeps.solve_network(case, HERE / "sections.csv", store=folder / "network.zarr")
    tl.report(network, folder / "network.html", title="Roads of a county")
    return network


if __name__ == "__main__":
    print(main(Path.cwd()))
