"""The cross-section of the tread of a profile, drawn while its numbers are typed."""

from __future__ import annotations

import json
from dataclasses import replace

from treadload.app.figure_place import Place
from treadload.app.form import Form, profile_of
from treadload.plots.interactive.us_figure import in_display_units

_POINTS = 241


class TreadSection:
    """A place for the cross-section, on the page that is being built."""

    def __init__(self) -> None:
        self._place = Place("section-of-tread", "cross-section of the tread")

    def draw(self, form: Form) -> None:
        """Draw the profile of a form; what stood there stays where its numbers are wrong."""
        profile = profile_of(form)
        if profile is None:
            return
        places = [profile.width * (number / (_POINTS - 1) - 0.5) for number in range(_POINTS)]
        untied = replace(profile, grooves=tuple(replace(groove, tie_bar=0.0) for groove in profile.grooves))
        lines = [(profile, "solid")]
        if untied != profile:
            # Floors below the tie bars.
            lines.append((untied, "dot"))
        axis = {"showgrid": False, "zeroline": False, "ticks": "outside", "tickfont": {"size": 10}}
        data, layout = in_display_units(
            [{"type": "scatter", "mode": "lines", "x": [1e3 * y for y in places], "hoverinfo": "skip",
                      "y": [-1e3 * float(depth) for depth in tread.drop(places)],  # type: ignore[arg-type]
                      "line": {"color": "#8a94a0", "width": 2 if dash == "solid" else 1, "dash": dash}}
                     for tread, dash in lines],
            {"height": 120, "showlegend": False, "margin": {"l": 34, "r": 6, "t": 6, "b": 30},
                       "font": {"size": 10, "color": "#8a94a0"},
                       "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
                       "xaxis": {**axis, "title": {"text": "y (mm)", "standoff": 2}},
                       "yaxis": {**axis, "title": {"text": "mm"}}},
        )  # fmt: skip
        self._place.draw(json.dumps({"data": data, "layout": layout}))
