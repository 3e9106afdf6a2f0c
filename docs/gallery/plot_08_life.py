"""
Years of a road
===============

A structure of the catalogue under two classes of axles and the twelve months of a mild climate.
"""

import treadload as tl

months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5]
case = tl.Case.from_text(f"""
spacing = "16 mm"
tire = {{ profile = "315/80R22.5" }}
pavement = {{ structure = "6 BBSG3 / 15 GB3 / PF3" }}
climate = {{ months = {months} }}
[traffic]
passes_per_year = 60000
growth = 0.02
years = 20
[[traffic.classes]]
name = "front axle"
share = 0.6
axle_load = "70 kN"
inflation_pressure = "8.3 bar"
[[traffic.classes]]
name = "trailer"
share = 0.4
axle_load = "80 kN"
inflation_pressure = "9 bar"
[[criteria]]
name = "bottom of the base"
law = "french-bituminous"
layer = "EB-GB3"
risk = "5 %"
""")
result = tl.run(case, leave_out=("sensitivity",))
print(result.summary())

figure = result.life.plot.years()

# %%
# Who does it, and when:

shares = result.life.plot.shares()
