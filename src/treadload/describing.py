"""What a description or a result says of itself where nobody asked for more: one screen at most."""

from __future__ import annotations

import base64
import dataclasses
import html
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

# A line of a summary that gives a key its value: after a colon, after blanks, or in a column of 14 letters.
_KEY = re.compile(r"(?P<key>[^\W\d][^:]{0,44}?(?=:|\s{2,})|[^\W\d]\S* \S+(?<=^.{13})(?= ))(?::|\s)\s*(?P<value>\S.*)")
# Wide blanks that make a line one of a table, and the rows that stand in a page before it is unfolded.
_BLANKS, _TABLE = re.compile(r"\S\s{2,}(?=\S)"), 3
_ROWS = 12
# Colours of whatever stands around it: a notebook may be light or dark.
_STYLE = (
    ".tl-result{font-family:system-ui,sans-serif;font-size:13px;line-height:1.45;color:inherit;max-width:60em}"
    ".tl-result .tl-title{font-weight:600;padding-bottom:3px;border-bottom:1px solid rgba(128,128,128,.45);"
    "margin-bottom:4px}.tl-result .tl-said{font-weight:400;opacity:.85;margin-left:.6em}"
    ".tl-result table.tl-rows{border-collapse:collapse;margin:2px 0 6px;border:0;background:transparent}"
    ".tl-result table.tl-rows th,.tl-result table.tl-rows td{border:0;background:transparent;padding:1px 14px 1px 0;"
    "text-align:left;vertical-align:top;font-size:13px;color:inherit;white-space:normal}"
    ".tl-result table.tl-rows th{font-weight:400;opacity:.7;white-space:nowrap}"
    ".tl-result .tl-main{display:flex;flex-wrap:wrap;gap:12px;align-items:flex-start}"
    ".tl-result .tl-main .tl-rows{flex:1 1 22em}"
    ".tl-result .tl-picture{width:320px;max-width:100%;height:auto;margin:2px 0 6px;border-radius:3px}"
    ".tl-result .tl-warning{border-left:3px solid #d55e00;background:rgba(213,94,0,.12);padding:2px 8px;"
    "margin:3px 0}"
    ".tl-result details{margin:2px 0}.tl-result summary{cursor:pointer;opacity:.8}"
    ".tl-result pre.tl-text{font-size:12px;white-space:pre-wrap;color:inherit;background:transparent;"
    "margin:4px 0 4px 1em}"
)
# Letters of a line and of a text, members of a list and numbers of a table that are written out.
_LINE, _TEXT, _MEMBERS, _NUMBERS = 100, 60, 8, 6


class HasSummary(Protocol):
    """A result that can be summed up."""

    def summary(self) -> str:
        """A screenful."""


def as_call(thing: Any) -> str:
    """A frozen dataclass as the call that makes it, without what stands at its default; serves as `__repr__`.

    Numbers to twelve digits, long texts cut, arrays and tables of numbers by their size, the first of many members.
    """
    told = []
    for field in dataclasses.fields(thing):
        value = getattr(thing, field.name)
        if field.repr and not _is_default(field, value):
            told.append(f"{field.name}={_written(value)}")
    return _joined(told, f"{type(thing).__name__}(", ")")


def first_line(result: HasSummary) -> str:
    """A result in a line: its kind and its verdict, or the first line of its summary. Serves as `__repr__`."""
    kind = type(result).__name__
    lines = [line.strip() for line in result.summary().splitlines() if line.strip()] or [""]
    said = next((line.removeprefix("Verdict: ") for line in lines if line.startswith("Verdict: ")), lines[0])
    return f"<{kind}: {_cut(said, 2 * _LINE)}>"


def as_html(
    kind: str, summary: str, warnings: Sequence[str], dataset: Any = None, picture: bytes | None = None
) -> str:
    """A result as a notebook shows it: its main numbers, a picture, warnings; folded, the summary and the dataset.

    kind: of the result. dataset: with a `_repr_html_` of its own, None for none. picture: a PNG. All texts are
    escaped.
    """
    lines = [line.strip() for line in summary.splitlines() if line.strip() and not line.startswith("warning: ")]
    said = next((line.removeprefix("Verdict: ") for line in lines if line.startswith("Verdict: ")), "")
    told = [line for line in lines if not line.startswith("Verdict: ") and len(_BLANKS.findall(line)) < _TABLE]
    matches = [_KEY.fullmatch(line) for line in told]
    rows = [("" if one is None else one["key"].strip(), line if one is None else one["value"].strip())
            for line, one in zip(told, matches, strict=True)]  # fmt: skip
    if not any(key for key, _ in rows):
        said, rows = said or (told[0] if told else ""), []
    escape = html.escape
    page = [f"<style>{_STYLE}</style>", '<div class="tl-result">']
    page.append(
        f'<div class="tl-title">{escape(kind)}<span class="tl-said">{escape(_cut(said, 3 * _LINE))}</span></div>'
    )
    if rows:
        cells = [
            f"<tr><th>{escape(key)}</th><td>{escape(_cut(value, 3 * _LINE))}</td></tr>"
            if key
            else f'<tr><td colspan="2">{escape(_cut(value, 3 * _LINE))}</td></tr>'
            for key, value in rows
        ]
        page.append(
            f'<div class="tl-main"><table class="tl-rows"><tbody>{"".join(cells[:_ROWS])}</tbody></table>'
            f"{_image(kind, picture)}</div>"
        )
    else:
        page.append(_image(kind, picture))
    page += [f'<div class="tl-warning">Warning: {escape(text)}</div>' for text in warnings]
    page.append(f'<details><summary>Summary</summary><pre class="tl-text">{escape(summary)}</pre></details>')
    if dataset is not None:
        page.append(f"<details><summary>Dataset</summary>{dataset._repr_html_()}</details>")
    return "".join([*page, "</div>"])


def _image(kind: str, picture: bytes | None) -> str:
    if picture is None:
        return ""
    data = base64.b64encode(picture).decode("ascii")
    return f'<img class="tl-picture" alt="{html.escape(kind)} in a figure" src="data:image/png;base64,{data}">'


def _is_default(field: dataclasses.Field[Any], value: Any) -> bool:
    if field.default is dataclasses.MISSING:
        return False
    # An array would compare by element.
    plain = isinstance(value, str | int | float | tuple) or dataclasses.is_dataclass(value)
    return value is field.default or (plain and bool(value == field.default))


def _written(value: Any) -> str:
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str):
        return repr(_cut(value, _TEXT))
    if hasattr(value, "shape"):
        return f"<{type(value).__name__} of {' x '.join(map(str, value.shape)) or 'one'}>"
    if isinstance(value, Mapping):
        return _members([f"{key!r}: {_written(one)}" for key, one in value.items()], "{", "}")
    if isinstance(value, tuple | list):
        if len(value) * max((len(one) for one in value if isinstance(one, tuple | list)), default=1) > _NUMBERS:
            size = _size_of_numbers(value)
            if size:
                return f"<{size} numbers>"
        brackets = ("(", ",)" if len(value) == 1 else ")") if isinstance(value, tuple) else ("[", "]")
        return _members([_written(one) for one in value], *brackets)
    return repr(value)


def _size_of_numbers(value: Any) -> str:
    """Size of a list or a table of numbers alone, as "3 x 6"; empty for anything else."""
    if all(isinstance(one, int | float) for one in value):
        return str(len(value))
    sizes = {_size_of_numbers(one) if isinstance(one, tuple | list) else "" for one in value}
    inner = sizes.pop() if len(sizes) == 1 else ""
    return f"{len(value)} x {inner}" if inner else ""


def _members(members: list[str], opening: str, closing: str) -> str:
    if len(members) > _MEMBERS:
        members = [*members[: _MEMBERS - 1], f"… {len(members)} in all"]
    return _joined(members, opening, closing)


def _joined(members: list[str], opening: str, closing: str) -> str:
    """On one line if it is short enough; else as many members a line as fit."""
    line = ", ".join(members)
    if "\n" not in line and len(opening) + len(line) + len(closing) <= _LINE:
        return opening + line + closing
    lines: list[str] = []
    for one in members:
        whole = "\n" not in one
        if whole and lines and "\n" not in lines[-1] and len(lines[-1]) + len(one) + 2 <= _LINE - 4:
            lines[-1] += f", {one}"
        else:
            lines.append(one)
    return "\n".join([opening, *(f"{_indented(one)}," for one in lines), closing.lstrip(",")])


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())


def _number(value: float) -> str:
    """5400000000.0 as 5.4e9, 6999999999.999999 as 7e9, 0.06 as it is."""
    if not math.isfinite(value):
        return repr(value)
    text = f"{value:.12g}"
    size = abs(value)
    if size and (size >= 1e5 or size < 1e-3):
        mantissa, exponent = f"{value:.11e}".split("e")
        text = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return text if any(mark in text for mark in ".e") else f"{text}.0"


def _cut(text: str, letters: int) -> str:
    return text if len(text) <= letters else f"{text[: letters - 1].rstrip()}…"
