"""
Designs: strains that a guideline prints
========================================

Worked examples of IRC:37-2018, computed there by IITPAVE and here.
"""

import treadload as tl
from treadload.validation import run_checks

checks = [check for check in run_checks(names=["published"]) if "strain" in check.quantity]
computed, printed = ([getattr(check, name) for check in checks] for name in ("measured", "reference"))

figure = tl.plots.new_figure(5.5, 4.6)
axes = figure.subplots()
ends = 0.8 * min(printed), 1.25 * max(printed)
axes.loglog(ends, ends, color="0.7", linewidth=1)
axes.loglog(printed, computed, "o")
axes.set(xlabel="printed strain (microstrain)", ylabel="computed strain (microstrain)")

# %%
# Largest relative deviation; the guideline prints one microstrain or a tenth:

deviation = max(abs(a / b - 1) for a, b in zip(computed, printed, strict=True))
print(f"{len(checks)} strains, {deviation:.2%}")
