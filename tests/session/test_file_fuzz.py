"""Damaged or invented files: read, or refused with a sentence and in time."""

from __future__ import annotations

import copy
import io
import json
import time
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._errors import InputError
from glid_nb.energies import SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import Scribbles, TraceOptions
from glid_nb.pose import Pose
from glid_nb.session.document import Document, NamedPose
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.problem import Problem, load_pose
from glid_nb.solvers import Options

from ..support.domains import domain

pytestmark = pytest.mark.slow  # most of 250 examples take a few milliseconds

POSE = {"handles": [[2.0, 0.1], [-2.0, 0.3]], "targets": [[2.5, 0.0], [-2.0, 0.0]]}
PROBLEM = {
    "cage": [[-3, -3], [3, -3], [3, 3], [-3, 3]],
    "holes": [[[-1, -1], [-1, 1], [1, 1], [1, -1]]],
    "offset": 0.1,
    **POSE,
}
SCRIBBLES = {"foreground": [[[1, 2], [3, 4]]], "background": [[[5.5, 6]]]}


CHANGES = ("value", "value", "value", "gone", "key", "twice", "cut", "byte")


def _nested(depth: int) -> Any:
    value: Any = 1
    for _ in range(depth):
        value = [value]
    return value


ODD = st.one_of(
    st.sampled_from(
        [None, True, float("nan"), float("-inf"), 1e308, -1e120, 1e16, 1e-320, 10**400]
    ),
    st.sampled_from(["", "text", "\ud800", "mask", "x" * 9999, [], {}, [[]], [None], [1, 2, 3]]),
    st.sampled_from([[[0, 0], [1, 0], [0, 1]], [[1, 2]] * 300, {"a": {"b": 1}}, [[True, 1]]]),
    st.builds(_nested, st.sampled_from([3, 50, 300, *range(700, 980, 20)])),
    st.floats(),
    st.integers(),
)


def _places(value: Any, above: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    keys = value if isinstance(value, dict) else range(len(value) if isinstance(value, list) else 0)
    for key in keys:
        yield (*above, key)
        yield from _places(value[key], (*above, key))


def _changed(draw: Callable[[Any], Any], data: Any) -> bytes:
    """A JSON text with a changed value, key or byte, cut short, or with a repeated key."""
    data = copy.deepcopy(data)
    *above, last = draw(st.sampled_from(list(_places(data))))
    parent = data
    for key in above:
        parent = parent[key]
    change = draw(
        st.sampled_from(["value", "value", "value", "gone", "key", "twice", "cut", "byte"])
    )
    if change == "value":
        parent[last] = draw(ODD)
    elif change == "gone":
        del parent[last]
    elif change == "key" and isinstance(parent, dict):
        parent[draw(st.sampled_from(["", "cagee", "\ud800"]))] = parent.pop(last)
    text = json.dumps(data)
    if change == "twice":
        text = text[:-1] + f", {json.dumps(draw(st.sampled_from(list(data))))}: 1}}"
    raw = bytearray(text, "utf-8")
    place = draw(st.integers(0, len(raw) - 1))
    if change == "byte":
        raw[place] = draw(st.integers(0, 255))
    return bytes(raw[:place] if change == "cut" else raw)


@pytest.fixture(scope="module")
def members(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    ring = domain("ring")
    pose = Pose(POSE["handles"], POSE["targets"])
    energy, map = SymmetricDirichlet(), HarmonicMap.identity(ring)
    named = NamedPose("rest", pose, energy, Options(), map)
    image = np.full((30, 40, 4), 200, dtype=np.uint8)
    path = tmp_path_factory.mktemp("fuzz") / "a.glid"
    save_document(Document(image, ring.cage, ring, TraceOptions(), None, (named,), 0), path)
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _refused_or_read(load: Callable[[Path], Any], path: Path, raw: bytes) -> None:
    path.write_bytes(raw)
    began = time.process_time()
    try:
        load(path)
    except (InputError, OSError) as refusal:
        named = str(path) in str(refusal)
    else:
        named = True
    assert named
    assert time.process_time() - began < 2.0


@settings(derandomize=True, max_examples=150, deadline=None, database=None)
@given(data=st.data())
def test_a_damaged_json_file_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    loads: list[tuple[Callable[[Path], Any], Any]] = [
        (HarmonicMap.load, HarmonicMap.identity(domain("ring")).to_dict()),
        (Problem.load, PROBLEM),
        (load_pose, POSE),
        (Scribbles.load, SCRIBBLES),
    ]
    load, valid = data.draw(st.sampled_from(loads))
    path = tmp_path_factory.getbasetemp() / "fuzzed.json"
    _refused_or_read(load, path, _changed(data.draw, valid))


@settings(derandomize=True, max_examples=100, deadline=None, database=None)
@given(data=st.data())
def test_a_damaged_document_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, members: dict[str, bytes], data: st.DataObject
) -> None:
    changed = {
        **members,
        "document.json": _changed(data.draw, json.loads(members["document.json"])),
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, member in changed.items():
            archive.writestr(name, member)
    raw = bytearray(buffer.getvalue())
    for place in data.draw(st.lists(st.integers(0, len(raw) - 1), max_size=2)):
        raw[place] ^= 0x55
    _refused_or_read(load_document, tmp_path_factory.getbasetemp() / "fuzzed.glid", bytes(raw))
