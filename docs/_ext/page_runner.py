"""Run the blocks of a page in order: TOML files are written, commands are run, Python runs in one session.

`run_page` is what the build of the site and the tests share. As a program it runs one page in a new folder and prints
what each block has printed and drawn as JSON:

    python docs/_ext/page_runner.py docs/tutorials/first_contact.md build/figures
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shlex
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

FENCE = re.compile(r"^```(\w+)(?: +([\w-]+))?\n(.*?)^```$", re.DOTALL | re.MULTILINE)
FILE_NAME = re.compile(r"# (\S+\.toml)\n")
# Commands that prepare the environment, which exists when a page is run.
SETUP = ("python3 -m venv", ". .venv/", "pip install", "git clone", "cd ")
# Characters in a line of output: as wide as a block of the site.
WIDTH = "100"


@dataclass(frozen=True)
class Block:
    """A fenced block of a page. language: after the fence. text: its lines. end: place behind it in the page."""

    language: str
    text: str
    end: int


@dataclass(frozen=True)
class Output:
    """Text that a block printed, and the picture files that it wrote, in the order of their names."""

    text: str = ""
    pictures: tuple[str, ...] = ()


@dataclass
class Session:
    """Outputs of the blocks of a page, the commands that were run and the names that its Python has left."""

    outputs: list[Output] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)
    names: dict[str, Any] = field(default_factory=dict)


def blocks_of(page: str) -> Iterator[Block]:
    """Blocks of a page in Markdown, from the top."""
    for match in FENCE.finditer(page):
        yield Block(match[1], match[3], match.end())


def run_page(path: Path, folder: Path) -> Session:
    """Run a page in the current folder, which must be `folder`.

    Raises ValueError for a block in a language that has no meaning here, RuntimeError for a command that fails;
    errors of Python blocks pass through with the name of the page and the line in it.
    """
    session = Session(names={"__name__": path.stem})
    page = path.read_text(encoding="utf-8")
    for block in blocks_of(page):
        before = _pictures(folder)
        printed = io.StringIO()
        if block.language == "toml":
            _write_toml(block, path, folder)
        elif block.language == "python":
            line = page[: block.end].count("\n") - block.text.count("\n")
            with contextlib.redirect_stdout(printed):
                exec(compile("\n" * line + block.text, str(path), "exec"), session.names)
        elif block.language == "sh":
            for command in block.text.splitlines():
                if not command.startswith(SETUP):
                    printed.write(_command(command))
                    session.commands.append(command)
        elif block.language != "text":
            raise ValueError(f"{path.name}: blocks are python, sh, toml or text (got {block.language!r})")
        after = _pictures(folder)
        drawn = sorted(name for name, changed in after.items() if before.get(name) != changed)
        session.outputs.append(Output(printed.getvalue(), tuple(drawn)))
    return session


def _write_toml(block: Block, path: Path, folder: Path) -> None:
    name = FILE_NAME.match(block.text)
    if name is None:
        raise ValueError(f"{path.name}: a TOML block starts with the name of its file, as in '# case.toml'")
    (folder / name[1]).write_text(block.text, encoding="utf-8")


def _command(command: str) -> str:
    """Output of a command of treadload."""
    from typer.testing import CliRunner

    from treadload.cli import app

    words = shlex.split(command)
    if words[0] != "treadload":
        raise ValueError(f"only commands of treadload can be run (got {command!r})")
    result = CliRunner().invoke(app, words[1:])
    if result.exit_code != 0:
        raise RuntimeError(f"{command}\n{result.output}")
    return result.stdout


def _pictures(folder: Path) -> dict[str, int]:
    """Picture files of a folder with the time of their last change, ns."""
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("*.png")}


def main(page: Path, target: Path) -> None:
    """Run a page in a folder that is removed afterwards; its pictures go to `target`."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["savefig.dpi"] = 110
    os.environ["COLUMNS"] = WIDTH
    page, target = page.resolve(), target.resolve()
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        session = run_page(page, Path(place))
        target.mkdir(parents=True, exist_ok=True)
        for output in session.outputs:
            for name in output.pictures:
                (target / name).write_bytes(Path(name).read_bytes())
        os.chdir(page.parent)
    print(json.dumps([{"text": output.text, "pictures": output.pictures} for output in session.outputs]))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
