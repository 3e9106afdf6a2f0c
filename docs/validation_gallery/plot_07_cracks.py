"""
Cracks: stress intensity of a strip against handbooks
=====================================================

An edge crack in a free strip in tension and in bending, over its length. Witness: Kaya and Erdogan (1987).
"""

import numpy as np

import treadload as tl
from treadload.validation.cracking import _EXACT, of_strip

parts = np.linspace(0.05, 0.7, 14)
curves = np.array([of_strip(part) for part in parts])

figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
for column, kind in enumerate(("tension", "bending")):
    (drawn,) = axes.plot(parts, curves[:, column], label=f"{kind}, treadload")
    points = [values[column] for values in _EXACT.values()]
    axes.plot(list(_EXACT), points, "o", color=drawn.get_color(), label=f"{kind}, Kaya and Erdogan")
axes.set(xlabel="length of the crack over the width", ylabel="K over σ√(πa)")
axes.legend(frameon=False)

# %%
# Largest relative deviation:

deviation = max(abs(a / b - 1) for part, exact in _EXACT.items() for a, b in zip(of_strip(part), exact, strict=True))
print(f"{deviation:.1e}")
