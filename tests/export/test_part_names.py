"""Names of the files of parts, which every file system must accept."""

from __future__ import annotations

from pathlib import Path

import pytest

from glid_nb import export
from glid_nb._files import portable_name
from glid_nb.cli import main
from glid_nb.export.formats import part_names
from glid_nb.session.document import Document
from glid_nb.session.document_file import save_document
from glid_nb.session.editor_model import EditorModel

from .test_parts import BLUE, RED, disk


def moving_document(first: str, second: str) -> Document:
    """Two disks with these names and two poses."""
    model = EditorModel(parts={first: disk(30, 22, RED), second: disk(85, 25, BLUE)})
    try:
        model.deformation.save_pose()
        return model.document
    finally:
        model.close()


@pytest.mark.parametrize("letter", ["x", "日"])
def test_long_names_of_parts_are_cut_to_what_files_may_have(letter: str, tmp_path: Path) -> None:
    long = [letter * 200, letter * 199 + "y"]
    names = part_names("a.motion.proof.json", ".motion.proof.json", long)
    assert len(set(names)) == 2
    for name in names:
        (tmp_path / name).write_text("")


def test_controls_of_the_writing_direction_are_left_out_of_file_names() -> None:
    assert portable_name("a\u202egnp.exe\u2066\u2069") == "agnp.exe"


def test_names_that_differ_only_in_how_an_accent_is_written_are_numbered() -> None:
    assert part_names("a.svg", ".svg", ["\u00e9", "e\u0301"]) == ("a-\u00e9.svg", "a-e\u0301-2.svg")


def test_all_files_of_an_animation_are_checked_before_anything_is_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    save_document(moving_document("red", "blue"), tmp_path / "two.glid")
    (tmp_path / "a-blue.motion.json").mkdir()

    def draw(*_: object, **__: object) -> None:
        raise AssertionError("drawn before the check")

    monkeypatch.setattr(export, "animate_parts", draw)
    assert main(["animate", str(tmp_path / "two.glid"), "--out", str(tmp_path / "a.motion.json")])
    assert "a-blue.motion.json" in capsys.readouterr().err
    assert not (tmp_path / "a-red.motion.json").exists()
