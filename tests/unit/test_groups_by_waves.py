"""K of a group at the surface against layers solved wave by wave, on periodic boxes, with a rainflow of its own.

The solver here shares nothing with the package: stiffness matrices of layers in plane strain for each wave (Kausel
and Roesset 1981 in their static limit, from a potential and a Papkovich function), a fast Fourier transform of
vertical pressure on a box, and the reduction of turning points by a stack.
"""

import functools
import itertools

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import treadload as tl
from treadload.damage import Criterion, FatigueLine
from treadload.damage.cycles import harm_of
from treadload.grid import Grid
from treadload.life.passage import Passing, passages
from treadload.life.seasons import Warm
from treadload.life.wheels import Wheels
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad

# The road of examples/design_life in July: modulus, Pa, Poisson's ratio, thickness, m.
LAYERS = ((3245e6, 0.35, 0.06), (4410e6, 0.35, 0.15), (120e6, 0.35, None))
ROAD = Pavement([Layer(Elastic(modulus, poisson), thickness) for modulus, poisson, thickness in LAYERS])
# The mean over a cube of 10 mm below the surface is the value in its middle, to bending.
MIDDLE, POWER, AXLE = 5e-3, 5, 1.31
LAW = FatigueLine(100e-6, -1 / POWER)
CELL = 10e-3
Y = -1.8 + 5e-3 * np.arange(721)
SINGLE, TRIDEM = (0.0,), (-AXLE, 0.0, AXLE)


@functools.cache
def trailer():
    """The pressure of a wheel of the example's trailer, 39 kN at 9 bar, rolling straight."""
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=9e5)
    contact = tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=39e3, friction=0.7), spacing=CELL).dataset
    count_y, count_x = contact["pressure"].shape
    grid = Grid(count_x, count_y, CELL, CELL, -(count_x // 2) * CELL, float(Y[0]) + CELL * (180 - count_y // 2))
    return GridLoad(grid, contact["pressure"].to_numpy(), np.zeros(grid.shape), np.zeros(grid.shape))


def standard_axle():
    """One side of the French standard axle: 65 kN on two discs of 0.662 MPa, 375 mm apart."""
    grid = Grid(27, 65, CELL, CELL, -13 * CELL, float(Y[0]) + CELL * 148)
    x, y = np.meshgrid(grid.x, np.abs(grid.y - grid.y.mean()) - 0.1875)
    force, pressure = 32.5e3, 0.662e6
    # Cells on the rim carry a part.
    share = np.clip(0.5 + (np.sqrt(force / pressure / np.pi) - np.hypot(x, y)) / CELL, 0, 1)
    share *= 2 * force / pressure / (share.sum() * CELL**2)
    return GridLoad(grid, pressure * share, np.zeros(share.shape), np.zeros(share.shape))


def solutions(k, modulus, poisson, z, sign):
    """Two fields that fade with sign·z of a wave e^{ikx}: along (by i), down, shear (by i) and normal traction."""
    shear = modulus / 2 / (1 + poisson)
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    s, c = -sign * k, 3 - 4 * poisson
    e = np.exp(s * z)
    fields = (
        (k * e, s * e, k * s * e, s * s * e),
        (k * z * e, (s * z - c) * e, k * (1 + s * z) * e, s * (1 + s * z - c) * e),
    )
    return [
        (along, down, shear * (d_along + k * down), lame * (d_down - k * along) + 2 * shear * d_down)
        for along, down, d_along, d_down in fields
    ]


def stiffness(k, modulus, poisson, thickness):
    """Tractions on the faces of a layer by their displacements; of a half-space for no thickness."""
    faces = [(0.0, -1.0)] if thickness is None else [(0.0, -1.0), (thickness, 1.0)]
    moved, pulled = [], []
    for z, outward in faces:
        fields = solutions(k, modulus, poisson, z, 1)
        if thickness is not None:
            fields += solutions(k, modulus, poisson, z - thickness, -1)
        moved += [[field[0] for field in fields], [field[1] for field in fields]]
        pulled += [[outward * field[2] for field in fields], [outward * field[3] for field in fields]]
    return np.array(pulled) @ np.linalg.inv(np.array(moved))


def along_by_wave(wavenumbers):
    """Horizontal displacement in the middle of the cube of unit pressure, by wavenumber, m/Pa."""
    (modulus, poisson, thickness), *below = LAYERS
    layers = [(modulus, poisson, MIDDLE), (modulus, poisson, thickness - MIDDLE), *below]
    result = []
    for k in wavenumbers:
        whole = np.zeros((2 * len(layers), 2 * len(layers)))
        for number, layer in enumerate(layers):
            part = stiffness(k, *layer)
            end = 2 * number + len(part)
            whole[2 * number : end, 2 * number : end] += part
        pressed = np.zeros(len(whole))
        pressed[1] = 1.0
        result.append(np.linalg.solve(whole, pressed)[2])
    return np.array(result)


def strain(places, box, wheel, step=0.03):
    """Largest in-plane strain (ny, nx) beyond the footprints of wheels in periodic boxes, where stress is tensile."""
    at = np.log(np.geomspace(1e-2, 300, 400))
    wave = CubicSpline(at, along_by_wave(np.exp(at)))
    count = 2 * round(box / step / 2)
    x = box / count * (np.arange(count) - count // 2)
    k = 2 * np.pi * np.fft.fftfreq(count, box / count)
    middle = wheel.grid.y.mean()
    beside = 0.07 + 0.5 * np.ptp(wheel.grid.y)
    across, along = (np.exp(-1j * np.outer(k, each)) for each in (wheel.grid.y - middle, wheel.grid.x))
    total = (across @ wheel.pressure @ along.T) * CELL**2 * np.exp(-1j * np.outer(k, places)).sum(axis=1)
    kx, ky = np.meshgrid(k, k)
    size = np.hypot(kx, ky)
    size[0, 0] = 1.0
    # Every other sign moves the origin into the middle; uniform strain of the box is none.
    spread = total * wave(np.log(np.minimum(size, 300))) / size * (count / box) ** 2
    spread[0, 0] = 0.0
    xx, yy, xy = (-np.fft.fftshift(np.fft.ifft2(spread * each).real) for each in (kx * kx, ky * ky, kx * ky))
    mean, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    tensile = mean + radius + LAYERS[0][1] * (mean - radius) > 0
    read = np.where(tensile, np.maximum(mean + radius, 0.0), 0.0)
    for place in places:
        read[np.ix_(np.abs(x) < beside, np.abs(x - place) < 0.2)] = 0.0
    return x, read


def damage(line):
    """Σ peak^5 - valley^5 of the cycles of a line, closed by a stack from rest to rest."""
    ends = [0.0]
    for value in [*line, 0.0]:
        if len(ends) > 1 and (ends[-1] - ends[-2]) * (value - ends[-1]) >= 0:
            ends[-1] = value
        elif value != ends[-1]:
            ends.append(value)
    total, stack = 0.0, []
    for value in ends:
        stack.append(value)
        while len(stack) > 3 and abs(stack[-2] - stack[-3]) <= min(
            abs(stack[-1] - stack[-2]), abs(stack[-3] - stack[-4])
        ):
            total += abs(stack[-2] ** POWER - stack[-3] ** POWER)
            del stack[-3:-1]
    # What is left rises to its largest and falls from it.
    return total + sum(max(after**POWER - before**POWER, 0.0) for before, after in itertools.pairwise(stack))


PASSAGES = ((SINGLE, trailer), (TRIDEM, trailer), (SINGLE, standard_axle))


@functools.cache
def factors_by_waves(box):
    """K of the tridem, how many standard axles it does, and the largest strain of a single axle."""
    worst, largest = [], []
    for places, wheel in PASSAGES:
        x, read = strain(places, box, wheel())
        worst.append(max(damage(read[row]) for row in np.flatnonzero((x >= 0) & (x < 1.2))))
        largest.append(read.max())
    return worst[1] / worst[0] / 3, worst[1] / worst[2], largest[0]


@functools.cache
def factors():
    """The same by a life's passages."""
    worst, largest = [], []
    for places, loaded in PASSAGES:
        wheel = loaded()
        grid = wheel.grid
        rolling = Wheels(
            tuple(wheel.moved(x=at) for at in places), np.array([grid.x + at for at in places]), None, "w", 0.0
        )
        criterion = Criterion("top", LAW, 0, "top", "in-plane")
        read = passages([Passing(rolling, Warm(ROAD, (criterion,)), Y, 11)])[0][0]
        worst.append(harm_of(LAW, read[:11].astype(float)).max())
        largest.append(read[0].max())
    return worst[1] / worst[0] / 3, worst[1] / worst[2], largest[0]


def test_the_tridem_and_its_standard_axles_are_those_of_waves_in_a_wide_box():
    factor, axles, largest = factors()
    by_waves, axles_by_waves, largest_by_waves = factors_by_waves(30.0)
    # Boxes of 30 m still add 0.5 % to the strain of one axle, and more between three, which the law takes five times:
    # measured 15.65 and 6.29 by passages, 15.86 and 6.25 by waves.
    assert largest == pytest.approx(largest_by_waves, rel=0.007)
    assert factor == pytest.approx(by_waves, rel=0.02)
    assert axles == pytest.approx(axles_by_waves, rel=0.01)
    # Those of examples/design_life.
    assert factor == pytest.approx(15.6, rel=0.01)
    assert axles == pytest.approx(6.3, rel=0.01)


def test_a_box_of_six_metres_gives_a_tenth_more():
    """Where factors of 17.3 and 6.9 come from: periodic boxes little longer than the group and its basin."""
    factor, axles, _ = factors_by_waves(6.0)
    assert factor == pytest.approx(17.3, rel=0.02)
    assert axles == pytest.approx(6.9, rel=0.01)


@pytest.mark.slow
def test_growing_boxes_converge():
    """Neighbours fade: measured 17.47, 16.21, 15.86 and 15.80 in boxes of 6, 10, 30 and 60 m."""
    widest = factors_by_waves(60.0)
    boxes = np.array([factors_by_waves(box) for box in (6.0, 10.0, 30.0)]) - widest
    assert (boxes > 0).all()
    assert (boxes[1:] < 0.45 * boxes[:-1]).all()
    assert (boxes[-1] < 0.005 * np.array(widest)).all()
    assert factors()[0] == pytest.approx(widest[0], rel=0.012)
