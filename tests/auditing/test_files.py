"""Warps from files."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glid_nb as glid
from glid_nb.auditing import read_warp

SQUARE = "v 0 0 3\nv 2 0 3\nv 2 1 3\nv 0 1 3\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
FACES = "f 1/1 2/2/1 3/3\nf -4/-4 -2/-2 -1/-1  # the last\n"


def field() -> Any:
    return 0.6 * np.random.default_rng(1).normal(size=(5, 7, 2))


def obj(folder: Path, text: str, name: str = "mesh.obj") -> Path:
    path = folder / name
    path.write_text(text)
    return path


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int16])
def test_numpys_files(tmp_path: Path, kind: Any) -> None:
    values = (3 * field()).astype(kind)
    np.save(tmp_path / "a.npy", values)
    np.savez(tmp_path / "b.npz", values)
    for name in ("a.npy", "b.npz"):
        warp = read_warp(tmp_path / name)
        assert warp.array.dtype == kind
        assert warp.audit().message == glid.audit(values).message
        assert warp.audit("yx").message == glid.audit(values, order="yx").message


def test_an_obj_with_texture_coordinates(tmp_path: Path) -> None:
    audit = read_warp(obj(tmp_path, SQUARE + FACES)).audit()
    assert (audit.verdict, audit.smallest, audit.pieces) == ("proved", 2.0, 2)


def test_a_seam_divides_a_vertex(tmp_path: Path) -> None:
    text = SQUARE + "vt 5 5\nvt 6 6\nvt 5 6\nf 1/1 2/2 3/3\nf 1/5 3/6 4/7\n"
    warp = read_warp(obj(tmp_path, text))
    assert len(warp.array) == 6
    assert warp.audit().proved


def test_two_obj_files(tmp_path: Path) -> None:
    rest = "v 0 0\nv 1 0\nv 1 1\nv 0 1\nf 1 2 3\nf 1 3 4\n"
    source = obj(tmp_path, rest, "rest.obj")
    image = obj(tmp_path, rest.replace("v 1 1", "v 0.2 -0.2"), "image.obj")
    audit = read_warp(image, source).audit()
    assert audit.verdict == "folds"
    other = obj(tmp_path, rest.replace("f 1 3 4", "f 1 4 3"), "other.obj")
    with pytest.raises(glid.InputError, match="its faces are not those of"):
        read_warp(other, source)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "no texture coordinates"),
        (SQUARE + "f 1/1 2/2 3/3 4/4\n", "line 9 has a face of 4 vertices; triangulate it"),
        (SQUARE + "f 1/1 2/2 9/3\n", "line 9 cannot be read"),
        (SQUARE + "f 1/1 2/2 0/3\n", "line 9 cannot be read"),
        ("v 0 zero\n", "line 1 cannot be read: 'v 0 zero'"),
        (SQUARE, "it has no faces"),
        (SQUARE.replace("v 0 1 3", "v 0 1 4") + FACES, "do not lie in a plane"),
        (SQUARE.replace("v 0 1 3", "v 0 1") + FACES, "two or three coordinates each"),
        (SQUARE.replace("vt 0 1", "vt 0") + FACES, "must be pairs"),
    ],
)
def test_an_obj_that_cannot_be_read(tmp_path: Path, text: str, message: str) -> None:
    path = obj(tmp_path, text)
    with pytest.raises(glid.InputError, match=message) as caught:
        read_warp(path)
    assert str(caught.value).startswith(str(path))


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    np.savez(tmp_path / "two.npz", a=field(), b=field())
    np.save(tmp_path / "pickle.npy", np.array([{}]), allow_pickle=True)
    (tmp_path / "broken.npy").write_bytes(b"no numbers")
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04 no numbers")
    (tmp_path / "bytes.obj").write_bytes(b"\xff\xfe\xff")
    np.save(tmp_path / "good.npy", field())
    for name, message in {
        "two.npz": r"it holds 2 arrays \(a, b\)",
        "pickle.npy": "not a file of one array of numbers",
        "broken.npy": "not a file of one array of numbers",
        "broken.npz": "not a file of one array of numbers",
        "bytes.obj": "not text",
        "field.tif": "its name must end in",
    }.items():
        with pytest.raises(glid.InputError, match=message):
            read_warp(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        read_warp(tmp_path / "none.npy")
    with pytest.raises(glid.InputError, match="a source is for meshes"):
        read_warp(tmp_path / "good.npy", tmp_path / "rest.obj")
    with pytest.raises(glid.InputError, match="a spacing is for fields"):
        read_warp(obj(tmp_path, SQUARE + FACES), spacing=(1, 1))


@pytest.mark.parametrize(("name", "module"), [("a.nii.gz", "nibabel"), ("a.nrrd", "nrrd")])
def test_a_missing_library_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, module: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(glid.InputError, match=rf"{module}.*pip install 'glid-nb\[imaging\]'"):
        read_warp(tmp_path / name)


def nifti(path: Path, data: Any, affine: Any, intent: int = 0) -> Path:
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(data, affine)
    image.header["intent_code"] = intent
    nibabel.save(image, path)
    return path


def medical(planar: Any) -> Any:
    """(x, y, 1, 1, 2) of (h, w, 2)."""
    return planar.swapaxes(0, 1)[:, :, None, None]


def test_a_nifti_file(tmp_path: Path) -> None:
    values = field()
    path = nifti(tmp_path / "a.nii.gz", medical(values), np.eye(4))
    np.testing.assert_array_equal(read_warp(path).array, values)
    assert read_warp(path).audit().message == glid.audit(values).message
    three = np.concatenate([medical(values), np.zeros((7, 5, 1, 1, 1))], axis=-1)
    path = nifti(tmp_path / "b.nii", three, np.eye(4))
    np.testing.assert_array_equal(read_warp(path).array, values)


def test_the_steps_of_a_nifti_file(tmp_path: Path) -> None:
    data, steps = medical(field()), np.diag([-0.5, 2.0, 1, 1])
    assert read_warp(nifti(tmp_path / "a.nii", data, steps, 1006)).spacing == (-0.5, 2.0)
    assert read_warp(nifti(tmp_path / "b.nii", data, steps, 1007)).spacing == (0.5, -2.0)
    unknown = nifti(tmp_path / "c.nii", data, steps)
    with pytest.raises(glid.InputError, match=r"its pixels are 0\.5 x 2, and the file"):
        read_warp(unknown)
    assert read_warp(unknown, spacing=(1, 1)).spacing == (1, 1)
    oblique = np.eye(4)
    oblique[0, 1] = 0.1
    with pytest.raises(glid.InputError, match="oblique"):
        read_warp(nifti(tmp_path / "d.nii", data, oblique, 1006))


def test_a_nifti_file_that_is_no_planar_field(tmp_path: Path) -> None:
    for shape, message in (((4, 5, 6, 1, 3), "take a slice"), ((4, 5, 6), "take a slice")):
        path = nifti(tmp_path / "a.nii", np.ones(shape), np.eye(4))
        with pytest.raises(glid.InputError, match=message):
            read_warp(path)
    path = nifti(tmp_path / "b.nii", np.ones((4, 5, 1, 1, 3)), np.eye(4))
    with pytest.raises(glid.InputError, match="third component is not 0"):
        read_warp(path)
    (tmp_path / "c.nii").write_bytes(b"no picture")
    with pytest.raises(glid.InputError, match="not a NIfTI file"):
        read_warp(tmp_path / "c.nii")


@pytest.mark.filterwarnings("ignore:.*utcnow:DeprecationWarning")  # of pynrrd 1.1
def test_nrrd_files(tmp_path: Path) -> None:
    nrrd = pytest.importorskip("nrrd")
    values = field()
    data = np.moveaxis(values.swapaxes(0, 1), -1, 0)  # (2, x, y), as ITK writes
    nrrd.write(str(tmp_path / "plain.nrrd"), data, {"kinds": ["vector", "domain", "domain"]})
    np.testing.assert_array_equal(read_warp(tmp_path / "plain.nrrd").array, values)
    header = {"kinds": ["vector", "domain", "domain", "domain"]}
    header |= {"space": "left-posterior-superior"}
    header |= {"space directions": np.array([[np.nan] * 3, [0.5, 0, 0], [0, -2, 0], [0, 0, 1]])}
    nrrd.write(str(tmp_path / "space.nrrd"), data[..., None], header)
    warp = read_warp(tmp_path / "space.nrrd")
    np.testing.assert_array_equal(warp.array, values)
    assert warp.spacing == (0.5, -2.0)
    (tmp_path / "broken.nrrd").write_bytes(b"no picture")
    with pytest.raises(glid.InputError, match="not an NRRD file"):
        read_warp(tmp_path / "broken.nrrd")
