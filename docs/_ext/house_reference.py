"""The reference: a directive that documents public names, and docstrings of the house as fields of Sphinx.

A docstring of the house says of each argument "name: words." in running text. Here each becomes a field.
"""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

TAIL = re.compile(r"(?<=[.;:?)`”\"]) (?=(?:Returns?|Raises|Sources?|Methods?|Build it)\b)")
NAME = re.compile(r"`([^`]+)`(?!_)")


class Api(SphinxDirective):
    """Documents the names in its content, each of the module in its argument: `{api} treadload.damage`."""

    required_arguments = 1
    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """One entry a name."""
        names = [word for line in self.content for word in line.split()]
        return self.parse_text_to_nodes(entries((self.arguments[0], name) for name in names))


class RegisteredFigures(SphinxDirective):
    """Lists the figures of every class of results: how they are drawn, and what they show."""

    def run(self) -> list[nodes.Node]:
        """A list a class."""
        return self.parse_text_to_nodes(registered_figures())


class Unlisted(SphinxDirective):
    """Documents what the rooms offer and no page beside this one names: what is new is in the reference."""

    def run(self) -> list[nodes.Node]:
        """One entry a name."""
        return self.parse_text_to_nodes(entries(unlisted(Path(self.env.doc2path(self.env.docname)).parent)))


def registered_figures() -> str:
    """The figures that are registered, class by class, as Markdown."""
    registry = import_module("treadload.figure_registry")
    classes = import_module("treadload.composing").result_classes()
    lines: list[str] = []
    for kind in sorted(classes):
        figures = registry.figures_of(kind)
        lines += ["", f"**{kind}**", ""] if figures else []
        for one in figures:
            options = ", ".join(list(inspect.signature(one.draw).parameters)[1:])
            first = (inspect.getdoc(one.draw) or one.name).partition("\n")[0]
            lines.append(f"- `.plot.{one.name}({options})`: {first}")
    return "\n".join(lines)


def listed(folder: Path) -> list[tuple[str, str]]:
    """What the pages of a folder document: modules and names in them."""
    found = []
    for page in sorted(folder.glob("*.md")):
        for place, names in re.findall(r"~~~\{api\} ([\w.]+)\n(.*?)~~~", page.read_text("utf-8"), re.DOTALL):
            found += [(place, name) for name in names.split()]
    return found


def unlisted(folder: Path) -> list[tuple[str, str]]:
    """Public names of the package and its rooms that the pages of a folder leave out."""
    known = {id(getattr(import_module(place), name)) for place, name in listed(folder)}
    top = import_module("treadload")
    rooms = [name for name in top.__all__ if inspect.ismodule(getattr(top, name))]
    rest = []
    for module in (top, *(getattr(top, room) for room in rooms)):
        for name in module.__all__:
            thing = getattr(module, name)
            if not name.startswith("_") and not inspect.ismodule(thing) and id(thing) not in known:
                known.add(id(thing))
                rest.append((module.__name__, name))
    return rest


def entries(names: Iterable[tuple[str, str]]) -> str:
    """Directives of Sphinx that document names of modules."""
    lines = []
    for place, name in names:
        thing, full = getattr(import_module(place), name), f"{place}.{name}"
        if inspect.isclass(thing):
            lines += [f".. autoclass:: {full}", "   :members:", ""]
        elif callable(thing) and hasattr(thing, "__qualname__"):
            lines += [f".. autofunction:: {full}", ""]
        else:
            lines += [f".. py:data:: {full}", "", f"   {told(thing)}", ""]
    return "\n".join(["```{eval-rst}", *lines, "```"]) if lines else ""


class Rest(SphinxDirective):
    """Table of contents of the pages beside this one that it does not name: a page that is new is in the book."""

    def run(self) -> list[nodes.Node]:
        """A toctree, or nothing."""
        here = Path(self.env.doc2path(self.env.docname))
        named = set(re.findall(r"^[\w-]+$", here.read_text(encoding="utf-8"), re.MULTILINE))
        rest = sorted(page.stem for page in here.parent.glob("*.md") if page.stem not in {*named, here.stem})
        if not rest:
            return []
        return self.parse_text_to_nodes("\n".join(["```{toctree}", ":maxdepth: 1", "", *rest, "```"]))


def told(value: Any) -> str:
    """A public value in a line."""
    words = type(value).__doc__ if type(value).__module__.startswith("treadload") else ""
    first = (inspect.cleandoc(words).split("\n\n")[0].replace("\n", " ") + " ") if words else ""
    short = str(value) if len(str(value)) < 60 and "\n" not in str(value) else ""
    return safe(first) + (f"``{short}``" if short else "")


def safe(text: str) -> str:
    """Text of a docstring in which nothing but its `names` is a sign of reStructuredText."""
    parts = NAME.split(text)
    out = []
    for place, part in enumerate(parts):
        if place % 2 == 0:
            out.append(re.sub(r"(?<=\w)_(?!\w)", r"\\_", re.sub(r"([*|\\])", r"\\\1", part)))
        else:
            before = "\\ " if out[-1] and not out[-1][-1].isspace() and out[-1][-1] not in "([" else ""
            after = "\\ " if place + 1 < len(parts) and re.match(r"\w", parts[place + 1]) else ""
            known = re.fullmatch(r"[A-Za-z_][\w.]*", part)
            out.append(f"{before}:py:obj:`{part}`{after}" if known else f"{before}``{part}``{after}")
    return "".join(out)


def parameters(thing: Any) -> list[str]:
    """Names of what a function or a class takes."""
    if inspect.isclass(thing) and dataclasses.is_dataclass(thing):
        return [field.name for field in dataclasses.fields(thing)]
    try:
        return list(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        return []


def fields(paragraph: str, known: list[str]) -> tuple[str, list[str]]:
    """Running text of a paragraph, and the fields of the names that it explains."""
    line = " ".join(paragraph.split())
    names = "|".join(map(re.escape, sorted(known, key=len, reverse=True)))
    heads = list(re.finditer(rf"(?:^|(?<=[.;:?)`\"] ))((?:(?:{names}), )*(?:{names})): ", line)) if known else []
    if not heads:
        return line, []
    text, made = line[: heads[0].start()].strip(), []
    ends = [*(head.start() for head in heads[1:]), len(line)]
    for head, end in zip(heads, ends, strict=True):
        words, *rest = TAIL.split(line[head.end() : end].strip())
        made.append(f":param {head[1].replace(', ', ' / ')}: {safe(words)}")
        if rest:
            text = f"{text} {' '.join(rest)}".strip()
    return text, made


def as_fields(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Rewrite a docstring, in place."""
    known = parameters(thing) if callable(thing) else []
    written: list[str] = []
    every: list[str] = []
    for paragraph in re.split(r"\n\s*\n", "\n".join(lines)):
        if not paragraph.strip():
            continue
        if paragraph.lstrip().startswith(">>>"):
            written += [*paragraph.splitlines(), ""]
        elif re.match(r"\s*[-*] |\s{2,}", paragraph) or "::" in paragraph:
            written += ["::", "", *("   " + line for line in paragraph.splitlines()), ""]
        else:
            text, made = fields(paragraph, known)
            written += [safe(text), ""] if text else []
            every += made
    lines[:] = [*written, *every, ""]


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.add_directive("api", Api)
    app.add_directive("unlisted", Unlisted)
    app.add_directive("figures", RegisteredFigures)
    app.add_directive("rest", Rest)
    app.connect("autodoc-process-docstring", as_fields)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
