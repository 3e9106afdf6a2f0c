"""Texts that people read, from the clone: pages without code, messages, docstrings."""

import ast
import functools
import re
from collections import Counter
from pathlib import Path

import treadload

CLONE = Path(__file__).parents[1]
ROOT = Path(treadload.__file__).parent
GENERATED = ("executed", "auto_gallery", "auto_validation", "_ext")
PAGES = sorted(
    page
    for kind in ("*.md", "*.rst", "gallery/*.py", "validation_gallery/*.py")
    for page in (CLONE / "docs").rglob(kind)
    if page.relative_to(CLONE / "docs").parts[0] not in GENERATED
)
PAGES += [CLONE / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "AGENTS.md")]
# Texts that are no sentences for a reader: names in JavaScript and CSS.
NO_SENTENCE = re.compile(r"=>|\{font-family|^<span")


def prose(page):
    """Text of a page without code; of a script, its comments and docstring."""
    text = page.read_text("utf-8")
    if page.suffix == ".py":
        return "\n".join(re.findall(r'\A""".*?"""|^# [^\n]*', text, re.DOTALL | re.MULTILINE))
    return re.sub(r"```(?!\{).*?```|~~~.*?~~~|`[^`\n]*`", "", text, flags=re.DOTALL)


def nodes(tree):
    """All nodes of a tree, as `ast.walk` and in a third of its time."""
    ahead = [tree]
    while ahead:
        node = ahead.pop()
        yield node
        for value in vars(node).values():
            if isinstance(value, ast.AST):
                ahead.append(value)
            elif isinstance(value, list):
                ahead.extend(part for part in value if isinstance(part, ast.AST))


@functools.cache
def code_of(path):
    """Import statements of a module, its functions with the names of their parameters, and all names that it makes up
    or uses with their counts: the rules of imports, parameters and names read each module once."""
    return code_in(path.read_text("utf-8"))


def code_in(source):
    """The same of a source."""
    statements, functions, names = [], [], Counter()
    for node in nodes(ast.parse(source)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            statements.append(node)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            functions.append((node.name, [argument.arg for argument in arguments]))
        if not isinstance(node, ast.alias | ast.keyword):
            for field in NAMING.intersection(node._fields):
                name = getattr(node, field)
                if isinstance(name, str):
                    names[name] += 1
    return statements, functions, names


NAMING = frozenset(["id", "arg", "name", "attr"])


@functools.cache
def texts_of(path):
    """Sentences and docstrings of a module, which is parsed once for the words and for the spelling."""
    tree = ast.parse(path.read_text("utf-8"))
    sentences = [text for text in strings(path, tree) if " " in text.strip() and not NO_SENTENCE.search(text)]
    return sentences, list(docstrings_of(tree))


def strings(path, tree):
    """Texts of a module that are no docstrings: messages, captions, help of options; and docstrings of commands."""
    docstrings, constants, functions = set(), [], []
    for node in nodes(tree):
        if isinstance(node, ast.Constant):
            if isinstance(node.value, str):
                constants.append(node)
        elif isinstance(node, ast.FunctionDef):
            functions.append(node)
        for child in getattr(node, "body", []) if not isinstance(node, ast.Lambda | ast.IfExp) else []:
            if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
                # The first of an owner, and those below an attribute.
                docstrings.add(child.value)
    for node in constants:
        if node not in docstrings:
            yield node.value
    if path.parent.name == "cli":
        for node in functions:
            if any("command" in ast.dump(mark) for mark in node.decorator_list):
                yield ast.get_docstring(node) or ""


def sentences(path):
    """Those strings of a module that a person reads."""
    return texts_of(path)[0]


def docstrings(path):
    """Docstrings of a module, its classes, functions and attributes that have public names, without code."""
    return texts_of(path)[1]


# Code, examples and names of arguments: "`code`", ">>> 1 + 1", "spacing:".
NO_WORDS = re.compile(r"`[^`\n]*`|^ *>>>.*|\b(\w+):", re.MULTILINE)


def docstrings_of(tree):
    """Docstrings below a tree, see `docstrings`."""
    todo = [tree]
    while todo:
        node = todo.pop()
        texts = []
        for child in node.body:
            if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
                # The first of an owner, and those below an attribute.
                texts.append(str(child.value.value))
            elif isinstance(child, ast.ClassDef | ast.FunctionDef) and not child.name.startswith("_"):
                todo.append(child)
        names = {part.arg for part in nodes(node) if isinstance(part, ast.arg)} if texts else set()
        for text in texts:
            yield NO_WORDS.sub(lambda found: found[0] if found[1] and found[1] not in names else "", text)  # noqa: B023
