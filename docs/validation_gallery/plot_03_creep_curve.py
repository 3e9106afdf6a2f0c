"""
Rolling: a creep curve against CONTACT
======================================

Force against creepage of an ellipse of steel on 48 x 44 cells. Witness: CONTACT (open source), example tractcurv.
"""

import treadload as tl
from treadload.validation.shearing import creep_curve

rows = creep_curve()
creepage, computed, printed = zip(*rows, strict=True)
figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
axes.plot([1e3 * value for value in creepage], computed, label="treadload")
axes.plot([1e3 * value for value in creepage], printed, "o", label="CONTACT")
axes.set(xlabel="longitudinal creepage (10⁻³)", ylabel="force over μP")
axes.legend(frameon=False)

# %%
# Largest deviation, over μP:

deviation = max(abs(a - b) for a, b in zip(computed, printed, strict=True))
print(f"{deviation:.5f}")
