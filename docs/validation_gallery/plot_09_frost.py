"""
Climate: a freezing front against Neumann
=========================================

Depth of frost below a surface that is suddenly 10 K below freezing. Witness: Neumann's closed form.
"""

import treadload as tl
from treadload.validation import run_checks

checks = run_checks(names=["frost"])
figure = tl.plots.new_figure(7, 3.8)
axes = figure.subplots()
labels = [check.quantity.replace(": depth after ", ",\n").replace(", m", "") for check in checks]
rows = range(len(checks))
axes.barh(rows, [check.measured for check in checks], height=0.6, label="treadload")
axes.plot([check.reference for check in checks], rows, "k|", markersize=16, markeredgewidth=2, label="Neumann")
axes.set_yticks(rows, labels, fontsize=7.5)
axes.set(xlabel="depth of the front (m)")
axes.invert_yaxis()
axes.legend(frameon=False)

# %%
# Largest relative deviation:

deviation = max(abs(check.deviation) for check in checks)
print(f"{deviation:.2%}")
