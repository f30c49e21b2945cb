"""A directory is filled whole, or left as it was."""

import json
import os

import pytest

from carom.base.files import check_directory, staged_directory
from carom.base.outcome import InputError


def fill(path, files):
    with staged_directory(str(path), "--out") as place:
        for name, content in files.items():
            (place / name).parent.mkdir(exist_ok=True)
            (place / name).write_text(content, encoding="utf-8")


def content(path):
    return {str(file.relative_to(path)): file.read_text(encoding="utf-8") for file in path.rglob("*") if file.is_file()}


def test_new_directory_with_parents(tmp_path):
    fill(tmp_path / "a" / "b", {"report.html": "new", "figures/x.svg": "x"})

    assert content(tmp_path) == {"a/b/report.html": "new", "a/b/figures/x.svg": "x"}


def test_older_results_are_replaced_and_foreign_files_stay(tmp_path):
    names = {"figures": ["figures/x.svg", "figures/y.svg"]}
    fill(tmp_path / "out", {"study.json": json.dumps(names), "figures/x.svg": "old", "figures/y.svg": "old"})
    (tmp_path / "out" / "notes.txt").write_text("mine", encoding="utf-8")
    (tmp_path / "out" / "figures" / "mine.svg").write_text("mine", encoding="utf-8")

    fill(tmp_path / "out", {"study.json": "{}", "figures/x.svg": "new"})

    assert content(tmp_path / "out") == {
        "study.json": "{}",
        "figures/x.svg": "new",
        "notes.txt": "mine",
        "figures/mine.svg": "mine",
    }


@pytest.mark.parametrize(
    "names",
    [
        "../keep.txt",
        "/etc/hostname",
        "figures/../keep.txt",
        "figures/..",
        "notes.txt",
        3,
        None,
        "figures/deep/x.svg",
        "figures/\0",
        "figures/" + "x" * 999,
    ],
)
def test_a_manifest_removes_nothing_but_figures(tmp_path, names):
    (tmp_path / "keep.txt").write_text("mine", encoding="utf-8")
    fill(tmp_path / "out", {"study.json": json.dumps({"figures": [names]}), "notes.txt": "mine", "keep.txt": "mine"})
    fill(tmp_path / "out", {"study.json": "{}"})

    kept = {"keep.txt": "mine", "out/notes.txt": "mine", "out/keep.txt": "mine", "out/study.json": "{}"}
    assert content(tmp_path) == kept


@pytest.mark.parametrize("manifest", ["", "[]", "{", '{"figures": 3}', "null", "[" * 100_000])
def test_manifest_that_is_none_is_no_obstacle(tmp_path, manifest):
    fill(tmp_path / "out", {"study.json": manifest})
    fill(tmp_path / "out", {"study.json": "{}"})

    assert content(tmp_path / "out") == {"study.json": "{}"}


@pytest.mark.parametrize("there", [False, True])
@pytest.mark.parametrize("error", [ValueError("bad"), KeyboardInterrupt()])
def test_failure_changes_nothing(tmp_path, there, error):
    if there:
        fill(tmp_path / "out", {"report.html": "old"})

    def fail():
        with staged_directory(str(tmp_path / "out"), "--out") as place:
            (place / "report.html").write_text("half", encoding="utf-8")
            raise error

    with pytest.raises(type(error)):
        fail()

    assert content(tmp_path) == ({"out/report.html": "old"} if there else {})
    assert len(list(tmp_path.iterdir())) == there


def test_full_disk_is_an_input_error_and_changes_nothing(tmp_path):
    with pytest.raises(InputError, match="--out"), staged_directory(str(tmp_path / "out"), "--out"):
        raise OSError(28, "No space left on device")

    assert list(tmp_path.iterdir()) == []


def test_current_directory_and_links(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")

    fill("link", {"report.html": "new"})
    fill("real/..", {"study.json": "{}"})
    fill(".", {"report.html": "here"})

    assert content(tmp_path) == {"real/report.html": "new", "study.json": "{}", "report.html": "here"}


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write anywhere")
def test_directory_without_rights(tmp_path):
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(InputError, match="cannot be written"):
            check_directory(str(tmp_path / "out"), "--out")
    finally:
        tmp_path.chmod(0o700)
