"""Heat conduction in layers, beside closed forms."""

import math

import numpy as np
import pytest

from treadload.kernels.heat import Cells, conducted, graded, read_at

DAY = 86400.0
# An asphalt: W/(m K), J/(m³ K).
K, C = 1.2, 2.2e6
DEEP = math.sqrt(2 * K / C / (2 * math.pi / DAY))


def _even(cells: int, depth: float = 1.4) -> Cells:
    return Cells(np.full(cells, depth / cells), np.full(cells, K), np.full(cells, C))


def _wave(cells: Cells, steps: int, depths: np.ndarray) -> float:
    """Largest difference from exp(-z/δ) cos(ωt - z/δ) over the third day."""
    omega, z = 2 * math.pi / DAY, cells.centres
    start = np.exp(-z / DEEP) * np.cos(-z / DEEP)
    found = conducted(cells, start, DAY / steps, 2 * steps, surface=lambda t: math.cos(omega * t))
    t = np.arange(2 * steps + 1)[steps:, None] * DAY / steps
    exact = np.exp(-depths / DEEP) * np.cos(omega * t - depths / DEEP)
    return float(np.abs(read_at(cells, found[steps:], depths) - exact).max())


def test_a_daily_wave_fades_and_lags_as_in_a_half_space():
    depths = np.array([0.02, 0.08, 0.2])
    # Cells that halve, with steps so short that time adds nothing: a quarter of the error.
    wide, narrow = (_wave(_even(n), 288, depths) for n in (70, 140))
    assert math.log2(wide / narrow) == pytest.approx(2, abs=0.1)
    # Steps that halve: at a surface that is held at a temperature such methods lose a part of their order.
    long, short = (_wave(_even(560), s, depths) for s in (12, 24))
    assert math.log2(long / short) > 1.6
    assert narrow < 5e-4


def test_the_graded_cells_of_a_road_read_the_wave_within_half_a_per_cent():
    cells = graded(np.array([0.06, 0.2]), np.full(3, K), np.full(3, C), first=0.004, growth=1.12, depth=3.0)
    assert np.isclose(cells.thickness.sum(), 3.0)
    assert np.isclose(np.cumsum(cells.thickness)[:, None], [0.06, 0.2]).any(axis=0).all()
    assert len(cells.thickness) < 50
    assert _wave(cells, 96, np.array([0.02, 0.08, 0.2])) < 5e-3


def test_a_constant_flux_warms_the_surface_with_the_root_of_time():
    flux = 300.0

    def error(cells: int, steps: int) -> float:
        time = 4 * 3600.0
        found = conducted(
            _even(cells, 1.0), np.zeros(cells), time / steps, steps, flux=lambda t: lambda top: (flux, 0.0)
        )[-1, 0]
        exact = 2 * flux * math.sqrt(time / math.pi / (K * C))
        return abs(found / exact - 1)

    errors = [error(n, s) for n, s in ((50, 24), (100, 48), (200, 96))]
    assert errors[2] < 2e-3
    # A flux that sets in at once is not smooth in time: better than first order all the same.
    assert math.log2(errors[0] / errors[1]) > 1.2
    assert math.log2(errors[1] / errors[2]) > 1.2


def test_heat_that_flows_steadily_falls_in_each_layer_by_its_resistance():
    # Two layers, warm above and held at the start of what is far below: the sums of resistances.
    cells = Cells(np.full(40, 0.005), np.repeat([2.0, 0.5], 20), np.repeat([1e5, 1e5], 20))
    flux, sink = 100.0, 10.0
    # The last cell is so large a store that it stays.
    cells = Cells(
        np.append(cells.thickness, 1e-3), np.append(cells.conductivity, 1e6), np.append(cells.capacity, 1e19)
    )
    found = conducted(cells, np.full(41, sink), 600.0, 2000, flux=lambda t: lambda top: (flux, 0.0))[-1]
    assert found[0] - sink == pytest.approx(flux * (0.1 / 2.0 + 0.1 / 0.5), rel=1e-6)
    middle = read_at(cells, found[None], np.array([0.1]))[0, 0]
    # Linear across the interface between two middles: within half a cell's fall.
    assert middle - sink == pytest.approx(flux * 0.1 / 0.5, abs=flux * 0.0025 / 0.5)


def test_no_heat_is_lost_where_none_passes_the_surface():
    cells = graded(np.array([0.1]), np.array([1.0, 2.0]), np.array([2e6, 1e6]), first=0.01, growth=1.2, depth=1.0)
    start = np.linspace(40.0, 10.0, len(cells.thickness))
    found = conducted(cells, start, 3600.0, 200, flux=lambda t: lambda top: (0.0, 0.0))
    store = cells.capacity * cells.thickness
    assert found[-1, 1:] @ store == pytest.approx(start @ store, rel=1e-10)
    assert np.ptp(found[-1]) < np.ptp(start) / 10


def test_a_balance_that_cannot_be_met_leaves_no_number():
    # A flux that always drives away from where the surface is, whatever it is.
    def wild(top: float) -> tuple[float, float]:
        return (1e4 if top < 5 else -1e4), 0.0

    found = conducted(_even(10), np.zeros(10), 60.0, 5, flux=lambda t: wild)
    assert np.isnan(found[1:]).all()
