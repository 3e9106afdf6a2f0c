"""How far readings leave the range of a law: where it is compared, and in which words that is stated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from treadload.damage.laws.fatigue import FatigueLaw
from treadload.kernels.arrays import Array

# Share of the damage outside of a law's range that is worth a sentence.
_WORTH = 0.1


def outside(law: FatigueLaw, value: float) -> str:
    """On which side of the range of a law a reading lies, with the bound, in words; empty inside and for none."""
    low, high = law.validity
    if not value > 0 or low <= value <= high:
        return ""
    side, bound = ("above", high) if value > high else ("below", low)
    return f"{law.reads.in_words(value)} is {side} {law.reads.in_words(bound)}"


def warnings_of(law: FatigueLaw, strain: float | Array) -> tuple[str, ...]:
    """Sentences for the user about a law at a reading: numbers without a source, extrapolation.

    strain: what the law reads, any shape; the largest finite value decides. Without a reading nothing is stated.
    """
    strains = np.asarray(strain, dtype=float)
    largest = float(np.max(strains, where=np.isfinite(strains), initial=0.0))
    beyond = _extrapolated(law, largest)
    return tuple(filter(None, (f"{law}: {law.caveat}" if law.caveat else "", f"{law}: {beyond}" if beyond else "")))


def range_warnings(
    laws: Sequence[Sequence[FatigueLaw]], readings: Array, shares: Array, names: tuple[Sequence[str], Sequence[str]]
) -> list[str]:
    """Sentences on a criterion of a life: numbers of its laws without a source, and damage outside of their range.

    laws: (axle_class, season). readings, shares: largest reading and share of the damage, (axle_class, season).
    names: of the classes and of the seasons. How much damage lies outside is stated, with the class and season that
    do most of it; the largest reading of all, which may do little, besides.
    """
    most, largest = (_largest(values) for values in (shares, readings))
    caveats = dict.fromkeys(f"{law}: {law.caveat}" for law in (laws[k][s] for k, s in (most, largest)) if law.caveat)
    beyond = {(k, s): _extrapolated(laws[k][s], float(value)) for (k, s), value in np.ndenumerate(readings)}
    left = [at for at, text in beyond.items() if text]
    part = sum(float(shares[at]) for at in left)
    worst = max(left, key=lambda at: float(shares[at]), default=largest)
    texts = list(caveats)
    if part > _WORTH:
        texts.append(
            f"{laws[worst[0]][worst[1]]}: {100 * part:.0f} % of the damage is done outside of its range, most by "
            f"{names[0][worst[0]]}, {names[1][worst[1]]}: {beyond[worst]}"
        )
    if beyond[largest] and (part <= _WORTH or worst != largest):
        texts.append(f"{laws[largest[0]][largest[1]]}: {beyond[largest]}")
    return texts


def _largest(values: Array) -> tuple[int, int]:
    row, column = np.unravel_index(int(values.argmax()), values.shape)
    return int(row), int(column)


def _extrapolated(law: FatigueLaw, value: float) -> str:
    """That a reading lies outside of a law's range, and what is extrapolated; empty inside."""
    beyond = outside(law, value)
    passes = f"{law.allowable_passes(value):.2g} load repetitions" if beyond else ""
    return f"{beyond}, the limit of its range; {passes} are extrapolated" if beyond else ""
