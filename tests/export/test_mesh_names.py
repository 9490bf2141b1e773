"""Names of parts in files of meshes, which other programs must read as one name each."""

from __future__ import annotations

import json

import pytest

from glid_nb.export import parts_glb, parts_obj, textured_mesh
from glid_nb.export.mesh import TexturedMesh

from ..support.shapes import bent, picture

NAMES = ["left arm", "#x", "", "world", "a\\"]


@pytest.fixture(scope="module")
def meshes() -> dict[str, TexturedMesh]:
    mesh = textured_mesh(picture(), bent(), 50)
    return dict.fromkeys(NAMES, mesh)


def test_the_names_in_an_obj_file_are_single_words(meshes: dict[str, TexturedMesh]) -> None:
    files = parts_obj(meshes, "my walk #2")
    texts = [files[f"my walk #2.{ending}"].decode().splitlines() for ending in ("obj", "mtl")]
    words = {
        key: [
            line.split(" ", 1)[1] for text in texts for line in text if line.startswith(f"{key} ")
        ]
        for key in ("o", "usemtl", "newmtl", "map_Kd")
    }
    assert words["o"] == ["left_arm", "_x", "part", "world", "a_"]
    assert words["usemtl"] == words["newmtl"] == [f"my_walk_2-{name}" for name in words["o"]]
    assert [f"{name}-texture.png" for name in words["usemtl"]] == words["map_Kd"]
    assert set(words["map_Kd"]) < set(files)


def test_a_part_may_have_the_name_of_the_node_around_all(meshes: dict[str, TexturedMesh]) -> None:
    data = parts_glb({"world": meshes["world"], "arm": meshes["world"]})
    tree = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    parts = [node for node in tree["nodes"] if "mesh" in node]
    assert [node["name"] for node in parts] == ["world", "arm"]
    assert not any("children" in node or "matrix" in node for node in parts)
