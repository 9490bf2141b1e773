"""Maps as files: exact and complete; broken files are refused with a sentence."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.harmonic import HarmonicMap, MapError

from ..support.domains import domain, random_map

Data = dict[str, Any]


def saved(name: str = "ring") -> Data:
    return random_map(name, 0.3, 1).to_dict()


@given(
    name=st.sampled_from(["ell", "ring", "triple"]),
    size=st.sampled_from([0.0, 1e-300, 0.1, 1e17]),
    seed=st.integers(0, 1000),
)
@settings(max_examples=15)
def test_saving_and_loading_is_exact(
    tmp_path_factory: pytest.TempPathFactory, name: str, size: float, seed: int
) -> None:
    map = random_map(name, size, seed)
    path = tmp_path_factory.mktemp("maps") / "map.json"
    map.save(path)
    loaded = HarmonicMap.load(str(path))
    assert loaded.phi.tobytes() == map.phi.tobytes()
    assert loaded.psi.tobytes() == map.psi.tobytes()
    assert loaded.domain.hole_points.tobytes() == map.domain.hole_points.tobytes()
    assert loaded.domain.notes == map.domain.notes
    for cage, other in (
        (loaded.domain.cage, map.domain.cage),
        (loaded.domain.offset_cage, map.domain.offset_cage),
    ):
        for loop, same in zip(cage.loops, other.loops, strict=True):
            assert loop.tobytes() == same.tobytes()
    assert loaded.to_dict() == map.to_dict()
    loaded.save(path)
    assert json.loads(path.read_text()) == map.to_dict()


def test_the_file_holds_what_the_format_promises(tmp_path: Path) -> None:
    map = random_map("twin", 0.2, 2)
    map.save(tmp_path / "map.json")
    data = json.loads((tmp_path / "map.json").read_text(encoding="utf-8"))
    assert data["format"] == "glid_nb-map"
    assert data["version"] == 1
    m = map.domain.offset_cage.n_vertices
    assert len(data["phi"]) == len(data["psi"]) == m + 2
    assert len(data["offset_cage"]) + sum(len(hole) for hole in data["offset_holes"]) == m
    np.testing.assert_array_equal(np.array(data["phi"]) @ [1, 1j], map.phi)
    np.testing.assert_array_equal(np.array(data["hole_points"]), map.domain.hole_points)
    assert [len(hole) for hole in data["holes"]] == [4, 4]
    # The logarithm coefficients of holes come last and are conjugate.
    np.testing.assert_array_equal(np.array(data["psi"][-2:]) @ [1, -1j], map.phi[-2:])


def changed(**changes: Any) -> Callable[[Data], Any]:
    return lambda data: {**data, **changes}


def without(key: str) -> Callable[[Data], Any]:
    return lambda data: {k: v for k, v in data.items() if k != key}


def first_entry(key: str, value: Any) -> Callable[[Data], Any]:
    return lambda data: {**data, key: [value, *data[key][1:]]}


def last_entry(key: str, value: Any) -> Callable[[Data], Any]:
    return lambda data: {**data, key: [*data[key][:-1], value]}


NAN, INFINITY = float("nan"), float("inf")

BAD: list[tuple[str, Callable[[Data], Any], str]] = [
    ("a list", lambda data: [data], "format"),
    ("a number", lambda _: 7, "format"),
    ("null", lambda _: None, "format"),
    ("an empty object", lambda _: {}, "format"),
    ("another format", changed(format="glid_nb-session"), "format"),
    ("a format that is no text", changed(format=["glid_nb-map"]), "format"),
    ("a later version", changed(version=2), "version 2"),
    ("no version", without("version"), "version None"),
    ("a version as text", changed(version="1"), "version '1'"),
    *[
        (f"no {key}", without(key), f'"{key}"')
        for key in (*("cage", "holes", "offset_cage", "offset_holes", "hole_points", "phi", "psi"),)
    ],
    ("too few phi", lambda d: {**d, "phi": d["phi"][:-1]}, "phi"),
    ("too many psi", lambda d: {**d, "psi": [*d["psi"], [0, 0]]}, "psi"),
    ("phi as plain numbers", lambda d: {**d, "phi": [v[0] for v in d["phi"]]}, "phi"),
    ("phi as triples", lambda d: {**d, "phi": [[*v, 0] for v in d["phi"]]}, "phi"),
    ("phi nested deeper", lambda d: {**d, "phi": [d["phi"]]}, "phi"),
    ("psi ragged", first_entry("psi", [0.0]), "psi"),
    ("psi as an object", changed(psi={"re": 1}), "psi"),
    ("phi empty", changed(phi=[]), "phi"),
    ("phi null", changed(phi=None), "phi"),
    ("phi with null", first_entry("phi", [None, 0]), "phi"),
    ("phi with NaN", first_entry("phi", [NAN, 0]), r"phi\[0\]"),
    ("psi with Infinity", first_entry("psi", [0, -INFINITY]), r"psi\[0\]"),
    ("hole not conjugate", last_entry("psi", [3, 4]), "hole 1 .*not conjugate"),
    ("phi with a word", first_entry("phi", ["one", 0]), "phi"),
    ("a cage with NaN", first_entry("cage", [NAN, 0]), "exterior loop"),
    ("a cage of words", changed(cage="square"), "exterior loop"),
    ("an offset cage with Infinity", first_entry("offset_cage", [INFINITY, 0]), "offset cage"),
    ("a word in an offset cage", first_entry("offset_cage", "x"), "offset cage"),
    ("an offset cage with one number", first_entry("offset_cage", [1.0]), "offset cage"),
    ("no offset cage", changed(offset_cage=[]), "offset cage"),
    ("a hole point with NaN", changed(hole_points=[[NAN, 0]]), "hole 1"),
    ("a hole point outside", changed(hole_points=[[2, 0]]), "hole 1"),
    ("too many hole points", changed(hole_points=[[0, 0], [0, 0.1]]), "2 hole points"),
    ("holes as an object", changed(holes={}), "holes"),
    ("one hole too few", changed(holes=[]), "hole"),
    ("offset holes as a number", changed(offset_holes=3), "offset_holes"),
    ("an offset cage inside", lambda d: {**d, "offset_cage": d["holes"][0]}, "offset"),
]


def load_text(text: str, folder: Path) -> HarmonicMap:
    path = folder / "broken-map.json"
    path.write_text(text, encoding="utf-8")
    return HarmonicMap.load(path)


@pytest.mark.parametrize(("change", "culprit"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_a_wrong_file_is_refused(
    tmp_path: Path, change: Callable[[Data], Any], culprit: str
) -> None:
    text = json.dumps(change(saved()))
    with pytest.raises(MapError, match=rf"(?s)broken-map\.json.*{culprit}"):
        load_text(text, tmp_path)


STRICT: list[tuple[str, Callable[[Data], Any], str]] = [
    ("phi of texts", lambda d: {**d, "phi": [[str(a), str(b)] for a, b in d["phi"]]}, "phi"),
    ("one text among phi", first_entry("phi", ["1", 0]), "phi"),
    ("phi of truth values", first_entry("phi", [True, False]), "phi"),
    ("phi beyond floating point", first_entry("phi", [10**400, 0]), "phi"),
    ("a cage of texts", lambda d: {**d, "cage": [[str(a), str(b)] for a, b in d["cage"]]}, "loop"),
    ("a cage beyond floating point", first_entry("cage", [10**400, 0]), "loop"),
    ("hole points of texts", changed(hole_points=[["0.05", "-0.03"]]), "hole"),
    ("no hole points", changed(hole_points=None), "hole_points"),
]


@pytest.mark.parametrize(("change", "culprit"), [b[1:] for b in STRICT], ids=[b[0] for b in STRICT])
def test_numbers_must_be_numbers(
    tmp_path: Path, change: Callable[[Data], Any], culprit: str
) -> None:
    text = json.dumps(change(saved()))
    with pytest.raises(MapError, match=rf"(?s)broken-map\.json.*{culprit}"):
        load_text(text, tmp_path)


def test_an_offset_cage_is_never_made_up(tmp_path: Path) -> None:
    """The coefficients belong to the offset cage of the file; another one gives another map."""
    text = json.dumps({**saved("ell"), "offset_cage": None})
    with pytest.raises(MapError, match="offset_cage"):
        load_text(text, tmp_path)


@pytest.mark.parametrize("key", ["offset_cage", "offset_holes"])
def test_a_reversed_loop_does_not_change_the_map(tmp_path: Path, key: str) -> None:
    """Loops are reoriented on loading. Coefficients in the file's order would then be misplaced."""
    map = random_map("ring", 0.3, 1)
    data = map.to_dict()
    n = len(data["offset_cage"])
    part = slice(0, n) if key == "offset_cage" else slice(n, 2 * n)
    for name in ("phi", "psi"):
        values = data[name][part]
        data[name][part] = [values[0], *values[:0:-1]]
    loop = data[key] if key == "offset_cage" else data[key][0]
    flipped = [loop[0], *loop[:0:-1]]
    data[key] = flipped if key == "offset_cage" else [flipped]
    try:
        loaded = load_text(json.dumps(data), tmp_path)
    except MapError as error:
        assert "clockwise" in str(error)  # noqa: PT017 - either answer is right
    else:
        points = domain("ring").cage.exterior
        np.testing.assert_allclose(loaded(points), map(points), atol=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no JSON at all",
        "{",
        json.dumps(saved())[:-50],
        json.dumps(saved())[:100],
        json.dumps(saved()) + "}",
        "\ufeff{}",
        "[" * 100_000,
        '{"format": "glid_nb-map", "version": ' + "9" * 5000 + "}",
    ],
    ids=[
        *("empty", "prose", "brace", "truncated", "head only", "tail", "byte order mark"),
        *("deep nesting", "endless number"),
    ],
)
def test_what_is_not_json_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(MapError, match=r"broken-map\.json"):
        load_text(text, tmp_path)


def test_binary_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n\x00\xff\xfe")
    with pytest.raises(MapError, match=r"picture\.png is not a JSON file"):
        HarmonicMap.load(path)


def test_a_missing_file_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere"):
        HarmonicMap.load(tmp_path / "nowhere.json")


def test_a_failed_save_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "map.json"
    old = HarmonicMap.identity(domain("ring"))
    old.save(path)

    def fail(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(OSError, match="no space left"):
        random_map("ring", 0.5, 3).save(path)
    assert HarmonicMap.load(path).to_dict() == old.to_dict()
    assert [p.name for p in tmp_path.iterdir()] == ["map.json"]
