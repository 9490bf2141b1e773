"""The deformed shape as a textured triangle mesh: Wavefront OBJ and binary glTF."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.imaging.mesh import deformed_mesh
from glid_nb.solvers import Pose

# trimesh takes a second to import, so only the functions that need it do.
if TYPE_CHECKING:
    from trimesh import Trimesh
    from trimesh.visual.material import Material

_RELIEF = 0.02  # world units from the lowest to the highest sheet of an overlapping shape


@dataclass(frozen=True, eq=False)
class TexturedMesh:
    """A deformed shape, ready for a program that draws triangles."""

    positions: NDArray[np.float64]
    """(v, 3) world units, y up. z rises by 0.02 from the lowest sheet to the highest, so that
    viewers with a depth buffer draw an overlapping shape in the right order."""
    texture_coordinates: NDArray[np.float64]
    """(v, 2) (u, v) in the picture, (0, 0) at its bottom left corner."""
    triangles: NDArray[np.int32]
    """(t, 3) counter-clockwise, the lower ones first."""
    texture: NDArray[np.uint8]


def textured_mesh(
    image: ArrayLike,
    map: HarmonicMap,
    n_vertices: int = 5000,
    tolerance: float | None = None,
    pose: Pose | None = None,
) -> TexturedMesh:
    """Triangulate a map's domain and give each vertex its image and its place in the picture.

    The image, (h, w), (h, w, 3) or (h, w, 4), is the one that the map's cage was traced from. There
    are about ``n_vertices`` evenly spread vertices, at least 3; edges that stray further from the
    map than a ``tolerance`` in world units are split. The depths of a pose say which part is in
    front where the shape overlaps itself. Raises a ValueError that names an argument out of range.
    """
    texture = as_rgba8(image)
    height, width = texture.shape[:2]
    mesh = deformed_mesh(map, n_vertices, tolerance, pose)
    u, v = (PixelFrame(width, height).to_pixel(mesh.vertices) / [width, height]).T
    # Their order, not the heights themselves: depths leave little room between the other parts.
    z = np.unique(mesh.heights, return_inverse=True)[1]
    positions = np.column_stack([mesh.images, _RELIEF * z / max(z.max(), 1)])
    return TexturedMesh(positions, np.column_stack([u, 1 - v]), mesh.triangles, texture)


def mesh_obj(mesh: TexturedMesh, name: str = "shape") -> dict[str, bytes]:
    """A mesh as Wavefront OBJ: ``name.obj``, ``name.mtl`` and ``name-texture.png``, by name.

    They must stay in one folder: the OBJ file refers to the material file, and that to the texture.
    """
    from trimesh.exchange.obj import export_obj  # noqa: PLC0415
    from trimesh.visual.material import SimpleMaterial  # noqa: PLC0415

    material = SimpleMaterial(
        image=Image.fromarray(mesh.texture),
        name=f"{name}-texture",  # trimesh names the texture's file after it
        diffuse=[255, 255, 255, 255],
        ambient=[255, 255, 255, 255],
        specular=[0, 0, 0, 255],
        glossiness=0.0,
    )
    text, files = export_obj(
        _trimesh(mesh, material),
        include_normals=False,
        include_texture=True,
        return_texture=True,
        mtl_name=f"{name}.mtl",
        header="glid_nb",
    )
    return {f"{name}.obj": text.encode("utf-8"), **files}


def mesh_glb(mesh: TexturedMesh) -> bytes:
    """A mesh as binary glTF 2.0 (.glb), with its texture."""
    from trimesh.visual.material import PBRMaterial  # noqa: PLC0415

    material = PBRMaterial(
        baseColorTexture=Image.fromarray(mesh.texture),
        metallicFactor=0.0,
        roughnessFactor=1.0,
        alphaMode="BLEND",
        doubleSided=True,
    )
    data = _trimesh(mesh, material).export(file_type="glb")
    assert isinstance(data, bytes)
    return data


def _trimesh(mesh: TexturedMesh, material: Material) -> Trimesh:
    from trimesh import Trimesh  # noqa: PLC0415
    from trimesh.visual import TextureVisuals  # noqa: PLC0415

    visual = TextureVisuals(uv=mesh.texture_coordinates, material=material)
    # Processing would merge vertices and reorder them.
    return Trimesh(mesh.positions, mesh.triangles, visual=visual, process=False)
