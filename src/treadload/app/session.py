"""What the server keeps of one browser: its form, its runs, its uploaded files, its process. No other sees them."""

from __future__ import annotations

import asyncio
import os
import re
import secrets
import shutil
import tempfile
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path

from treadload.app.answers import Allowed, Answer, Card, PageRow
from treadload.app.engines import Engine, EngineLost, Engines
from treadload.app.form import Form
from treadload.errors import InputError
from treadload.files import write_whole

# Files and runs that one browser keeps; the oldest go.
_MOST_FILES, _MOST_RUNS = 24, 40
_MOST_BYTES = 512 * 2**20
MESHES = (".obj", ".ply", ".stl", ".glb", ".off")
MAPS = (".nc", ".csv", ".npy", ".npz")
FOOTPRINTS = (".csv", ".nc", ".asf", ".txt")
STUDIES = (".nc",)
FILES = {
    "tire.scan": ("mesh …", MESHES), "tire.height_map": ("height map …", MAPS),
    "climate.file": ("weather …", (".csv", ".epw")), "footprint.file": ("recorded stress …", FOOTPRINTS),
    "texture.file": ("texture …", (".csv", ".txt", ".dat", ".x3p", ".sdf", ".sur", ".al3d", ".npy", ".nc")),
}  # fmt: skip
"""How paths of keys end that name a file: the label of its button, and what it takes."""
_STORES = (".zarr", ".zip")


@dataclass
class Run:
    """A solved case. page: address of the page that asked for it. rows: of its results. allowed: rows and notes on
    load repetitions by criterion. card: the answer at a glance. unsolved: a sentence on what of its case the page did
    not solve. thumb: a picture, as data URL, drawn in thumb_theme.
    """

    name: str
    title: str
    form: Form | None
    page: str = "/"
    rows: list[PageRow] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    allowed: Allowed = field(default_factory=Allowed)
    card: Card | None = None
    unsolved: str = ""
    ready: bool = False
    thumb: str = ""
    thumb_theme: str = "light"


@dataclass
class Session:
    """One browser. folder: private, emptied with the server.

    files: name the user knows → name of the kept file. replaced: kept file → the kept file of that name before it.
    """

    engines: Engines
    folder: Path = field(default_factory=lambda: Path(tempfile.mkdtemp(prefix="treadload-app-")))
    forms: dict[str, Form] = field(default_factory=dict)
    runs: dict[str, Run] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
    replaced: dict[str, str] = field(default_factory=dict)
    _engines: dict[str, Engine] = field(default_factory=dict)
    _lock: asyncio.Lock = field(default_factory=asyncio.Lock)
    _closed: bool = False

    async def engine(self, page: str) -> Engine:
        """The process of this browser for a page: a life goes on while the bench solves another wheel."""
        async with self._lock:
            engine = self._engines.get(page)
            if engine is None or not engine.lives:
                engine = await self.engines.take(self.folder)
                if self._closed:
                    engine.kill()
                    raise EngineLost("this page was closed, and its session has ended; load it again")
                self._engines[page] = engine
            return engine

    async def ask(self, page: str, do: str, **question: object) -> AsyncIterator[Answer]:
        """Answers of the process of a page, see `Engine.ask`."""
        engine = await self.engine(page)
        async for answer in engine.ask(do, **question):
            yield answer

    async def last(self, page: str, do: str, **question: object) -> Answer:
        """The last answer of the process of a page."""
        return await (await self.engine(page)).last(do, **question)

    async def stop(self, page: str) -> None:
        """End what is being solved for a page; what was finished stays."""
        if page in self._engines:
            await self._engines[page].stop()

    def last_ready(self, page: str) -> Run | None:
        """The latest run of a page that can be shown."""
        return next((run for run in reversed(self.runs.values()) if run.page == page and run.ready), None)

    def new_run(self, form: Form | None, title: str, page: str) -> Run:
        """A run with a name that nobody guesses."""
        run = Run(secrets.token_hex(16), title, form, page)
        self.runs[run.name] = run
        while len(self.runs) > _MOST_RUNS:
            oldest = next(iter(self.runs))
            del self.runs[oldest]
            (self.folder / f"{oldest}.nc").unlink(missing_ok=True)
        return run

    def keep(self, name: str, content: bytes, suffixes: tuple[str, ...]) -> str:
        """Keep an uploaded file under a name of ours; returns that name. Raises InputError for another suffix."""
        shown = re.split(r"[/\\]", name)[-1][:120]
        suffix = os.path.splitext(shown)[1].lower()
        if suffixes == STUDIES and suffix in _STORES:
            raise InputError(
                f"{shown} is a store of Zarr or an archive; its contents select the code that unpacks it, so "
                "no page opens one; bring the study as one file: "
                "tl.save_results(tl.sweeps.open_sweep('a.zarr'), 'a.nc')"
            )
        if suffix not in suffixes:
            raise InputError(f"{shown} is none of the files that go here: {', '.join(suffixes)}")
        stored = sum(path.stat().st_size for path in self.folder.iterdir() if path.is_file())
        if len(self.files) >= _MOST_FILES or stored + len(content) > _MOST_BYTES:
            raise InputError(
                f"this browser has {len(self.files)} files and {stored / 2**20:.0f} MB here, and {_MOST_FILES} files "
                f"and {_MOST_BYTES // 2**20} MB are the most; close its tabs for a minute, and all are removed"
            )
        kept = f"upload_{secrets.token_hex(8)}{suffix}"
        write_whole(self.folder / kept, content)
        if shown in self.files:
            self.replaced[kept] = self.files[shown]
        self.files[shown] = kept
        return kept

    def known_as(self, kept: str) -> str:
        """The name under which the user knows a file."""
        return next((shown for shown, name in self.files.items() if name == kept), kept)

    def in_words(self, text: str) -> str:
        """A sentence with the names of files as the user knows them."""
        for shown, kept in self.files.items():
            text = text.replace(str(self.folder / kept), shown).replace(kept, shown)
        return text

    def to_toml(self, form: Form) -> str:
        """The case of a form as the user would write it, with the names of their own files."""
        text = form.to_toml()
        for shown, kept in self.files.items():
            text = text.replace(kept, shown)
        return text

    def close(self) -> None:
        """End its processes and remove its files."""
        self._closed = True
        for engine in self._engines.values():
            engine.kill()
        shutil.rmtree(self.folder, ignore_errors=True)
