"""No text of a file is ever parsed as props, HTML or a script: the sources of the page are read for it."""

import ast
from pathlib import Path

import pytest
from jinja2 import DictLoader, Environment

import treadload.app
from treadload.app import policy

SOURCES = sorted(Path(treadload.app.__file__).parent.glob("*.py"))
# What is called with a string that somebody parses.
PARSED = {
    "props", "classes", "style", "html", "markdown", "add_head_html", "add_body_html", "add_css", "add_scss",
    "add_sass", "run_javascript", "add_slot", "set_content", "mermaid", "code", "default_props", "default_classes",
    "default_style", "run_method", "teleport", "query",
}  # fmt: skip
# The door to scripts: the name of a function of ours, and what it is called with as JSON.
DOOR = ("elements.py", "call_script")


def faults_of(source, name="some.py"):
    """Lines on which a string that somebody parses is made of a variable."""
    tree = ast.parse(source)
    constants = {
        target.id
        for one in tree.body if isinstance(one, ast.Assign) and isinstance(one.value, ast.Constant)
        for target in one.targets if isinstance(target, ast.Name)
    }  # fmt: skip

    def is_constant(one):
        if isinstance(one, ast.IfExp):
            return is_constant(one.body) and is_constant(one.orelse)
        return isinstance(one, ast.Constant) or (isinstance(one, ast.Name) and one.id in constants)

    faults = []
    doors = {
        id(inner)
        for one in ast.walk(tree) if isinstance(one, ast.FunctionDef) and (name, one.name) == DOOR
        for inner in ast.walk(one)
    }  # fmt: skip
    for call in ast.walk(tree):
        if not isinstance(call, ast.Call) or id(call) in doors:
            continue
        called = getattr(call.func, "attr", getattr(call.func, "id", ""))
        told = [*call.args, *(one.value for one in call.keywords)] if called in PARSED else []
        told += [one.value for one in call.keywords if one.arg == "js_handler"]
        faults += [call.lineno for one in told if not is_constant(one)]
    # Attributes that are HTML or an expression whoever sets them.
    for one in ast.walk(tree):
        if isinstance(one, ast.Constant) and isinstance(one.value, str) and "innerHTML" in one.value:
            faults.append(one.lineno)
        if isinstance(one, ast.Subscript) and getattr(one.value, "attr", "") == "props":
            key = one.slice
            if not isinstance(key, ast.Constant) and not _is_attribute_door(key):
                faults.append(one.lineno)
    return faults


def _is_attribute_door(key):
    """`props[f"data-{key}"]` and the names of keyword arguments begin with a letter, never with ":"."""
    if isinstance(key, ast.JoinedStr):
        return isinstance(key.values[0], ast.Constant) and key.values[0].value.startswith("data-")
    return isinstance(key, ast.Call) and ast.unparse(key) == "name.replace('_', '-')"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_no_string_that_is_parsed_is_made_of_a_variable(path):
    assert faults_of(path.read_text(encoding="utf-8"), path.name) == []


@pytest.mark.parametrize(
    "line",
    [
        "button.props(f'aria-label=\"{label}\"')", "button.props('aria-label=' + label)", "button.props(label)",
        "button.props('aria-label=%s' % label)", "button.props('a={}'.format(label))", "button.props(remove=label)",
        "one.classes(f'a {name}')", "one.classes(add='x' if a else name)", "ui.html(text)", "ui.run_javascript(code)",
        "ui.html(content=text)", "ui.element('h2').props('innerHTML=\"Tire\"')", "one.props[key] = value",
        "ui.on('x', js_handler=code)", "one.props[f'{key}'] = value",
    ],
)  # fmt: skip
def test_the_search_finds_what_it_should(line):
    assert faults_of(line) == [1]


@pytest.mark.parametrize(
    "line",
    [
        "button.props('dense')", "button.classes('a' if b else 'c')", "one.props['aria-label'] = label",
        "CODE = 'f()'\nui.run_javascript(CODE)", "label(text)",
    ],
)  # fmt: skip
def test_the_search_leaves_the_rest(line):
    assert faults_of(line) == []


def test_scripts_of_a_template_carry_the_nonce_and_what_is_put_into_it_does_not():
    loader = DictLoader({"a.html": "<style>b{}</style><script src=x></script>{{ brought | safe }}"})
    policy.give_nonces(loader)
    request = type("Request", (), {"scope": {policy.NONCE: "n0"}})()
    made = Environment(loader=loader).get_template("a.html")
    said = made.render(request=request, brought="<script>evil()</script>")
    assert said == '<style nonce="n0">b{}</style><script nonce="n0" src=x></script><script>evil()</script>'


def test_the_policy_allows_no_inline_script():
    (said,) = [value.decode() for name, value in policy.headers_of("n0", "127.0.0.1:1") if b"content-sec" in name]
    rules = {rule.split()[0]: rule.split()[1:] for rule in said.split("; ")}
    assert rules["script-src"] == ["'self'", "'nonce-n0'", "'unsafe-eval'"]
    assert rules["script-src-attr"] == rules["default-src"] == rules["object-src"] == ["'none'"]
    assert "'unsafe-inline'" not in rules["style-src"]
    assert policy.new_nonce() != policy.new_nonce()
    # An answer that loads nothing may load nothing.
    (bare,) = [value.decode() for name, value in policy.headers_of() if b"content-sec" in name]
    assert "script-src" not in bare
    assert "default-src 'none'" in bare
