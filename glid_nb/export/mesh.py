"""The deformed shape as a textured triangle mesh: Wavefront OBJ and binary glTF."""

import functools
import io
import itertools
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.export.formats import obj_names, object_names
from glid_nb.export.moving import MovingMesh, MovingPart, check_picture, moving_parts
from glid_nb.export.parts import checked_meshes
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8, png
from glid_nb.imaging.bleed import bled
from glid_nb.imaging.order import Order
from glid_nb.imaging.progress import Progress, report
from glid_nb.motion import Motion
from glid_nb.pose import Pose

# Importing trimesh takes a second, so only the functions that need it import it.
if TYPE_CHECKING:
    from trimesh import Trimesh
    from trimesh.visual.material import Material

_RELIEF = 0.02  # world units from the lowest to the highest sheet of an overlapping shape


@dataclass(frozen=True, eq=False)
class TexturedMesh:
    """A deformed shape, ready for a program that draws triangles."""

    positions: NDArray[np.float64]
    """(v, 3) in world units, y up. z rises by 0.02 from the lowest sheet to the highest, so that
    viewers with a depth buffer draw an overlapping shape in the right order."""
    texture_coordinates: NDArray[np.float64]
    """(v, 2) (u, v) in the picture, (0, 0) at its bottom left corner."""
    triangles: NDArray[np.int32]  # (t, 3) counter-clockwise, the lower ones first
    texture: NDArray[np.uint8]


def textured_mesh(
    image: ArrayLike,
    map: HarmonicMap,
    n_vertices: int = 5000,
    tolerance: float | None = None,
    pose: Pose | None = None,
) -> TexturedMesh:
    """Triangulate a map's domain and give each vertex its image and its place in the picture.

    The image is the one from which the map's cage was traced. There are about ``n_vertices`` evenly
    spread vertices, at least 3. Edges that deviate from the map by more than ``tolerance``, in
    world units, are split. Where the shape overlaps itself, the depths of a pose decide which part
    is in front. Raises a ValueError that names an argument out of range.
    """
    image = as_rgba8(image)
    check_type("map", map, HarmonicMap, "for example result.map", InputError)
    check_picture((image.shape[1], image.shape[0]), map)
    return _at_knots(image, MovingMesh.of(map, pose, n_vertices, tolerance))[0]


def _at_knots(image: ArrayLike, mesh: MovingMesh) -> tuple[TexturedMesh, Array]:
    """The mesh at the first knot, and its positions (n, v, 3) at all knots."""
    # Use ranks as heights, because depths leave little room between the heights of other parts.
    ranks = np.array([np.unique(row, return_inverse=True)[1] for row in mesh.heights])
    relief = replace(mesh, heights=_RELIEF * ranks / np.maximum(ranks.max(axis=1), 1)[:, None])
    z = np.array([relief.heights_at(time) for time in mesh.times])
    positions = np.concatenate([mesh.images, z[:, :, None]], axis=2)
    texture = bled(as_rgba8(image))
    size = texture.shape[1::-1]
    u, v = (PixelFrame(*size).to_pixel(mesh.vertices) / size).T
    places = np.column_stack([u, 1 - v])
    return TexturedMesh(positions[0], places, mesh.triangles, texture), positions


def mesh_obj(mesh: TexturedMesh, name: str = "shape") -> dict[str, bytes]:
    """A mesh as Wavefront OBJ: ``name.obj``, ``name.mtl`` and ``name-texture.png``, by name.

    The files must stay in one folder. The OBJ file refers to the material file, and the material
    file refers to the texture.
    """
    check_type("mesh", mesh, TexturedMesh, "make one with textured_mesh", InputError)
    from trimesh.exchange.obj import export_obj  # noqa: PLC0415
    from trimesh.visual.material import SimpleMaterial  # noqa: PLC0415

    white, black = [255] * 4, [0, 0, 0, 255]
    look: Any = {"diffuse": white, "ambient": white, "specular": black, "glossiness": 0.0}
    # trimesh names the texture's file after the material.
    material = SimpleMaterial(Image.fromarray(mesh.texture), name=f"{name}-texture", **look)
    parts: Any = {"include_normals": False, "include_texture": True, "return_texture": True}
    names: Any = {"mtl_name": f"{name}.mtl", "header": "glid_nb"}
    text, files = export_obj(_trimesh(mesh, material), **parts, **names)
    texture = {f"{name}-texture.png": png(mesh.texture)}
    return {f"{name}.obj": text.encode("utf-8"), **files, **texture}


def parts_obj(meshes: Mapping[str, TexturedMesh], name: str = "shape") -> dict[str, bytes]:
    """Several meshes as one Wavefront OBJ, with an object and a material for each by its name, in
    which "_" stands for spaces and other signs that programs may not read.

    The files, by name, are ``name.obj``, ``name.mtl`` and a texture for each part
    (`formats.obj_names`). The first mesh is the rearmost; each lies a little in front of the one
    before, as in `parts_glb`. The files must stay in one folder.
    """
    meshes = checked_meshes(meshes, TexturedMesh)
    textures = obj_names(f"{name}.obj", list(meshes))[2:]
    materials = [texture.removesuffix("-texture.png") for texture in textures]
    lines, first = ["# glid_nb", f"mtllib {name}.mtl"], 1
    objects = object_names(list(meshes))
    for part, mesh, material in zip(objects, _stacked(meshes).values(), materials, strict=True):
        lines += [f"o {part}", f"usemtl {material}"]
        lines += [f"v {x:.8f} {y:.8f} {z:.8f}" for x, y, z in mesh.positions.tolist()]
        lines += [f"vt {u:.8f} {v:.8f}" for u, v in mesh.texture_coordinates.tolist()]
        corners = (mesh.triangles + first).tolist()
        lines += [f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in corners]
        first += len(mesh.positions)
    look = "Ka 1 1 1\nKd 1 1 1\nKs 0 0 0\nNs 0"
    pairs = zip(materials, textures, strict=True)
    library = [f"newmtl {material}\n{look}\nmap_Kd {file}\n" for material, file in pairs]
    texts = {f"{name}.obj": "\n".join(lines) + "\n", f"{name}.mtl": "\n".join(library)}
    pictures = (png(mesh.texture) for mesh in meshes.values())
    return {
        **{file: text.encode("utf-8") for file, text in texts.items()},
        **dict(zip(textures, pictures, strict=True)),
    }


def _stacked(meshes: Mapping[str, TexturedMesh]) -> dict[str, TexturedMesh]:
    """The meshes, each a little in front of the one before, as sheets of one shape are."""
    return {
        name: replace(mesh, positions=mesh.positions + np.array([0, 0, 2 * _RELIEF * number]))
        for number, (name, mesh) in enumerate(meshes.items())
    }


def mesh_glb(mesh: TexturedMesh, edit: Callable[..., None] | None = None) -> bytes:
    """A mesh as binary glTF 2.0 (.glb), with its texture. ``edit(buffers, tree)`` may change it."""
    check_type("mesh", mesh, TexturedMesh, "make one with textured_mesh", InputError)
    from trimesh.visual.material import PBRMaterial  # noqa: PLC0415

    matt: Any = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    look: Any = {**matt, "alphaMode": "BLEND", "doubleSided": True}
    material = PBRMaterial(baseColorTexture=Image.fromarray(mesh.texture), **look)
    finish = functools.partial(_finish, mesh.texture, edit)
    data = _trimesh(mesh, material).export(file_type="glb", buffer_postprocessor=finish)
    assert isinstance(data, bytes)
    return data


def parts_glb(meshes: Mapping[str, TexturedMesh], edit: Callable[..., None] | None = None) -> bytes:
    """Several meshes as binary glTF 2.0, with a node for each by its name.

    The first is the rearmost. Each lies a little in front of the one before, as sheets of one shape
    do. ``edit(buffers, tree)`` may change the file.
    """
    meshes = checked_meshes(meshes, TexturedMesh)
    from trimesh import Scene  # noqa: PLC0415
    from trimesh.visual.material import PBRMaterial  # noqa: PLC0415

    scene = Scene(base_frame=_frame_beside(meshes))
    matt: Any = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    look: Any = {**matt, "alphaMode": "BLEND", "doubleSided": True}
    for name, mesh in _stacked(meshes).items():
        material = PBRMaterial(name, baseColorTexture=Image.fromarray(mesh.texture), **look)
        scene.add_geometry(_trimesh(mesh, material), node_name=name, geom_name=name)
    data = scene.export(file_type="glb", buffer_postprocessor=functools.partial(_finish_all, edit))
    assert isinstance(data, bytes)
    return data


def _frame_beside(names: Collection[str]) -> str:
    """A name for the node that holds all others. A part with it would become their parent."""
    tries = itertools.chain(["world"], (f"world {n}" for n in itertools.count(2)))
    return next(name for name in tries if name not in names)


def _finish_all(edit: Callable[..., None] | None, buffers: Any, tree: Any) -> None:
    """Like `_finish`, for all textures of a glTF."""
    for image in tree["images"]:
        name = list(buffers)[image["bufferView"]]
        with Image.open(io.BytesIO(buffers[name])) as picture:
            data = png(np.asarray(picture.convert("RGBA")))
        buffers[name] = data + bytes(-len(data) % 4)
    _clamp(tree)
    if edit is not None:
        edit(buffers, tree)


def _finish(texture: Array, edit: Callable[..., None] | None, buffers: Any, tree: Any) -> None:
    """Mark glTF's only texture as sRGB, and clamp it at its sides. By default it would repeat."""
    name = list(buffers)[tree["images"][0]["bufferView"]]
    data = png(texture)
    buffers[name] = data + bytes(-len(data) % 4)
    _clamp(tree)
    if edit is not None:
        edit(buffers, tree)


def _clamp(tree: Any) -> None:
    linear, mipmaps, clamped = 9729, 9987, 33071
    tree["samplers"] = [
        {"magFilter": linear, "minFilter": mipmaps, "wrapS": clamped, "wrapT": clamped}
    ]
    for one in tree["textures"]:
        one["sampler"] = 0


def motion_glb(
    image: ArrayLike,
    motion: Motion,
    poses: Sequence[Pose | Order] | None = None,
    n_vertices: int = 3000,
    tolerance: float | None = 0.02,
    progress: Progress | None = None,
) -> bytes:
    """A motion as binary glTF 2.0: a mesh with morph targets and an animation of their weights.

    There is a morph target for every map at which the motion bends, with a key at its time. Between
    the keys vertices move on straight lines, exactly as in the motion. Programs must support that
    many targets. Arguments are as in `textured_mesh`, with one pose per keyframe. The tolerance
    holds at all times.
    """
    report(progress, 0, 2)
    first, track = _track(MovingPart(image, motion, poses), n_vertices, tolerance)
    report(progress, 1, 2)
    data = mesh_glb(first, functools.partial(_animate, [track]))
    report(progress, 2, 2)
    return data


def parts_motion_glb(
    parts: Sequence[MovingPart],
    n_vertices: int = 3000,
    tolerance: float | None = 0.02,
    progress: Progress | None = None,
) -> bytes:
    """Like `motion_glb` for several shapes, the rearmost first: a node for each by its name, and
    one animation that moves all of them.

    The motions have the same times. The names differ; a part without one gets its number.
    """
    parts = moving_parts(parts)
    count = len(parts) + 1
    report(progress, 0, count)
    meshes, tracks = {}, []
    for done, part in enumerate(parts, 1):
        meshes[part.name], track = _track(part, n_vertices, tolerance)
        tracks.append(track)
        report(progress, done, count)
    data = parts_glb(meshes, functools.partial(_animate, tracks))
    report(progress, count, count)
    return data


class _Track(NamedTuple):
    """How the vertices of a mesh move in a glTF file."""

    moved: Array  # (m, v, 3) morph targets
    times: NDArray[np.float32]  # (k,) seconds
    weights: Array  # (k, m) of the targets at these times


def _track(
    part: MovingPart, n_vertices: int, tolerance: float | None
) -> tuple[TexturedMesh, _Track]:
    """The mesh at the motion's start, and how it moves from there."""
    image, motion = as_rgba8(part.image), part.motion
    check_type("motion", motion, Motion, "make one of certified maps", InputError)
    check_picture((image.shape[1], image.shape[0]), motion)
    mesh = MovingMesh.of(motion, part.poses, n_vertices, tolerance)
    first, positions = _at_knots(image, mesh)
    # A loop ends with its first map.
    n = len(positions) - (motion.repeat == "loop")
    weights = np.eye(n)[np.arange(len(positions)) % n]
    times = mesh.times - mesh.times[0]
    if motion.repeat == "ping-pong":
        times = np.concatenate([times, 2 * times[-1] - times[-2::-1]])
        weights = np.concatenate([weights, weights[-2::-1]])
    times = times.astype(np.float32)  # the file's precision
    last = np.append(np.diff(times) > 0, True)  # of times that are equal in single precision
    return first, _Track(positions[1:n] - positions[0], times[last], weights[last, 1:])


def _animate(tracks: Sequence[_Track], buffers: Any, tree: Any) -> None:
    """Add morph targets to glTF's meshes, and one animation of their weights."""

    def accessor(values: Array, kind: str) -> int:
        rows = values.astype("<f4").reshape(-1, 3 if kind == "VEC3" else 1)
        tree["accessors"][name := f"motion {len(buffers)}"] = {
            **{"bufferView": len(buffers), "componentType": 5126, "count": len(rows)},
            **{"type": kind, "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()},
        }
        buffers[name] = rows.tobytes()
        return len(tree["accessors"]) - 1

    samplers, channels = [], []
    for i, (mesh, track) in enumerate(zip(tree["meshes"], tracks, strict=True)):
        mesh["primitives"][0]["targets"] = [{"POSITION": accessor(m, "VEC3")} for m in track.moved]
        mesh["weights"] = [0.0] * len(track.moved)
        ends = {"input": accessor(track.times, "SCALAR")}
        ends["output"] = accessor(track.weights, "SCALAR")
        samplers.append({**ends, "interpolation": "LINEAR"})
        node = next(n for n, node in enumerate(tree["nodes"]) if node.get("mesh") == i)
        channels.append({"sampler": i, "target": {"node": node, "path": "weights"}})
    tree["animations"] = [{"name": "motion", "samplers": samplers, "channels": channels}]


def _trimesh(mesh: TexturedMesh, material: "Material") -> "Trimesh":
    from trimesh import Trimesh  # noqa: PLC0415
    from trimesh.visual import TextureVisuals  # noqa: PLC0415

    visual = TextureVisuals(uv=mesh.texture_coordinates, material=material)
    # Processing would merge and reorder vertices.
    return Trimesh(mesh.positions, mesh.triangles, visual=visual, process=False)
