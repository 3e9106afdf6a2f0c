"""The short form of a description or a result: one screen at most."""

from __future__ import annotations

import base64
import dataclasses
import html
import math
import re
import textwrap
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Protocol

from treadload.rows import Row, as_text, blocks_of, notes_of, table_of
from treadload.spelling import printable

# Lines of the table of a result in a notebook that stand unfolded.
_ROWS = 14
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
)
# Letters of a line and of a text, members of a list and numbers of a table that are written out.
_LINE, _TEXT, _MEMBERS, _NUMBERS = 100, 60, 8, 6


class Described(ABC):
    """Whatever states numbers about itself by `rows`: summary, notebook and `repr` render them.

    title: of the class, what it is in words; left out, the name of the class with blanks between its words.
    """

    if TYPE_CHECKING:

        @property
        def title(self) -> str:
            """Name in words."""
            return ""

        @property
        def warnings(self) -> tuple[str, ...]:
            """Sentences for the user."""
            return ()
    else:
        title = ""
        warnings = ()

    def __init_subclass__(cls, **more: object) -> None:
        super().__init_subclass__(**more)
        if not cls.__dict__.get("title"):
            cls.title = class_in_words(cls.__name__)  # type: ignore[assignment, method-assign]
        # A dataclass would write another.
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = first_line  # type: ignore[assignment, method-assign]

    @property
    def heading(self) -> str:
        """The question in a line at most, behind the title; may be empty."""
        return ""

    @abstractmethod
    def rows(self) -> tuple[Row, ...]:
        """What it states, row by row, see `treadload.rows`; a row "verdict" with its sentence is the last."""

    def summary(self) -> str:
        """The result in a screenful: its title and question, its rows, its warnings.

        Characters that standard output cannot show are spelt in ASCII, so that the text can be printed anywhere.
        """
        return printable(self.text())

    def text(self) -> str:
        """The summary with all its characters, for files."""
        rows = as_text(self.rows(), self.warnings)
        return "\n".join(part for part in (title_of(self), rows) if part)

    def __str__(self) -> str:
        return self.summary()


def class_in_words(name: str) -> str:
    """Name of a class with blanks between its words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).capitalize()


def title_of(result: Described) -> str:
    """Title and question of a result in a line."""
    return f"{result.title}: {result.heading}" if result.heading else result.title


def verdict_of(result: Described) -> str:
    """The sentence of the row "verdict", the answer; empty without one."""
    return next((str(row.value) for row in result.rows() if row.key == "verdict"), "")


class Frozen(Protocol):
    """A dataclass."""

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[object]]]


class HasHtml(Protocol):
    """What a notebook shows as a page."""

    def _repr_html_(self) -> str: ...


def as_call(thing: Frozen) -> str:
    """A frozen dataclass as the call that makes it, without what stands at its default; serves as `__repr__`.

    Numbers to twelve digits, long texts cut, arrays and tables of numbers by their size, the first of many members.
    """
    arguments = []
    for field in dataclasses.fields(thing):
        value = getattr(thing, field.name)
        if field.repr and not _is_default(field, value):
            arguments.append(f"{field.name}={_written(value)}")
    return _joined(arguments, f"{type(thing).__name__}(", ")")


def first_line(result: Described) -> str:
    """A result in a line: its kind, and its assessment, question or first row, as `__repr__` shows it."""
    text = verdict_of(result) or result.heading
    if not text:
        text = next((f"{row.label} {row.sentence}".strip() for row in result.rows()), result.title)
    return f"<{type(result).__name__}: {_cut(text, 2 * _LINE)}>"


def as_html(
    title: str,
    results: Sequence[Described],
    warnings: Sequence[str] = (),
    dataset: HasHtml | None = None,
    picture: bytes | None = None,
) -> str:
    """Results as a notebook shows them: rows, a picture, warnings; folded, all after the first, and the dataset.

    title: of all. dataset: with a `_repr_html_` of its own, None for none. picture: a PNG. All texts are escaped.
    """
    first = results[0] if len(results) == 1 else None
    answer = (verdict_of(first) or first.heading) if first is not None else ""
    page = [f"<style>{_STYLE}</style>", '<div class="tl-result">']
    page.append(f'<div class="tl-title">{_text(title)}<span class="tl-said">{_text(answer)}</span></div>')
    page.append('<div class="tl-main">')
    if first is not None:
        page.append(_shown(first))
    else:
        page.append('<div class="tl-rows">')
        for number, result in enumerate(results):
            page.append(
                f"<details{'' if number else ' open'}><summary>{_text(title_of(result))}</summary>"
                f"{_shown(result, folded=True)}</details>"
            )
        page.append("</div>")
    page.append(f"{_image(title, picture)}</div>")
    page += [f'<div class="tl-warning">Warning: {html.escape(text)}</div>' for text in warnings]
    if dataset is not None:
        page.append(f"<details><summary>Dataset</summary>{dataset._repr_html_()}</details>")
    return "".join([*page, "</div>"])


def _shown(result: Described, *, folded: bool = False) -> str:
    """The rows of a result. folded: the assessment too, which stands in the title otherwise."""
    return _rows_as_html([row for row in result.rows() if row.key != "verdict" or folded])


def _rows_as_html(rows: Sequence[Row]) -> str:
    """A table of label and value, a table of its own for groups with the same rows; what is long, folded."""
    lines: list[str] = []
    for block in blocks_of(rows):
        if len(block) > 1:
            heads, *cells = table_of(block)
            inner = f"<tr>{_cells('th', heads)}</tr>"
            inner += "".join(f"<tr>{_cells('th', line[:1])}{_cells('td', line[1:])}</tr>" for line in cells)
            lines.append(f'<tr><td colspan="2"><table class="tl-rows">{inner}</table></td></tr>')
            lines += [f'<tr><td colspan="2">{_text(note)}</td></tr>' for note in notes_of(block)]
            continue
        if block[0][0].group:
            lines.append(f'<tr><th colspan="2">{_text(block[0][0].group)}</th></tr>')
        lines += [f"<tr><th>{_text(row.label)}</th><td>{_text(row.sentence)}</td></tr>" for row in block[0]]
    shown, folded = lines[:_ROWS], lines[_ROWS:]
    table = '<table class="tl-rows"><tbody>{}</tbody></table>'
    more = f"<details><summary>More</summary>{table.format(''.join(folded))}</details>" if folded else ""
    return f"<div>{table.format(''.join(shown))}{more}</div>"


def _cells(tag: str, texts: Sequence[str]) -> str:
    return "".join(f"<{tag}>{_text(text)}</{tag}>" for text in texts)


def _text(text: str) -> str:
    return html.escape(_cut(text, 3 * _LINE))


def _image(kind: str, picture: bytes | None) -> str:
    if picture is None:
        return ""
    data = base64.b64encode(picture).decode("ascii")
    return f'<img class="tl-picture" alt="{html.escape(kind)} in a figure" src="data:image/png;base64,{data}">'


def _is_default(field: dataclasses.Field[object], value: object) -> bool:
    if field.default is dataclasses.MISSING:
        return False
    # An array would compare by element.
    plain = isinstance(value, str | int | float | tuple) or dataclasses.is_dataclass(value)
    return value is field.default or (plain and bool(value == field.default))


def _written(value: object) -> str:
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str):
        return repr(_cut(value, _TEXT))
    if hasattr(value, "shape"):
        return f"<{type(value).__name__} of {' x '.join(map(str, value.shape)) or 'one'}>"
    if isinstance(value, Mapping):
        return _members([f"{key!r}: {_written(item)}" for key, item in value.items()], "{", "}")
    if isinstance(value, tuple | list):
        if len(value) * max((len(item) for item in value if isinstance(item, tuple | list)), default=1) > _NUMBERS:
            size = _size_of_numbers(value)
            if size:
                return f"<{size} numbers>"
        brackets = ("(", ",)" if len(value) == 1 else ")") if isinstance(value, tuple) else ("[", "]")
        return _members([_written(item) for item in value], *brackets)
    return repr(value)


def _size_of_numbers(value: Sequence[object]) -> str:
    """Size of a list or a table of numbers alone, as "3 x 6"; empty for anything else."""
    if all(isinstance(item, int | float) for item in value):
        return str(len(value))
    sizes = {_size_of_numbers(item) if isinstance(item, tuple | list) else "" for item in value}
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
    for member in members:
        whole = "\n" not in member
        if whole and lines and "\n" not in lines[-1] and len(lines[-1]) + len(member) + 2 <= _LINE - 4:
            lines[-1] += f", {member}"
        else:
            lines.append(member)
    return "\n".join([opening, *(f"{textwrap.indent(line, '    ')}," for line in lines), closing.lstrip(",")])


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
