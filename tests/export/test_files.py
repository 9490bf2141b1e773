"""Pictures, meshes and drawings, read back by programs that did not write them."""

from __future__ import annotations

import base64
import io
import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals

from glid_nb._errors import InputError
from glid_nb.certificate import certify
from glid_nb.export import (
    animation_bytes,
    cage_svg,
    mesh_glb,
    mesh_obj,
    motion_glb,
    page_html,
    picture_png,
    textured_mesh,
)
from glid_nb.geometry import GeometryError
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.bleed import bled
from glid_nb.imaging.mesh import deformed_loops
from glid_nb.imaging.render import render
from glid_nb.motion import Motion

from ..support.shapes import SIZE, bent, domain, picture, pose

pytestmark = pytest.mark.slow  # most of the time is compiling

SVG = "{http://www.w3.org/2000/svg}"


def test_the_map_of_these_tests_is_one() -> None:
    assert certify(bent()).certified


class TestPicture:
    @pytest.mark.parametrize("size", [None, (64, 40), (500, 500)])
    @pytest.mark.parametrize("view", ["source", "fit"])
    def test_the_file_holds_the_rendering(self, size: tuple[int, int] | None, view: str) -> None:
        with Image.open(io.BytesIO(picture_png(picture(), bent(), size, view=view))) as read:
            assert read.format == "PNG"
            assert read.mode == "RGBA"
            assert read.size == (size or SIZE)
            pixels = np.asarray(read)
        np.testing.assert_array_equal(pixels, render(picture(), bent(), size, view=view))
        assert pixels[..., 3].max() == 255
        assert pixels[0, 0, 3] == 0

    def test_a_wrong_size_is_refused(self) -> None:
        with pytest.raises(ValueError, match="size"):
            picture_png(picture(), bent(), (0, 10))


def sampled(image: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Nearest pixels of a picture at texture coordinates from its bottom left corner."""
    height, width = image.shape[:2]
    columns = np.clip((uv[:, 0] * width).astype(int), 0, width - 1)
    rows = np.clip(((1 - uv[:, 1]) * height).astype(int), 0, height - 1)
    return image[rows, columns]


def uv_of(mesh: trimesh.Trimesh) -> np.ndarray:
    visual = mesh.visual
    assert isinstance(visual, TextureVisuals)
    assert visual.uv is not None
    return np.asarray(visual.uv)


def material_of(mesh: trimesh.Trimesh) -> Any:
    visual = mesh.visual
    assert isinstance(visual, TextureVisuals)
    return visual.material


class TestMesh:
    def check(self, read: trimesh.Trimesh, tolerance: float) -> None:
        """Positions are the images of the vertices that the texture coordinates name."""
        made = textured_mesh(picture(), bent(), 800)
        assert read.faces.shape == made.triangles.shape
        np.testing.assert_allclose(read.vertices, made.positions, atol=tolerance)
        np.testing.assert_array_equal(read.faces, made.triangles)
        uv = uv_of(read)
        pixels = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=-1) * SIZE
        world = PixelFrame(*SIZE).to_world(pixels)
        assert domain().cage.contains(world, tolerance=1e-4).all()
        np.testing.assert_allclose(bent()(world), read.vertices[:, :2], atol=2e-4)
        # The area of the shape without its holes is that of its boundary's image.
        exterior, *holes = deformed_loops(bent())
        area = shapely.Polygon(exterior, holes).area
        corners = read.vertices[read.faces][..., :2]
        e = corners[:, 1:] - corners[:, :1]
        areas = (e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]) / 2
        assert (areas > 0).all()
        assert areas.sum() == pytest.approx(area, rel=0.01)

    def test_obj(self, tmp_path: Path) -> None:
        files = mesh_obj(textured_mesh(picture(), bent(), 800), "frog")
        assert sorted(files) == ["frog-texture.png", "frog.mtl", "frog.obj"]
        for name, data in files.items():
            (tmp_path / name).write_bytes(data)
        assert b"mtllib frog.mtl" in files["frog.obj"]
        assert b"map_Kd frog-texture.png" in files["frog.mtl"]
        read = trimesh.load(tmp_path / "frog.obj", process=False, maintain_order=True)
        assert isinstance(read, trimesh.Trimesh)
        self.check(read, 1e-7)
        texture = np.asarray(material_of(read).image.convert("RGBA"))
        np.testing.assert_array_equal(texture, bled(picture()))
        with Image.open(tmp_path / "frog-texture.png") as stored:
            assert stored.info["srgb"] == 0

    def test_a_viewer_with_straight_alpha_sees_no_fringe(self) -> None:
        """A black disc on transparent white, exported, and interpolated between two texels."""
        y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
        alpha = 255 * np.clip(80 - np.hypot(x - 150, y - 100), 0, 1)
        disc = np.dstack([np.where(alpha > 0, 0, 255)] * 3 + [alpha]).astype(np.uint8)
        made = textured_mesh(disc, bent(), 800)
        moving = motion_glb(disc, Motion([HarmonicMap.identity(domain()), bent()]), None, 300)
        page = page_html(disc, bent())
        inside = re.search(r"data:image/png;base64,([A-Za-z0-9+/=]+)", page)
        assert inside
        shown = [
            *mesh_obj(made, "a").values(),
            mesh_glb(made),
            moving,
            base64.b64decode(inside[1]),
        ]
        textures = [data[data.index(b"\x89PNG") :] for data in shown if b"\x89PNG" in data]
        assert len(textures) == 4
        for data in textures:
            texture = np.asarray(Image.open(io.BytesIO(data))).astype(float)
            np.testing.assert_array_equal(texture[..., 3], disc[..., 3])
            for between in (texture[1:] + texture[:-1], texture[:, 1:] + texture[:, :-1]):
                assert not between[..., :3][between[..., 3] > 0].any()

    def test_the_texture_is_not_repeated(self) -> None:
        data = mesh_glb(textured_mesh(picture(), bent(), 300))
        length = int.from_bytes(data[12:16], "little")
        tree = json.loads(data[20 : 20 + length])
        sampler = tree["samplers"][tree["textures"][0]["sampler"]]
        assert (sampler["wrapS"], sampler["wrapT"]) == (33071, 33071)

    def test_a_picture_of_other_proportions_is_refused_by_every_export(self) -> None:
        wide = np.zeros((50, 300, 4), np.uint8)
        moving = Motion([HarmonicMap.identity(domain()), bent()])
        for export in (
            lambda: textured_mesh(wide, bent()),
            lambda: page_html(wide, bent()),
            lambda: page_html(wide, moving),
            lambda: motion_glb(wide, moving),
            lambda: picture_png(wide, bent()),
            lambda: animation_bytes(wide, [bent()]),
            lambda: cage_svg(bent(), (300, 50)),
        ):
            with pytest.raises(InputError, match="take the picture that the cage was traced from"):
                export()

    def test_glb(self) -> None:
        data = mesh_glb(textured_mesh(picture(), bent(), 800))
        assert data[:4] == b"glTF"
        scene = trimesh.load(io.BytesIO(data), file_type="glb", process=False)
        (read,) = scene.geometry.values()
        self.check(read, 1e-5)
        material = material_of(read)
        texture = np.asarray(material.baseColorTexture.convert("RGBA"))
        np.testing.assert_array_equal(texture, bled(picture()))
        assert material.baseColorTexture.info["srgb"] == 0
        assert material.alphaMode == "BLEND"
        assert material.doubleSided
        colors = sampled(picture(), uv_of(read))
        left_top = (read.vertices[:, 0] < -5) & (colors[:, 3] == 255)
        assert left_top.any()

    def test_the_identity_shows_the_picture_where_it_was(self) -> None:
        mesh = textured_mesh(picture(), HarmonicMap.identity(domain()), 300)
        expected = PixelFrame(*SIZE).to_pixel(mesh.positions[:, :2]) / SIZE
        np.testing.assert_allclose(mesh.texture_coordinates[:, 0], expected[:, 0], atol=1e-9)
        np.testing.assert_allclose(mesh.texture_coordinates[:, 1], 1 - expected[:, 1], atol=1e-9)

    def test_what_covers_lies_higher(self) -> None:
        mesh = textured_mesh(picture(), bent(), 800)
        z = mesh.positions[mesh.triangles][..., 2].mean(axis=1)
        assert z[0] < z[-1]
        assert mesh.positions[:, 2].min() == 0
        assert mesh.positions[:, 2].max() == pytest.approx(0.02)

    def test_too_few_vertices_are_refused(self) -> None:
        with pytest.raises(GeometryError, match="at least 3"):
            textured_mesh(picture(), bent(), 2)


def subpaths(element: ElementTree.Element) -> list[np.ndarray]:
    loops = element.attrib["d"].split("M")[1:]
    return [
        np.array([[float(v) for v in p.split(",")] for p in loop.strip().strip("Z").split()])
        for loop in loops
    ]


class TestSvg:
    def parse(self, text: str) -> dict[str, ElementTree.Element]:
        root = ElementTree.fromstring(text)
        assert root.tag == f"{SVG}svg"
        return {e.attrib["id"]: e for e in root.iter() if "id" in e.attrib}

    def test_the_curves_are_the_images_of_the_cage(self) -> None:
        parts = self.parse(cage_svg(bent(), SIZE))
        assert list(parts) == ["cage"]
        exterior, hole = subpaths(parts["cage"])
        frame = PixelFrame(*SIZE)
        t = np.linspace(0, 1, 400, endpoint=False)[:, None]
        for drawn, loop in ((exterior, domain().cage.exterior), (hole, domain().cage.holes[0])):
            ring = shapely.LinearRing(drawn)
            following = np.roll(loop, -1, axis=0)
            dense = (loop[:, None] * (1 - t) + following[:, None] * t).reshape(-1, 2)
            images = frame.to_pixel(bent()(dense))
            gap = shapely.distance(ring, shapely.points(images)).max()
            assert gap * frame.units_per_pixel < 0.004
            # and the drawn points include the cage's vertices
            corners = frame.to_pixel(bent()(loop))
            near = np.abs(drawn[:, None] - corners[None]).max(axis=2).min(axis=0)
            assert near.max() < 1e-3

    def test_straight_edges_need_few_points(self) -> None:
        identity = HarmonicMap.identity(domain())
        exterior, hole = subpaths(self.parse(cage_svg(identity, SIZE))["cage"])
        assert (len(exterior), len(hole)) == (4 * 28, 4 * 14)

    def test_everything_is_in_view(self) -> None:
        text = cage_svg(bent(), SIZE, source=True, pose=pose())
        root = ElementTree.fromstring(text)
        x, y, w, h = map(float, root.attrib["viewBox"].split())
        parts = self.parse(text)
        assert set(parts) == {"cage", "source-cage", "targets", "handles"}
        for name in ("cage", "source-cage"):
            for loop in subpaths(parts[name]):
                assert (loop > [x, y]).all()
                assert (loop < [x + w, y + h]).all()
        source = subpaths(parts["source-cage"])
        np.testing.assert_allclose(
            source[0], PixelFrame(*SIZE).to_pixel(domain().cage.exterior), atol=1e-3
        )
        assert len(parts["targets"]) == len(parts["handles"]) == 2
        circle = parts["handles"][0].attrib
        expected = PixelFrame(*SIZE).to_pixel(bent()(pose().handles))[0]
        np.testing.assert_allclose([float(circle["cx"]), float(circle["cy"])], expected, atol=1e-3)
