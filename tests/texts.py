"""Texts that people read, from the clone: pages without code, messages, docstrings."""

import ast
import re
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


def strings(path):
    """Texts of a module that are no docstrings: messages, captions, help of options; and docstrings of commands."""
    tree = ast.parse(path.read_text("utf-8"))
    owners = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    docstrings = {}
    for node in ast.walk(tree):
        for k, child in enumerate(getattr(node, "body", []) if not isinstance(node, ast.Lambda | ast.IfExp) else []):
            if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
                # The first of an owner, and those below an attribute.
                docstrings[id(child.value)] = node if k == 0 and isinstance(node, owners) else None
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.value
    if path.parent.name == "cli":
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and any("command" in ast.dump(mark) for mark in node.decorator_list):
                yield ast.get_docstring(node) or ""


def sentences(path):
    """Those strings of a module that a person reads."""
    return [text for text in strings(path) if " " in text.strip() and not NO_SENTENCE.search(text)]


def docstrings(path):
    """Docstrings of a module, its classes, functions and attributes that have public names, without code."""
    tree = ast.parse(path.read_text("utf-8"))
    todo = [tree]
    while todo:
        node = todo.pop()
        for child in node.body:
            if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
                # The first of an owner, and those below an attribute.
                names = [part.arg for part in ast.walk(node) if isinstance(part, ast.arg)]
                code = "|".join([r"`[^`\n]*`", "^ *>>>.*", *(rf"\b{name}:" for name in names)])
                yield re.sub(code, "", str(child.value.value), flags=re.MULTILINE)
            elif isinstance(child, ast.ClassDef | ast.FunctionDef) and not child.name.startswith("_"):
                todo.append(child)
