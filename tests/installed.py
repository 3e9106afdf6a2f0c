"""`python tests/installed.py`: blocks of README and docs, and every command, of the installed treadload.

Outside the clone, for an environment that holds the wheel and nothing of the tests: `.ci/wheel` makes it, from the
lowest or the newest version of every requirement. Works in a folder of its own; prints a line a step and ends with
the steps that failed. `--output cp1252` writes to an output of Western Windows, `--output C` to one of the locale C,
`--output closed` to a pipe that nobody reads: there a step fails by a traceback alone.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
from pathlib import Path

TESTS = Path(__file__).parent
README = TESTS.parent / "README.md"
# Pages whose blocks are run after those of the README.
PAGES = ("docs/howto/command_line.md", "docs/tutorials/hot_road.md")
SECONDS = 900.0
# What an output changes in the surroundings of a command. Files that it writes stay UTF-8.
OUTPUTS = {
    "utf-8": {"PYTHONUTF8": "1"},
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "latin-1": {"PYTHONIOENCODING": "latin-1"},
    "C": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    "ascii": {"TREADLOAD_ASCII": "1"},
    "closed": {},
}
ADDRESS = re.compile(r"http://\S+")
TITLE = re.compile(r"^│ ([a-z][a-z-]*) ", re.MULTILINE)
BLOCK = re.compile(r"```(\w*)\n(.*?)```", re.DOTALL)


def commands(program: list[str], environment: dict[str, str]) -> list[str]:
    """Names of the commands that `--help` lists."""
    readable = environment | {"PYTHONIOENCODING": "utf-8", "TREADLOAD_ASCII": ""}
    listed = subprocess.run([*program, "--help"], capture_output=True, text=True, encoding="utf-8", env=readable)
    return TITLE.findall(listed.stdout.partition("Commands")[2])


def pages_served(program: list[str], lines: list[list[str]]) -> list[tuple[str, list[str]]]:
    """(name, command) of every line that serves a page."""
    return [(" ".join(line), [*program, *line[1:], "--no-open"]) for line in lines if "app" in line]


def steps(program: list[str], environment: dict[str, str], validate: bool, page: bool) -> list[tuple[str, list[str]]]:
    """(name, command) of every step, in order."""
    pages = [README, *(TESTS.parent / page for page in PAGES)]
    blocks = [block for page in pages for block in BLOCK.findall(page.read_text(encoding="utf-8"))]
    python = [text for kind, text in blocks if kind == "python"]
    # The second block goes on with the results of the first.
    scripts = ["\n".join(python[:2]), *python[2:]]
    lines = [
        shlex.split(line, comments=True)
        for kind, text in blocks
        for line in text.splitlines()
        if not kind and line.startswith("treadload ")
    ]
    # A line that stands on two pages is run once: the second `treadload init` would find its file.
    lines = [line for number, line in enumerate(lines) if line not in lines[:number]]
    if page:
        return pages_served(program, lines)
    found = [("version", [*program, "--version"])]
    found += [(f"{name} --help", [*program, name, "--help"]) for name in commands(program, environment)]
    found += [("init calibrate", [*program, "init", "calibrate", "-o", "fit.toml"])]
    for line in lines:
        # Every row of the validation takes minutes.
        if "app" not in line and ("validate" not in line or validate):
            found.append((" ".join(line), [*program, *line[1:]]))
    # Last, as they may open what the commands wrote.
    for number, text in enumerate(scripts, 1):
        # In a file, as Python reads no text of a command under C.
        Path(f"script_{number}.py").write_text(text, encoding="utf-8")
        found.append((f"Python {number}", [sys.executable, "-P", f"script_{number}.py"]))
    return found


def files() -> None:
    """Write the files that the README calls the reader's."""
    import treadload as tl

    sys.path.insert(0, str(TESTS))
    from footprints import ribbed, tekscan

    shutil.copy(tl.example_mesh(), "tire.obj")
    for name in ("network.toml", "sections.csv"):
        shutil.copy(TESTS.parent / "examples" / "network" / name, name)
    Path("print.asf").write_text(tekscan([ribbed().pressure / 1e3]), encoding="latin-1")


def finished(command: list[str], environment: dict[str, str], read: bool = True) -> tuple[int, str]:
    """(exit status, what was printed) of a command that ends by itself.

    read: False closes the pipe of its output before it writes: status 0 where it ends, and its errors.
    """
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            command,
            stdout=subprocess.PIPE if read else writer,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            env=environment,
            timeout=SECONDS,
        )
    except subprocess.TimeoutExpired:
        return -1, f"no end within {SECONDS:g} s"
    finally:
        os.close(writer)
    return (done.returncode, done.stdout + done.stderr) if read else (0, done.stderr)


def served(command: list[str], environment: dict[str, str]) -> tuple[int, str]:
    """(0 where the page of `treadload app` is sent to who has its address, what was printed); ends the server."""
    server = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, encoding="utf-8", env=environment
    )
    # A server that never states its address is ended too.
    limit = threading.Timer(SECONDS, server.kill)
    limit.start()
    printed, complete = "", False
    for line in server.stdout:
        printed += line
        if address := ADDRESS.search(line):
            # The first request brings the cookie, with which the second brings the page.
            browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            try:
                for url in (address[0], address[0].partition("?")[0]):
                    with browser.open(url, timeout=60) as answer:
                        complete = "Normal load" in answer.read().decode()
            except OSError as error:
                printed += f"{error}\n"
            server.terminate()
    limit.cancel()
    server.wait()
    return int(not complete), printed


def main() -> int:
    """Run every step; 1 if one fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--validate", action="store_true", help="validate too, which takes minutes")
    parser.add_argument("--page", action="store_true", help="the commands that serve the page, and nothing else")
    parser.add_argument("--output", choices=OUTPUTS, default="utf-8", help="what standard output is")
    options = parser.parse_args()
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        files()
        home = Path(folder) / "home"
        home.mkdir()
        environment = {**os.environ, "HOME": str(home), "MPLBACKEND": "agg"} | OUTPUTS[options.output]
        read = options.output != "closed"
        for name, command in steps(
            [sys.executable, "-P", "-m", "treadload"], environment, options.validate, options.page
        ):
            # Python's own print raises into a closed pipe.
            if not read and command[-1].endswith(".py"):
                continue
            began = time.perf_counter()
            serves = "--no-open" in command
            code, printed = served(command, environment) if serves else finished(command, environment, read)
            word = "ok" if code == 0 else f"FAILED ({code})"
            print(f"{time.perf_counter() - began:6.1f} s  {word:12}  {name}", flush=True)
            if code or "Traceback" in printed:
                failed.append(name)
                print(printed[-3000:], flush=True)
        os.chdir(TESTS)
    print(f"{len(failed)} failed" + "".join(f"\n  {name}" for name in failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
