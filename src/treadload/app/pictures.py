"""Registered figures of a run as pictures for the page."""

from __future__ import annotations

import base64
import inspect
import io
from collections.abc import Iterator, Mapping
from typing import Protocol, cast

from treadload.app.answers import Picture
from treadload.composing import BaseResult
from treadload.errors import InputError, one_line
from treadload.figure_registry import Drawing, RegisteredFigure, figures_of

Parts = Mapping[str, BaseResult]
Listed = tuple[str, RegisteredFigure, BaseResult, Drawing]


def pictures_of(name: str, parts: Parts) -> dict[str, Picture]:
    """The figures of a part of a run by their keys. name: of the part. parts: of the run, by their names."""
    return {key: _picture(figure, part, drawing) for key, figure, part, drawing in _listed(name, parts)}


def pictures_for(name: str, parts: Parts, criterion: str) -> dict[str, Picture]:
    """Those figures of a part that are drawn for one criterion, for this one."""
    return {
        key: _picture(figure, part, Drawing({**drawing.options, "criterion": criterion}, drawing.title))
        for key, figure, part, drawing in _listed(name, parts)
        if "criterion" in inspect.signature(figure.draw).parameters
    }


def titles_of(parts: Parts) -> dict[str, str]:
    """Titles of the figures of a run by their keys."""
    return {key: drawing.title for name in parts for key, _, _, drawing in _listed(name, parts)}


def picture_of(key: str, parts: Parts) -> Picture:
    """The figure of a run that has a key. Raises InputError for another key."""
    for name in parts:
        for name_of_figure, figure, part, drawing in _listed(name, parts):
            if name_of_figure == key:
                return _picture(figure, part, drawing)
    raise InputError(f"this run has no figure {key!r}; choose one of its list")


def _listed(name: str, parts: Parts) -> Iterator[Listed]:
    part = parts[name]
    beside = {name_of_part: result.dataset for name_of_part, result in parts.items()}
    for figure in figures_of(*(kind.__name__ for kind in type(part).__mro__)):
        try:
            drawings = figure.drawings(part.dataset, beside)
        # A condition of another package may fail in any way, and the figure then says so.
        except Exception:
            drawings = [Drawing(title=figure.name.replace("_", " "))]
        for number, drawing in enumerate(drawings):
            yield f"{name}.{figure.name}{f'.{number}' if number else ''}", figure, part, drawing


def _picture(figure: RegisteredFigure, part: BaseResult, drawing: Drawing) -> Picture:
    """Address and title of a picture; where it cannot be drawn, the reason in place of the address."""
    about: Picture = {"title": drawing.title, "wide": figure.wide}
    try:
        return {**about, "url": as_url(cast("Saved", figure.draw(part, **drawing.options)))}
    # One figure that fails, ours or another package's, does not take the others with it.
    except Exception as error:
        reason = one_line(str(error)).rstrip(".") or type(error).__name__
        return {**about, "url": "", "missing": f"{drawing.title} could not be drawn: {reason}."}


class Saved(Protocol):
    """A figure of whatever library that saves itself as a picture."""

    def savefig(self, fname: io.BytesIO, *, format: str, metadata: Mapping[str, object]) -> object:
        """Write the picture."""


def as_url(figure: Saved) -> str:
    """A figure as the address of a picture that holds it."""
    out = io.BytesIO()
    figure.savefig(out, format="svg", metadata={"Date": None})
    return f"data:image/svg+xml;base64,{base64.b64encode(out.getvalue()).decode()}"
