"""
All rows of the validation table
================================

Deviation over its bound for every row of the table: 1 is the bound. Those below 1e-6 are drawn at the
left edge.
"""

import re
from pathlib import Path

import treadload as tl

SUBJECTS = {
    "contact": "Hertz|Cattaneo|Spence|grooved|modulus from|contact modulus|paper|conditions|315/80|texture|crossing",
    "rolling": "Carter|Kalker|creep curve|rolling disc|Bentall|rubber \\(|Torsion|Onset",
    "bodies": "viscoelastic cyl|rigid cylinder|leaning|upright|rib|block|slab|section|five|three ribs|mirrored",
    "layers": "AMADEUS|parted|ELLEA|French structures|layers|footprint|punch|surface|stress|wheel on",
    "moving loads": "ELLVA|speed|passage|Huet|Prony|creep and",
    "yielding": "return maps|sphere|rut|indentation|drum|stones",
    "cracks": "crack|Paris",
    "service life": "French|MEPDG|energy ratio|IRC|frost|traffic|life|criteria|what roads",
    "measured data": "Backcalculated|mesh",
}
# The pages are built in their folder; sphinx-gallery runs this file in the folder of its source.
page = next(
    folder / "explanation" / "validation.md" for folder in Path.cwd().parents if (folder / "conf.py").exists()
)
ratios = {subject: [] for subject in [*SUBJECTS, "other"]}
for line in page.read_text(encoding="utf-8").splitlines():
    cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    if len(cells) != 8 or cells[0] in ("problem", "---"):
        continue
    deviation, bound = (float(cell.split()[0]) for cell in cells[4:6])
    subject = next((name for name, words in SUBJECTS.items() if re.search(words, cells[0])), "other")
    ratios[subject].append(abs(deviation) / bound if bound else 0.0)
ratios = {subject: values for subject, values in ratios.items() if values}

figure = tl.plots.new_figure(8.5, 4.4)
axes = figure.subplots()
for row, values in enumerate(ratios.values()):
    spread = [row + 0.3 * ((7 * k) % 11 / 10 - 0.5) for k in range(len(values))]
    axes.semilogx([max(value, 1e-6) for value in values], spread, "o", markersize=4, alpha=0.7)
axes.axvline(1.0, color="0.3", linewidth=1)
axes.annotate("bound", (1.0, -0.75), (4, 0), textcoords="offset points", fontsize=9)
axes.set_yticks(range(len(ratios)), [f"{subject} ({len(values)})" for subject, values in ratios.items()])
axes.set(xlabel="deviation over its bound", xlim=(7e-7, 3))
axes.invert_yaxis()

# %%
# Largest of all rows:

deviation = max(max(values) for values in ratios.values())
print(f"{sum(map(len, ratios.values()))} rows, largest deviation {deviation:.2f} of its bound")
