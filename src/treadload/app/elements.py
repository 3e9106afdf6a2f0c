"""Elements of the page whose texts and attributes come from files and fields.

A string of props, of HTML or of a script is parsed by whoever gets it, so none is ever made of a variable: what
varies is set as a text or as an attribute, and what a script is called with goes as JSON. `tests/app/test_markup.py`
reads the sources for it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, TypeVar

from nicegui import ui
from nicegui.elements.mixins.text_element import TextElement

Any_Element = TypeVar("Any_Element", bound=Any)


def text(tag: str, content: str) -> TextElement:
    """An element that shows a text, whatever is in it. tag: of HTML, such as "h2"."""
    return TextElement(tag=tag, text=content)


def heading(content: str) -> TextElement:
    """The heading of a group."""
    return text("h2", content)


def with_attributes(element: Any_Element, **attributes: str) -> Any_Element:
    """The element with attributes of HTML; "_" in their names stands for "-"."""
    for name, value in attributes.items():
        element.props[name.replace("_", "-")] = value
    return element


def plain(content: str, do: Callable[..., object], *, main: bool = False, label: str = "") -> ui.element:
    """A button. label: for who does not see it, where the text alone does not say."""
    button = ui.element("button").classes("plain main" if main else "plain").props('type="button"')
    if label:
        with_attributes(button, aria_label=label)
    with button:
        text("div", content)
    return button.on("click", lambda: do())


def marks_change(element: Any_Element, event: str = "click") -> Any_Element:
    """The element, which marks results as those of another input as soon as it is used, before the server hears."""
    element.on(event, js_handler="() => treadloadEdited()")
    return element


def mark_error(element: ui.element, sentence: str) -> None:
    """State at a field what is wrong with it; "" for nothing."""
    element.props(remove="error error-message")
    if sentence:
        element.props["error"], element.props["error-message"] = True, sentence
    element.update()


def choosing(options: dict[str, str], value: str, label: str, do: Callable[[str], object]) -> ui.select:
    """One of a few."""
    select = ui.select(options, value=value, label=label, on_change=lambda event: do(event.value))
    return (
        marks_change(select, "update:model-value")
        .props("dense outlined options-dense")
        .classes("choice wide" if len(options.get(value, "")) > 18 else "choice")
    )


def call_script(name: str, *arguments: object) -> None:
    """Call a function of `look/bench.js` in the browser of the page that is being built."""
    assert name.isidentifier()
    ui.run_javascript(f"{name}({', '.join(json.dumps(argument) for argument in arguments)})")
