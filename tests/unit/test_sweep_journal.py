"""The journal of a study: what a damaged byte takes, and what it leaves."""

import json
import re
import shutil

import numpy as np
import pytest

import treadload as tl
from sweeps import same, small_case
from treadload.errors import InputError
from treadload.steps import scene
from treadload.sweeps import open_sweep
from treadload.sweeps.arrays import keep_fields
from treadload.sweeps.journal import line_of, read_journal
from treadload.sweeps.record import Record

pytest.importorskip("zarr")
VARY = {"modulus": [1e9, 2e9, 4e9], "poisson": [0.25, 0.35]}
FIELDS = ["stress_zz"]


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """A case, its study in a store, and the same in memory."""
    folder = tmp_path_factory.mktemp("solved")
    case = small_case(folder)
    tl.sweep(case, VARY, fields=FIELDS, store=folder / "study.zarr")
    return case, folder / "study.zarr", tl.sweep(case, VARY, fields=FIELDS).dataset


def of_the_store(study):
    """Warnings of a study but those of its cases: they are on a small map, which the assessment is solved beyond."""
    return tuple(text for text in study.warnings if not re.match(r"\d+ cases?: ", text))


def flipped(path, at):
    """Turn one bit of a byte of a file over."""
    data = bytearray(path.read_bytes())
    data[at] ^= 0x04
    path.write_bytes(bytes(data))


def lines(path):
    return (path / ".records.jsonl").read_bytes().splitlines(keepends=True)


def copied(path, to):
    return shutil.copytree(path, to / path.name)


def test_one_damaged_byte_takes_one_case_and_a_sentence_says_which(solved, tmp_path):
    case, path, memory = solved
    path = copied(path, tmp_path)
    before = lines(path)
    flipped(path / ".records.jsonl", len(before[0]) + len(before[1]) + 60)
    half = open_sweep(path)
    assert (half.stats["solved"], half.stats["unsolved"]) == (5, 1)
    assert len(of_the_store(half)) == 1
    for words in ("line 3 of the journal", "the same command solves 1 case again", "check the disk"):
        assert words in of_the_store(half)[0]
    counts = []
    whole = tl.sweep(case, VARY, fields=FIELDS, store=path, progress=lambda done, total, what: counts.append(done))
    assert counts == [5, 6]
    assert "line 3" in of_the_store(whole)[0]
    assert "1 case was solved again" in of_the_store(whole)[0]
    assert same(whole.dataset, memory)
    # The damaged line stays behind, and nothing is missing any more.
    assert len(lines(path)) == 7
    assert of_the_store(open_sweep(path)) == ()
    assert same(open_sweep(path).dataset, memory)
    tl.sweep(case, VARY, fields=FIELDS, store=path, progress=lambda done, total, what: counts.append(done))
    assert counts == [5, 6]


@pytest.mark.parametrize("place", ["first byte", "end of a line", "checksum", "name of the checksum"])
def test_wherever_the_byte_stands(solved, tmp_path, place):
    case, path, memory = solved
    path = copied(path, tmp_path)
    end = sum(map(len, lines(path)[:2]))
    at = {"first byte": 0, "end of a line": end - 1, "checksum": end - 5, "name of the checksum": end - 18}[place]
    flipped(path / ".records.jsonl", at)
    lost = 2 if place == "end of a line" else 1
    assert open_sweep(path).stats["solved"] == 6 - lost
    assert f"solves {lost} case{'s' if lost > 1 else ''} again" in of_the_store(open_sweep(path))[0]
    assert same(tl.sweep(case, VARY, fields=FIELDS, store=path).dataset, memory)


def test_no_bit_of_a_journal_makes_another_number_or_takes_more_than_two_records(tmp_path):
    """Each byte of a small journal in turn; of its two neighbours a lost end of a line takes both."""
    records = [Record(n, 0.5 + n, {"net_area": ((), np.array(0.06 + n)), "governing": ((), np.array("base"))})
               for n in range(4)]  # fmt: skip
    data, path = b"".join(line_of(one.to_json()) for one in records), tmp_path / "journal"
    for at in range(len(data)):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0x01]) + data[at + 1 :])
        journal = read_journal(path, 4)
        assert len(journal.records) >= 2, at
        assert all(one.numbers["net_area"][1] == 0.06 + number for number, one in journal.records.items()), at
        # What is lost is told, but for a last line that lost its end and so was never whole.
        assert journal.damage(4 - len(journal.records)) or at == len(data) - 1, at


def test_a_journal_without_checksums_is_read(solved, tmp_path):
    case, path, memory = solved
    path = copied(path, tmp_path)
    old = []
    for line in lines(path):
        content = json.loads(line)
        del content["check"]
        content["numbers"] = {name: value if isinstance(value, list) else [[], value]
                              for name, value in content["numbers"].items()}  # fmt: skip
        old.append(json.dumps(content) + "\n")
    old[1] = old[1].replace('"seconds"', '"seconds', 1)
    (path / ".records.jsonl").write_text("".join(old))
    (path / ".current").unlink()
    assert open_sweep(path).stats["solved"] == 5
    assert "line 2 of the journal" in of_the_store(open_sweep(path))[0]
    assert same(tl.sweep(case, VARY, fields=FIELDS, store=path).dataset, memory)


def test_fields_are_put_together_when_a_case_fails_too(tmp_path, monkeypatch):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"
    memory = tl.sweep(case, VARY, fields=FIELDS)
    original = scene.load_case

    def fails(question, *args, **more):
        if question.as_tables()["pavement"]["layers"][0]["material"]["modulus"] == 2e9:
            raise MemoryError
        return original(question, *args, **more)

    with monkeypatch.context() as patch:
        patch.setattr(scene, "load_case", fails)
        study = tl.sweep(case, VARY, fields=FIELDS, store=path)
    assert study.stats["failed"] == 2
    assert not (path / ".fields").exists()
    kept = study.dataset["stress_zz"].load()
    # What failed is solved; the fields of the others come from the arrays, bit by bit.
    again = tl.sweep(case, VARY, fields=FIELDS, store=path)
    assert not (path / ".fields").exists()
    assert same(again.dataset, memory.dataset)
    assert np.isfinite(kept).any(("depth", "y", "x")).sum() == 4


def test_fields_that_waited_when_the_study_was_killed_are_put_together(solved, tmp_path):
    """As after a kill between the last record and the arrays of fields: every case is solved, no field in place."""
    case, path, memory = solved
    path = copied(path, tmp_path)
    shutil.rmtree(path / "stress_zz")
    axes = {name: memory[name].to_numpy() for name in ("depth", "y", "x")}
    rows = memory["stress_zz"].to_numpy().reshape(6, *(len(axis) for axis in axes.values()))
    for number, row in enumerate(rows):
        keep_fields(Record(number, 0.1, fields={"stress_zz": (tuple(axes), row)}, coordinates=axes), path / ".fields")
    assert same(tl.sweep(case, VARY, fields=FIELDS, store=path).dataset, memory)
    assert not (path / ".fields").exists()


@pytest.mark.parametrize("how", ["flipped", "lost", "of another case"])
def test_a_case_whose_fields_are_damaged_or_lost_is_solved_again_and_named(solved, tmp_path, how):
    case, path = small_case(tmp_path), tmp_path / "study.zarr"

    def stop(done, total, what):
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tl.sweep(case, VARY, fields=FIELDS, store=path, progress=stop)
    # As after a kill: fields that the arrays have, too, are taken from there.
    shutil.rmtree(path / "stress_zz")
    (path / ".current").unlink()
    file = path / ".fields" / "1.npz"
    if how == "flipped":
        flipped(file, len(file.read_bytes()) // 2)
    elif how == "lost":
        file.unlink()
    else:
        shutil.copy(path / ".fields" / "2.npz", file)
    study = tl.sweep(case, VARY, fields=FIELDS, store=path)
    assert study.stats["failed"] == 0
    assert "fields of 1 case in" in of_the_store(study)[0]
    assert "number 1 (modulus 1e+09 Pa, poisson 0.35): it was solved again" in of_the_store(study)[0]
    # The same case in another folder, solved in memory.
    assert same(study.dataset, solved[2])


@pytest.mark.parametrize(
    ("name", "how"),
    [
        *((name, how) for name in ("worst_strain", "stress_zz")
          for how in ("flipped .zarray", "flipped chunk", "deleted chunk")),
        # Of all arrays.
        ("stress_zz", "flipped .zmetadata"),
        ("stress_zz", "no mark"),
    ],
)  # fmt: skip
def test_damaged_arrays_are_never_read_and_made_again(solved, tmp_path, name, how):
    case, path, memory = solved
    path = copied(path, tmp_path)
    chunk = next(file for file in sorted((path / name).iterdir()) if file.name[0].isdigit())
    if how == "no mark":
        flipped(path / ".current", 5)
    elif how == "deleted chunk":
        chunk.unlink()
    else:
        file = {".zarray": path / name / ".zarray", "chunk": chunk, ".zmetadata": path / ".zmetadata"}
        file = file[how.split()[1]]
        flipped(file, len(file.read_bytes()) // 2)
    half = open_sweep(path)
    # Of the journal: every number, and no field.
    assert half.stats["solved"] == 6
    assert same(half.dataset, memory.drop_vars("stress_zz"))
    assert (
        "numbers are read from the journal, without fields; the same command makes the arrays again"
        in of_the_store(half)[0]
    )
    counts = []
    whole = tl.sweep(case, VARY, fields=FIELDS, store=path, progress=lambda done, total, what: counts.append(done))
    # A row of modulus is a chunk of the field.
    again = 6 if how == "no mark" else 0 if name == "worst_strain" or "zmeta" in how else 6 if "zarray" in how else 2
    assert counts == (list(range(6 - again, 7)) if again else [])
    assert "made again of the journal; check the disk" in of_the_store(whole)[0]
    assert ("solved again" in of_the_store(whole)[0]) == bool(again)
    assert same(whole.dataset, memory)
    assert of_the_store(open_sweep(path)) == ()


def test_a_damaged_description_is_refused_and_mended_by_the_same_command(solved, tmp_path):
    case, path, memory = solved
    path = copied(path, tmp_path)
    flipped(path / "study.json", 40)
    with pytest.raises(InputError, match=r"its study\.json cannot be trusted, .*the same `treadload sweep` mends it"):
        open_sweep(path)
    whole = tl.sweep(case, VARY, fields=FIELDS, store=path)
    assert "was damaged and is written again" in of_the_store(whole)[0]
    assert same(whole.dataset, memory)
    # Without the mark nothing says which study it is.
    flipped(path / "study.json", 40)
    (path / ".current").unlink()
    with pytest.raises(InputError, match="name another store, or remove the folder"):
        tl.sweep(case, VARY, fields=FIELDS, store=path)


def test_a_journal_that_lost_its_end_is_told(solved, tmp_path):
    case, path, memory = solved
    path = copied(path, tmp_path)
    (path / ".records.jsonl").write_bytes(b"".join(lines(path)[:4]))
    assert "has lost its end: the same command solves 2 cases again" in of_the_store(open_sweep(path))[0]
    whole = tl.sweep(case, VARY, fields=FIELDS, store=path)
    assert "has lost its end: 2 cases were solved again" in of_the_store(whole)[0]
    assert same(whole.dataset, memory)
