"""Warps from files: .npy and .npz, .nii and .nii.gz, .nrrd and .nhdr, .obj."""

import importlib
import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._errors import InputFileError, about
from glid_nb._files import path_of, read_file
from glid_nb.auditing.dispatch import audit
from glid_nb.auditing.field import Order
from glid_nb.auditing.result import Audit, AuditError

FIELDS = (".npy", ".npz", ".nii", ".nii.gz", ".nrrd", ".nhdr")
_DISPLACEMENTS, _VECTORS = 1006, 1007  # NIfTI's intents
_LPS, _RAS = "left-posterior-superior", "right-anterior-superior"


@dataclass(frozen=True, eq=False)
class Warp:
    """A warp as a file has it: a field with its spacing, or a mesh."""

    array: Array
    """(h, w, 2) displacements, or (v, 2) images of vertices."""
    spacing: tuple[float, float] = (1.0, 1.0)
    source: Array | None = None
    triangles: Array | None = None

    def audit(self, order: Order = "xy") -> Audit:
        if self.source is not None:
            return audit(self.array, source=self.source, triangles=self.triangles)
        return audit(self.array, order=order, spacing=self.spacing)


def read_warp(
    path: str | Path, source: str | Path | None = None, spacing: tuple[float, float] | None = None
) -> Warp:
    """Read a warp. Raises an InputFileError that says what is wrong with the file.

    An OBJ file has the images as vertices, and the source as texture coordinates, or as the
    vertices of another file with the same faces, ``source``. ``spacing`` are the steps (x, y)
    between the pixels of a field, in the unit of the displacements. By default the file says them.
    """
    path = path_of(path)
    name = path.name.lower()
    with about(path):
        if name.endswith(".obj"):
            if spacing is not None:
                raise AuditError("a spacing is for fields, not for meshes")
            return _read_mesh(path, None if source is None else path_of(source))
        if source is not None:
            raise AuditError("a source is for meshes (.obj), not for fields")
        if name.endswith((".npy", ".npz")):
            return Warp(_read_numpy(path), spacing or (1.0, 1.0))
        if name.endswith((".nii", ".nii.gz")):
            return _read_nifti(path, spacing)
        if name.endswith((".nrrd", ".nhdr")):
            return _read_nrrd(path, spacing)
        raise AuditError(f"its name must end in {', '.join(FIELDS)} or .obj")


def _read_numpy(path: Path) -> Array:
    data = read_file(path)
    try:
        loaded = np.load(io.BytesIO(data), allow_pickle=False)
        if isinstance(loaded, np.ndarray):
            return loaded
        names = loaded.files
        if len(names) != 1:
            listed = ", ".join(names[:9]) or "none"
            raise AuditError(f"it holds {len(names)} arrays ({listed}); save the field alone")
        return loaded[names[0]]
    except (ValueError, EOFError, OSError, KeyError, zipfile.BadZipFile) as error:
        if isinstance(error, AuditError):
            raise
        raise AuditError(f"it is not a file of one array of numbers: {error}") from None


def _needed(module: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError:
        advice = "pip install 'glid-nb[imaging]'"
        raise AuditError(f"reading it needs {module}; install it by {advice}") from None


def _read_nifti(path: Path, spacing: tuple[float, float] | None) -> Warp:
    nibabel = _needed("nibabel")
    read_file(path)  # its errors name the file
    try:
        image = nibabel.load(path)
        data, affine = np.asarray(image.dataobj), np.asarray(image.affine)
        intent = int(image.header["intent_code"])
    except Exception as error:  # nibabel raises errors of many kinds for damaged files
        raise AuditError(f"it is not a NIfTI file: {error}") from None
    # NIfTI's directions are right, anterior, superior. ITK writes vectors with the intent 1007,
    # and their components point to left and posterior.
    signs = {_DISPLACEMENTS: 1.0, _VECTORS: -1.0}
    steps = _axis_steps(affine[:2, :3].T, signs.get(intent, 0.0))
    return Warp(_transposed(data), spacing or _told(steps, known=intent in signs))


def _read_nrrd(path: Path, spacing: tuple[float, float] | None) -> Warp:
    nrrd = _needed("nrrd")
    read_file(path)
    try:
        data, header = nrrd.read(str(path))
    except Exception as error:  # pynrrd's own errors, and others for damaged files
        told = str(error) or type(error).__name__
        raise AuditError(f"it is not an NRRD file, or is damaged: {told}") from None
    directions = header.get("space directions")
    if directions is None:
        own = [step for step in np.ravel(header.get("spacings", ())) if np.isfinite(step)]
        steps = (float(own[0]), float(own[1])) if len(own) > 1 else (1.0, 1.0)
        known = False
    else:
        rows = np.array(
            [np.full(3, np.nan) if row is None else np.resize(row, 3) for row in directions],
            dtype=np.float64,
        )
        steps = _axis_steps(rows[np.isfinite(rows).all(axis=1)][:, :2], 1.0)
        known = header.get("space") in (_LPS, _RAS)
    first = next(iter(header.get("kinds") or [""]))
    inside = data.shape[0] in (2, 3) and data.shape[-1] not in (2, 3)
    if data.ndim > 2 and (inside or "vector" in first):
        data = np.moveaxis(data, 0, -1)
    return Warp(_transposed(data), spacing or _told(steps, known))


def _axis_steps(rows: Array, sign: float) -> tuple[float, float]:
    """The signed steps along x and y, from (2 or 3, 2) directions of the axes. ``sign`` 0 is for
    steps whose direction is not known."""
    if len(rows) < 2 or rows[0, 1] or rows[1, 0] or rows[2:3].any() or not rows[0, 0] * rows[1, 1]:
        text = "its pixel axes are not the axes of its displacements, which are oblique or swapped"
        raise AuditError(f"{text}; resample it, or give the displacements in pixels with a spacing")
    x, y = float(rows[0, 0]), float(rows[1, 1])
    return (x * sign, y * sign) if sign else (abs(x), abs(y))


def _told(steps: tuple[float, float], known: bool) -> tuple[float, float]:
    if known or steps == (1.0, 1.0):
        return steps
    x, y = steps
    text = f"its pixels are {x:g} x {y:g}, and the file does not say the displacements' unit; give"
    raise AuditError(f"{text} the spacing 1 1 for pixels, or {x:g} {y:g} for the unit of the file")


def _transposed(data: Array) -> Array:
    """(h, w, 2) of (x, y[, z = 1][, time = 1], 2) in the order of medical files."""
    shape = data.shape
    if data.dtype.names:
        raise AuditError("its values are records, not numbers")
    between = shape[2:-1]
    if len(shape) < 3 or shape[-1] not in (2, 3) or any(n != 1 for n in between):
        wanted = "a planar field has the shape (x, y, 2) or (x, y, 1, 1, 2)"
        raise AuditError(f"its shape is {shape}; {wanted}, so take a slice of it")
    data = data.reshape(*shape[:2], shape[-1])
    if shape[-1] == 3:
        if np.any(data[..., 2] != 0):
            raise AuditError("its displacements leave the plane: their third component is not 0")
        data = data[..., :2]
    return data.swapaxes(0, 1)


def _read_mesh(path: Path, source: Path | None) -> Warp:
    vertices, textures, faces, corners = _read_obj(path)
    if source is not None:
        with about(source):
            others, _, other_faces, _ = _read_obj(source)
        if len(others) != len(vertices) or not np.array_equal(faces, other_faces):
            sizes = f"{len(vertices)} vertices and {len(faces)} triangles"
            other = f"{len(others)} and {len(other_faces)}"
            raise AuditError(
                f"its faces are not those of {source}: it has {sizes}, against {other}"
            )
        return Warp(vertices, source=others, triangles=faces)
    if corners is None or not len(textures):
        text = "its faces have no texture coordinates (v/vt), which would be the source"
        raise AuditError(f"{text}; name a second OBJ file with the same faces as the source")
    # A vertex with two texture coordinates lies on a seam, and becomes two.
    pairs = np.stack([faces.ravel(), corners.ravel()], axis=1)
    used, which = np.unique(pairs, axis=0, return_inverse=True)
    triangles = which.reshape(-1, 3)
    return Warp(vertices[used[:, 0]], source=textures[used[:, 1]], triangles=triangles)


def _read_obj(path: Path) -> tuple[Array, Array, Array, Array | None]:
    """The vertices (v, 2), texture coordinates (u, 2), and the indices (t, 3) of both in faces."""
    try:
        text = read_file(path).decode("utf-8")
    except UnicodeDecodeError:
        raise InputFileError(f"{path} is not an OBJ file: it is not text") from None
    vertices: list[list[float]] = []
    textures: list[list[float]] = []
    faces: list[list[int]] = []
    corners: list[list[int]] = []
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        word, *rest = line.partition("#")[0].split() or [""]
        try:
            if word == "v":
                vertices.append([float(one) for one in rest[:3]])
            elif word == "vt":
                textures.append([float(one) for one in rest[:2]])
            elif word == "f":
                split = [one.split("/") for one in rest]
                faces.append([_index(one[0], len(vertices)) for one in split])
                both = [one[1] for one in split if len(one) > 1 and one[1]]
                if len(both) == len(split):
                    corners.append([_index(one, len(textures)) for one in both])
        except (ValueError, IndexError):
            raise AuditError(f"line {number} cannot be read: {line[:60]!r}") from None
        if word == "f" and len(rest) != 3:
            raise AuditError(f"line {number} has a face of {len(rest)} vertices; triangulate it")
    if not faces:
        raise AuditError("it has no faces")
    if any(len(one) != len(vertices[0]) or len(one) < 2 for one in vertices):
        raise AuditError("its vertices must have two or three coordinates each")
    if any(len(one) != 2 for one in textures):
        raise AuditError("its texture coordinates must be pairs")
    points = np.array(vertices)
    if points.shape[1] == 3 and np.ptp(points[:, 2]):
        raise AuditError("its vertices do not lie in a plane z = constant; only planar meshes are")
    both = np.array(corners) if len(corners) == len(faces) else None
    return points[:, :2], np.array(textures).reshape(-1, 2), np.array(faces), both


def _index(text: str, count: int) -> int:
    number = int(text)
    index = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= index < count:
        raise IndexError(text)
    return index
