"""The live page is one small file that uses no network."""

from __future__ import annotations

import json
import re
import zlib
from typing import Any

import numpy as np
import pytest

from glid_nb import Cage, Domain, HarmonicMap, InputError, Motion, Pose, samples, trace
from glid_nb.energies import AMIPS, CustomEnergy
from glid_nb.export import LivePart, live_page_html, parts_live_html

from ..support.shapes import bent, domain, picture, pose

MOST = 60_000  # bytes beside the picture
MOST_OF_SECOND = 10_000  # bytes that the second shape of a page adds, with the code for several
MOST_OF_FURTHER = 6_000  # bytes that each further one adds, beside its picture


def unpacked(page: str) -> dict[str, Any]:
    """What the page's first script unpacks: 13 bits in two of 91 letters."""
    found = re.search(r'id="packed" data-size="(\d+)">([^<]*)</script>', page)
    assert found is not None
    letters = [chr(code) for code in range(33, 127) if chr(code) not in "&<\\"]
    digits = np.array([letters.index(letter) for letter in found[2]]).reshape(-1, 2)
    bits = (digits @ np.array([91, 1]))[:, None] >> np.arange(13) & 1
    data = np.packbits(bits.astype(np.uint8).ravel(), bitorder="little")[: int(found[1])]
    text = zlib.decompress(data.tobytes()).decode().split("\0")
    parts = dict(zip(("data", "worker", "page", "style"), text, strict=True))
    return {**parts, "data": json.loads(parts["data"])}


def picture_of(page: str) -> str:
    found = re.search(r'src="(data:image/png;base64,[^"]+)"', page)
    assert found is not None
    return found[1]


def test_the_page_holds_everything_and_may_not_use_the_network() -> None:
    page = live_page_html(picture(), domain(), pose(), title="Ring")
    assert "default-src 'none'" in page
    assert not re.search(r"""(src|href)\s*=\s*["'](?!data:)""", page)
    assert not re.search(r"\{\{\w+\}\}", page)
    parts = unpacked(page)
    assert set(parts) == {"style", "page", "worker", "data"}
    for code in ("style", "page", "worker"):
        assert not re.search(r"https?://|@import|fetch\(|XMLHttpRequest", parts[code])


@pytest.mark.slow
def test_a_page_of_the_gecko_is_at_most_60_kb_beside_its_picture() -> None:
    image = samples.image("gecko")
    page = live_page_html(image, Domain.from_cage(trace(image).cage), title="gecko")
    assert len(page.encode()) - len(picture_of(page)) <= MOST


def test_the_page_has_the_shape_rounded_to_a_millionth() -> None:
    data = unpacked(live_page_html(picture(), domain(), pose()))["data"]
    again = Domain.from_dict(data["outline"])  # which checks that it is one
    np.testing.assert_allclose(again.cage.exterior, domain().cage.exterior, atol=2e-5)
    np.testing.assert_allclose(again.offset_cage.holes[0], domain().offset_cage.holes[0], atol=2e-5)
    assert data["start"] == []
    assert [pin["target"] for pin in data["poses"][0]] == pose().targets.tolist()


def test_cages_very_close_to_each_other_keep_all_digits() -> None:
    cage = Cage([[-9, -6], [9, -6 + 1 / 3], [9, 6], [-9, 6]])
    close = Domain.from_cage(cage, 1e-3)
    data = unpacked(live_page_html(picture(), close))["data"]
    assert data["outline"]["offset_cage"] == close.offset_cage.exterior.tolist()


def test_the_page_begins_at_the_map_with_its_pose_and_energy() -> None:
    turned = Pose([[-5, 0], [5, 0]], [[-5, 0], [5, 1]], angles=[0.5, None], names=["a", ""])
    page = live_page_html(picture(), bent(), turned, AMIPS(0.5), 2e4, "<b>")
    assert "<title>&lt;b&gt;</title>" in page
    data = unpacked(page)["data"]
    parts = np.array(data["start"]).reshape(4, -1)
    np.testing.assert_array_equal(parts[0] + 1j * parts[1], bent().phi)
    np.testing.assert_array_equal(parts[2] + 1j * parts[3], bent().psi)
    options = data["options"]
    assert (options["energy"], options["s"], options["weight"]) == ("amips", 0.5, 2e4)
    first, second = data["poses"][0]
    assert (first["angle"], first["name"], second["angle"]) == (0.5, "a", None)


def test_what_a_page_cannot_do_is_refused() -> None:
    own = CustomEnergy(lambda x, y: (x - 1) ** 2 + y)
    with pytest.raises(InputError, match="has no energy"):
        live_page_html(picture(), domain(), energy=own)
    with pytest.raises(InputError, match="1 keyframes but 2 poses"):
        live_page_html(picture(), domain(), [pose(), pose()])
    with pytest.raises(InputError):
        live_page_html(np.zeros((50, 300, 4), np.uint8), bent())


@pytest.mark.slow
def test_a_motion_comes_with_its_knots_and_its_poses() -> None:
    motion = Motion([HarmonicMap.identity(domain()), bent()])
    page = live_page_html(picture(), motion, [pose(), pose()])
    data = unpacked(page)["data"]
    assert data["motion"]["keyframes"] == [0, 1]
    assert len(data["motion"]["times"]) == len(motion.pieces) + 1
    assert len(data["poses"]) == 2
    assert data["motion"]["width"] == 4 * domain().n_coefficients
    assert len(page.encode()) - len(picture_of(page)) <= MOST


def beside_pictures(page: str) -> int:
    return len(re.sub(r'src="data:image/png;base64,[^"]+"', "", page).encode())


def parts_of(motion: bool = False, count: int = 2) -> list[LivePart]:
    shown = Motion([HarmonicMap.identity(domain()), bent()]) if motion else bent()
    poses = [pose(), pose()] if motion else pose()
    return [LivePart(picture(), shown, poses, name=f"part {i}") for i in range(count)]


def test_a_page_of_several_shapes_has_the_outline_the_pins_and_the_picture_of_each() -> None:
    page = parts_live_html(parts_of(), "Two", background=(1, 2, 3))
    assert len(re.findall(r'<img id="source\d" alt="" hidden src="data:image/png', page)) == 2
    assert "rgb(1 2 3)" in page
    data = unpacked(page)["data"]
    assert [part["name"] for part in data["parts"]] == ["part 0", "part 1"]
    for part in data["parts"]:
        cage = Domain.from_dict(part["outline"]).cage
        np.testing.assert_allclose(cage.exterior, domain().cage.exterior, atol=2e-5)
        assert [pin["target"] for pin in part["poses"][0]] == pose().targets.tolist()
        assert len(part["start"]) == 4 * domain().n_coefficients


def test_a_page_of_one_part_is_the_page_of_a_shape() -> None:
    (one,) = parts_of(count=1)
    assert parts_live_html([one], "A") == live_page_html(picture(), bent(), pose(), title="A")


@pytest.mark.slow
def test_the_second_part_adds_at_most_10_kb_and_each_further_one_6_kb() -> None:
    """Parts of different outlines: equal ones would be packed into nothing."""
    gecko = samples.image("gecko")
    images = [gecko, gecko[:, ::-1], gecko[::-1]]
    shapes = [Domain.from_cage(trace(image).cage) for image in images]
    parts = [LivePart(image, shape) for image, shape in zip(images, shapes, strict=True)]
    sizes = [beside_pictures(parts_live_html(parts[:count])) for count in (1, 2, 3)]
    second, third = np.diff(sizes)
    assert 1000 < second <= MOST_OF_SECOND
    assert 1000 < third <= MOST_OF_FURTHER


@pytest.mark.slow
def test_the_motions_of_all_parts_are_in_the_page() -> None:
    data = unpacked(parts_live_html(parts_of(motion=True)))["data"]
    assert [part["motion"]["keyframes"] for part in data["parts"]] == [[0, 1], [0, 1]]
    assert [len(part["poses"]) for part in data["parts"]] == [2, 2]


def test_parts_that_do_not_fit_together_are_refused() -> None:
    (one,) = parts_of(count=1)
    _, moving = parts_of(motion=True)
    with pytest.raises(InputError, match="different times"):
        parts_live_html([one, moving])
    with pytest.raises(InputError, match="different sizes"):
        parts_live_html([one, LivePart(np.zeros((50, 300, 4), np.uint8), bent())])
    with pytest.raises(InputError, match="no parts"):
        parts_live_html([])
