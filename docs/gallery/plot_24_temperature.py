"""
When is a road hottest, and where?
==================================

Temperatures over the depth of a road on a mean day of January and of July, from monthly means of the air.
"""

import treadload as tl

case = tl.Case.from_text("""
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
[climate]
air = { months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5], daily_range = "11 K", latitude = "45 deg" }
[traffic]
passes_per_year = 60000
years = 20
[[traffic.classes]]
name = "standard"
share = 1.0
axle_load = "130 kN"
inflation_pressure = "6.6 bar"
gear = "dual"
[[criteria]]
name = "bottom of the base"
law = "french-bituminous"
layer = "EB-GB3"
risk = "5 %"
""")
life = tl.run(case, leave_out=("sensitivity",)).life

figure = life.plot.temperatures()

# %%
# Service life of the base:

years = life.years("bottom of the base")
print(f"{years:.1f} years")
