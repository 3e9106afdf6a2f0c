"""What a distribution holds and says: versions and dependencies that agree, links, licences, nothing invented."""

import http.server
import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import tomllib
import types
from pathlib import Path

import pytest

import treadload as tl
from treadload.app.links import Links

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.fixture
def hook(monkeypatch):
    """The hook of the build, beside a stand-in for hatchling, which tests do not need."""
    interface = types.ModuleType("hatchling.metadata.plugin.interface")
    interface.MetadataHookInterface = object
    for name in ("hatchling", "hatchling.metadata", "hatchling.metadata.plugin"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, interface.__name__, interface)
    spec = importlib.util.spec_from_file_location("metadata_hook", ROOT / "packaging" / "metadata.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_file_states_the_same_version():
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text()
    stated = {
        "CITATION.cff": re.search(r"^version: (\S+)", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1],
        ".zenodo.json": json.loads((ROOT / ".zenodo.json").read_text())["version"],
        "codemeta.json": json.loads((ROOT / "codemeta.json").read_text())["version"],
        "recipe.yaml": re.search(r'version: "(\S+)"', recipe)[1],
    }
    assert set(stated.values()) == {tl.__version__}, stated


def test_codemeta_lists_what_the_project_asks_for():
    listed = json.loads((ROOT / "codemeta.json").read_text())["softwareRequirements"]
    assert listed == [re.match(r"[\w-]+", requirement)[0] for requirement in PROJECT["project"]["dependencies"]]


def test_the_conda_recipe_asks_for_what_the_project_asks_for():
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text()
    asked = re.findall(
        r"^    - ([a-z0-9-]+) ([<>=][^\n]*)$", recipe.split("  run:")[1].split("tests:")[0], re.MULTILINE
    )
    wanted = {re.match("[a-z0-9-]+", line)[0]: line for line in PROJECT["project"]["dependencies"]}
    found = {
        name.replace("matplotlib-base", "matplotlib"): f"{name.replace('-base', '')}{bound}" for name, bound in asked
    }
    assert found == {"python": f"python{PROJECT['project']['requires-python']}", **wanted}


def test_links_come_from_one_setting_and_none_is_invented(hook, capsys):
    setting = PROJECT["tool"]["hatch"]["metadata"]["hooks"]["custom"]
    assert setting["address"] == ""
    made = hook.CustomMetadataHook()
    made.root, made.config = str(ROOT), setting
    metadata = {}
    made.update(metadata)
    assert metadata["urls"] == {}
    assert metadata["readme"]["text"] == (ROOT / "README.md").read_text(encoding="utf-8")
    assert "no address of the project is set" in capsys.readouterr().err
    made.config = {"address": "https://example.org/road/"}
    made.update(metadata)
    text = metadata["readme"]["text"]
    assert metadata["urls"]["Issues"] == "https://example.org/road/issues"
    # Nothing relative is left, and what they lead to is there.
    assert not re.findall(r"\]\((?!https?:|#)", text)
    paths = re.findall(r"\(https://example\.org/road/(?:blob|raw)/main/([^)#]+)", text)
    assert len(paths) > 10
    assert all((ROOT / path).exists() for path in paths)


def test_a_source_distribution_holds_all_that_is_tracked():
    """It builds its docs and runs its tests, so that nothing of the top but what git alone reads is left out."""
    target = PROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]
    included = {name.lstrip("/") for name in target["include"]} | {"pyproject.toml"}
    if not (ROOT / ".git").exists():
        pytest.skip("not a clone")
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split(
        "\n"
    )
    assert {path.partition("/")[0] for path in listed if path} - included <= {".gitignore"}


def test_data_of_others_come_with_their_licences():
    """Each file is named in the table of sources; files of others have their licence beside them or are public."""
    data = ROOT / "src/treadload/catalogue/data"
    listed = re.findall(r"^\| `([^`]+)`", (data / "SOURCE.md").read_text(encoding="utf-8"), re.MULTILINE)
    files = [path.relative_to(data) for path in data.rglob("*") if path.is_file() and path.parent != data]
    assert [path for path in files if not any(path.match(pattern) for pattern in listed)] == []
    assert all(list(data.glob(pattern)) for pattern in listed)
    for source in data.glob("*/SOURCE.md"):
        beside = list(source.parent.glob("LICENSE*"))
        words = source.read_text(encoding="utf-8").casefold()
        assert beside or "data of the united states government, public" in words, source
    patterns = PROJECT["project"]["license-files"]
    shipped = {path for pattern in patterns for path in ROOT.glob(pattern)}
    assert {ROOT / "LICENSE", *data.rglob("LICENSE*")} <= shipped


def test_the_image_runs_as_a_user_and_is_asked_for_its_health():
    text = (ROOT / "Containerfile").read_text()
    assert re.search(r"^USER treadload$", text, re.MULTILINE)
    script = re.search(r'^HEALTHCHECK .*CMD \["python", "(\S+)"\]$', text, re.MULTILINE)[1]
    assert f"COPY packaging/health.py {script}\n" in text
    assert re.search(r'^ENTRYPOINT \["treadload"\]$', text, re.MULTILINE)
    extras = re.search(r"'\.\[([a-z,]+)\]'", text)[1].split(",")
    assert set(extras) <= set(PROJECT["project"]["optional-dependencies"])


class Page(http.server.BaseHTTPRequestHandler):
    """A page that answers 200 to /health alone."""

    def do_GET(self):
        self.send_response(200 if self.path == "/health" else 403)
        self.end_headers()

    def log_message(self, *_):
        pass


def test_the_health_of_an_image_is_that_of_its_page(tmp_path, monkeypatch):
    """The page's while it is served, at the address that a server writes; else whether the program starts."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    programs = tmp_path / "bin"
    programs.mkdir()
    program = programs / "treadload"
    program.write_text("#!/bin/sh\necho 1.2.3\n")
    program.chmod(0o755)
    environment = {**os.environ, "TMPDIR": str(tmp_path), "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}

    def health():
        command = [sys.executable, ROOT / "packaging" / "health.py"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        return done.returncode, (done.stdout + done.stderr).strip()

    assert health() == (0, "1.2.3")
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page) as server:
        port = server.server_address[1]
        threading.Thread(target=server.serve_forever, daemon=True).start()
        links = Links.begin("0.0.0.0", port, f"http://127.0.0.1:{port}/")
        assert health() == (0, "")
        server.shutdown()
    assert health() == (1, f"the page does not answer on 0.0.0.0, port {port}")
    links.end()
    program.write_text("#!/bin/sh\nexit 3\n")
    assert health()[0] == 3
