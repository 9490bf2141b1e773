"""Exports of several shapes refuse what they cannot take, in words that say what to pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from glid_nb import HarmonicMap, InputError, Motion, export
from glid_nb.export import LivePart, MovingPart, StillPart
from glid_nb.export.mesh import TexturedMesh

from ..support.shapes import bent, domain, picture
from .test_live_page import unpacked


def moving(name: str = "", times: tuple[float, ...] | None = None) -> MovingPart:
    maps = [HarmonicMap.identity(domain()), bent()]
    return MovingPart(picture(), Motion(maps, times, between="linear"), name=name)


def mesh() -> TexturedMesh:
    return export.textured_mesh(picture(), bent(), 50)


BAD: dict[str, tuple[Callable[[], Any], str]] = {
    "an energy's name": (
        lambda: export.live_page_html(picture(), domain(), energy="amips"),  # type: ignore[arg-type]
        "energy must be Energy or None, not str; for example glid_nb.energies.by_name",
    ),
    "no number": (
        lambda: export.live_page_html(picture(), domain(), p2p_weight=math.nan),
        "p2p_weight is nan; it must be a finite number greater than 0",
    ),
    "tuples": (
        lambda: export.parts_live_html([(picture(), domain())]),  # type: ignore[list-item]
        r"parts\[0\] must be LivePart, not tuple; pass a list of LivePart",
    ),
    "one part": (
        lambda: export.parts_live_html(LivePart(picture(), domain())),  # type: ignore[arg-type]
        "parts must be Iterable, not LivePart; pass a list of LivePart",
    ),
    "no live part": (lambda: export.parts_live_html([]), "there are no parts; pass a list"),
    "no moving part": (lambda: export.animate_parts("a.gif", []), "no parts; pass a list of Mov"),
    "no files": (lambda: export.parts_motion_files("a.gif", []), "no parts; pass a list of Mov"),
    "no moving mesh": (lambda: export.parts_motion_glb([]), "no parts; pass a list of Mov"),
    "no page": (lambda: export.parts_page_html([]), "no parts; pass a list of PagePart"),
    "no still part": (lambda: export.parts_png([]), "no parts; pass a list of StillPart"),
    "no map": (
        lambda: export.parts_png([StillPart(picture(), None)]),  # type: ignore[arg-type]
        r"the map of parts\[0\] must be HarmonicMap, not NoneType",
    ),
    "no motion": (
        lambda: export.parts_motion_glb([MovingPart(picture(), None, name="a")]),  # type: ignore[arg-type]
        "the motion of 'a' must be Motion, not NoneType",
    ),
    "no mesh": (lambda: export.parts_glb({}), "meshes is empty; pass a dict of TexturedMesh"),
    "no object": (lambda: export.parts_obj({}), "meshes is empty; pass a dict of TexturedMesh"),
    "a list": (
        lambda: export.parts_obj([mesh()]),  # type: ignore[arg-type]
        "meshes must be Mapping, not list; pass a dict",
    ),
    "a map": (
        lambda: export.mesh_glb(bent()),  # type: ignore[arg-type]
        "mesh must be TexturedMesh, not HarmonicMap; make one with textured_mesh",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_the_refusal_names_the_argument_and_what_to_pass(case: str) -> None:
    make, message = BAD[case]
    with pytest.raises(InputError, match=message):
        make()


def test_motions_of_different_times_cannot_move_together() -> None:
    with pytest.raises(InputError, match="different times"):
        export.parts_motion_files("a.gif", [moving("a"), moving("b", (0, 2))])


def test_parts_may_come_from_an_iterator() -> None:
    parts = [LivePart(picture(), domain(), name=name) for name in "ab"]
    assert export.parts_live_html(iter(parts)) == export.parts_live_html(parts)  # type: ignore[arg-type]


def test_parts_without_a_name_are_numbered_and_two_of_one_name_are_refused() -> None:
    one, second = LivePart(picture(), bent()), LivePart(picture(), bent(), name="Part 3")
    data = unpacked(export.parts_live_html([one, second, one]))["data"]
    assert [part["name"] for part in data["parts"]] == ["Part 1", "Part 3", "Part 4"]
    with pytest.raises(InputError, match="two parts have the name 'Part 3'"):
        export.parts_live_html([second, second])
    with pytest.raises(InputError, match="two parts have the name 'a'"):
        export.parts_motion_glb([moving("a"), moving("a")])
