"""Problems from files: what is accepted, and how the rest is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb._errors import InputFileError
from glid_nb.session.problem import Problem, load_pose

SQUARE = [[-4, -4], [4, -4], [4, 4], [-4, 4]]
HOLE = [[-1, -1], [-1, 1], [1, 1], [1, -1]]
GOOD = {
    "cage": SQUARE,
    "holes": [HOLE],
    "handles": [[-3, -3], [3, 3]],
    "targets": [[-3, -3], [4, 3]],
}

Write = Callable[[Any], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def save(data: Any) -> Path:
        path = tmp_path / "problem.json"
        path.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
        return path

    return save


def test_a_problem_is_read(write: Write) -> None:
    problem = Problem.load(write(GOOD))
    assert problem.domain.n_holes == 1
    np.testing.assert_array_equal(problem.pose.targets, [[-3, -3], [4, 3]])


def test_holes_are_optional_and_other_keys_ignored(write: Write) -> None:
    problem = Problem.load(write({**GOOD, "holes": None, "name": "x", "results": {"iso": 1}}))
    assert problem.domain.n_holes == 0


def test_a_given_offset_cage_is_used_as_it_is(write: Write) -> None:
    parts = {
        "offset_cage": [[-5, -5], [5, -5], [5, 5], [-5, 5]],
        "offset_holes": [[[-0.5, -0.5], [-0.5, 0.5], [0.5, 0.5], [0.5, -0.5]]],
        "hole_points": [[0.1, 0.2]],
    }
    domain = Problem.load(write({**GOOD, **parts})).domain
    np.testing.assert_array_equal(domain.offset_cage.exterior, parts["offset_cage"])
    np.testing.assert_array_equal(domain.hole_points, [[0.1, 0.2]])


def test_a_given_offset_is_used(write: Write) -> None:
    domain = Problem.load(write({**GOOD, "holes": [], "offset": 0.25})).domain
    np.testing.assert_allclose(domain.offset_cage.bounds, (-4.25, -4.25, 4.25, 4.25))


def test_saving_and_loading_gives_the_same_problem(write: Write, tmp_path: Path) -> None:
    problem = Problem.load(write(GOOD))
    problem.save(tmp_path / "again.json")
    again = Problem.load(tmp_path / "again.json")
    assert again.to_dict() == problem.to_dict()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("", "is not a JSON file: Expecting value: line 1 column 1"),
        ("{'cage': 1}", "is not a JSON file: Expecting property name"),
        ("[" * 100_000, "is not a JSON file: "),
        ('{"cage": [], "cage": []}', 'is not a JSON file: the key "cage" is given twice'),
        ([1, 2], r"must hold a JSON object \{...\}, not a list"),
        ({}, 'the keys "cage", "handles", "targets" must be given'),
        ({**GOOD, "handles": None}, 'the key "handles" must be given'),
        ({**GOOD, "cage": "square"}, '"cage" must be a list of .* not a string'),
        ({**GOOD, "cage": {"0": 1}}, '"cage" must be a list of .* not an object'),
        ({**GOOD, "cage": [*SQUARE[:3], ["a", 1]]}, r'cage\[3\] must be a pair .* not \["a", 1\]'),
        ({**GOOD, "cage": [[1, 2, 3]]}, r"cage\[0\] must be a pair \[x, y\] of numbers"),
        ({**GOOD, "cage": [[True, 2]]}, r"cage\[0\] must be a pair \[x, y\] of numbers"),
        ({**GOOD, "cage": [*SQUARE[:3], [float("nan"), 1]]}, r"cage\[3\] must be finite"),
        ({**GOOD, "cage": SQUARE[:2]}, "exterior loop: 2 vertices given"),
        ({**GOOD, "holes": HOLE}, r"holes\[0\]\[0\] must be a pair"),
        ({**GOOD, "holes": 3}, '"holes" must be a list of loops, not a number'),
        ({**GOOD, "holes": [HOLE, HOLE]}, "hole 2"),
        ({**GOOD, "offset": -1}, '"offset" must be a positive number, not -1'),
        ({**GOOD, "offset": "0.1"}, '"offset" must be a positive number, not "0.1"'),
        ({**GOOD, "handles": [[-3, -3]]}, "1 handle but 2 targets"),
        ({**GOOD, "targets": [[-3, -3], [float("inf"), 0]]}, r"targets\[1\] must be finite"),
        ({**GOOD, "targets": [[-3, -3], [10**400, 0]]}, r"targets\[1\] must be finite"),
        ({**GOOD, "targets": [[-3, -3], [None, 0]]}, r"targets\[1\] must be a pair .* \[null, 0\]"),
        ({**GOOD, "handles": [[-3, -3], [-3, -3]]}, r"handles 0 and 1 .*\(-3, -3\)"),
        ({**GOOD, "handles": [[-3, -3], [9, 3]]}, r"handle 1 at \(9, 3\) lies outside"),
        ({**GOOD, "handles": [[0, 0], [3, 3]]}, r"handle 0 at \(0, 0\) lies outside"),
        ({**GOOD, "hole_points": [[3, 3]]}, "hole 1"),
        ({**GOOD, "offset_cage": SQUARE, "offset_holes": [HOLE]}, "offset"),
        ({**GOOD, "offset_holes": [HOLE]}, "offset_cage"),
    ],
)
def test_a_bad_problem_is_refused_by_name(write: Write, data: Any, message: str) -> None:
    path = write(data)
    with pytest.raises(InputFileError, match=message) as caught:
        Problem.load(path)
    assert str(caught.value).startswith(str(path))


def test_a_file_called_like_the_first_word_of_a_message_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("the").write_text("{}")
    with pytest.raises(InputFileError, match=r"^the: the keys"):
        Problem.load("the")


def test_a_binary_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
    with pytest.raises(InputFileError, match="it is neither UTF-8 nor UTF-16 text"):
        Problem.load(path)


def test_a_pose_needs_no_cage(write: Write) -> None:
    pose = load_pose(write({key: GOOD[key] for key in ("handles", "targets")}))
    assert len(pose) == 2


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"handles": [[0, 0]]}, 'the key "targets" must be given'),
        ({"handles": [[0, 0]], "targets": [[0]]}, r"targets\[0\] must be a pair"),
        ({"handles": [[0, 0]], "targets": []}, "1 handle but 0 targets"),
    ],
)
def test_a_bad_pose_is_refused_by_name(write: Write, data: Any, message: str) -> None:
    path = write(data)
    with pytest.raises(InputFileError, match=message) as caught:
        load_pose(path)
    assert str(caught.value).startswith(str(path))


def test_a_file_of_too_many_values_is_refused_unparsed(tmp_path: Path) -> None:
    path = tmp_path / "flood.json"
    path.write_bytes(b'{"cage": [' + b"1," * 5_000_000 + b"1]}")
    with pytest.raises(InputFileError, match=r"flood\.json is not a JSON file: it has over 4,000"):
        Problem.load(path)
