"""Exports of an editor, chosen by the file's suffix."""

import contextlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from glid_nb._errors import InputError
from glid_nb._files import write_bytes_atomically, zipped
from glid_nb._json import json_text
from glid_nb._runtime import data_directory
from glid_nb.certificate.proof import proof_text
from glid_nb.imaging.read import png
from glid_nb.imaging.render import View
from glid_nb.session.document_file import document_bytes
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.script import python_code

FORMATS = {
    ".png": "Picture (PNG)",
    ".obj": "Mesh and texture (OBJ)",
    ".glb": "Mesh and texture (glTF)",
    ".svg": "Cage (SVG)",
    ".html": "Page that shows it (HTML)",
    ".py": "Python script",
    ".proof.json": "Proof for glid-check (JSON)",
    ".glid": "Session (GLID)",
}
"""What each suffix stands for."""

_BESIDE = {
    ".obj": (".mtl", "-texture.png"),
    ".py": ("-source.png",),
    ".proof.json": (".map.json",),
}
"""Endings, after the stem, of the files that come with one."""


class ExportError(InputError):
    """A file cannot be exported that way."""


class OccupiedError(ExportError):
    """Files that the editor did not write would be replaced; ``plain`` asks whether to."""

    def __init__(self, paths: Sequence[Path]) -> None:
        names = ", ".join(str(path.absolute()) for path in paths)
        super().__init__(f"{names}: there already; choose another name, or move it away")
        verb = "is" if len(paths) == 1 else "are"
        self.plain = (
            f"{names_of(paths)} {verb} in {paths[0].absolute().parent} already, not written by "
            "this editor. Click again to replace, or choose another name."
        )


def names_of(paths: Sequence[Path]) -> str:
    """The names of files, as a list in words."""
    *others, last = (path.name for path in paths)
    return f"{', '.join(others)} and {last}" if others else last


def files_of(path: Path) -> tuple[Path, ...]:
    """The files that `export` writes for this name: itself, then those that come with it."""
    suffix = _suffix(path)
    stem = path.name[: -len(suffix)]
    return (path, *(path.with_name(stem + rest) for rest in _BESIDE.get(suffix, ())))


def _suffix(path: Path) -> str:
    """The one of `FORMATS` that the name ends in; ExportError for none."""
    for suffix in FORMATS:
        if path.name.lower().endswith(suffix) and len(path.name) > len(suffix):
            return suffix
    raise ExportError(
        f"{str(path)!r} cannot be exported: its name must end in {', '.join(FORMATS)}"
    )


def check_free(model: EditorModel, paths: Sequence[Path], owner: Path) -> None:
    """Raise `OccupiedError` if files are there that the editor did not write for ``owner``."""
    if strangers := model.own_files.strangers(paths, owner):
        raise OccupiedError(strangers)


def export(
    model: EditorModel,
    path: str | Path,
    size: tuple[int, int] | None = None,
    view: View = "source",
    *,
    replace: bool = False,
) -> tuple[Path, ...]:
    """Export what is shown in the format of the suffix; returns the written files.

    A file of the given name is replaced. The files that come with it, ``.mtl`` and ``-texture.png``
    of an OBJ mesh or the ``-source.png`` that a script reads, replace only those of an earlier
    export under this name, unless ``replace`` says so. ``size`` in pixels and ``view`` of a picture
    are as in `glid_nb.render`.

    Raises
    ------
    ExportError
        For another suffix; as `OccupiedError` when a file that comes with it would replace another.
    OSError
        When a file cannot be written.
    """
    path = Path(path)
    files = files_of(path)
    first, *others = _contents(model, path, size, view)
    # If the file exists, those beside it came with it.
    _write(model, path, dict(zip(files[1:], others, strict=True)), replace or path.exists())
    _write(model, path, {path: first}, replace=True)
    return files


def download(
    model: EditorModel, path: Path, size: tuple[int, int] | None = None, view: View = "source"
) -> tuple[str, bytes]:
    """What `export` writes for this name as one file: its name and content, a zip of several."""
    contents = _contents(model, path, size, view)
    files = dict(zip((file.name for file in files_of(path)), contents, strict=True))
    return as_one(files, path.name[: -len(_suffix(path))])


def as_one(files: Mapping[str, bytes], stem: str) -> tuple[str, bytes]:
    """The name and content of a file, or a zip of several."""
    if len(files) == 1:
        return next(iter(files.items()))
    return f"{stem}.zip", zipped(files)


def write_beside(model: EditorModel, path: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write files that belong to a path into its folder; those that are there are replaced."""
    contents = {path.parent / name: data for name, data in files.items()}
    _write(model, path, contents, replace=True)
    return list(contents)


def export_source(model: EditorModel, script: Path, *, replace: bool = False) -> None:
    """Write the picture that a script of this name reads, where it is not there yet.

    Raises as `export` when another file is there.
    """
    _write(model, script, {files_of(script)[1]: png(model.document.image)}, replace)


def _contents(
    model: EditorModel, path: Path, size: tuple[int, int] | None, view: View
) -> list[bytes]:
    """The contents of `files_of` the path, in that order."""
    from glid_nb import export as to  # noqa: PLC0415 - the first canvas does not need it

    document, state = model.document, model.deformation.state
    image, map_, pose = document.image, state.map, state.pose
    match _suffix(path):
        case ".png":
            return [to.picture_png(image, map_, size, view, pose)]
        case ".obj":
            files = to.mesh_obj(to.textured_mesh(image, map_, pose=pose), path.stem)
            return [files[path.stem + rest] for rest in (".obj", *_BESIDE[".obj"])]
        case ".glb":
            return [to.mesh_glb(to.textured_mesh(image, map_, pose=pose))]
        case ".svg":
            height, width = image.shape[:2]
            return [to.cage_svg(map_, (width, height), source=True, pose=pose).encode()]
        case ".html":
            proof = model.deformation.certificate
            return [to.page_html(image, map_, proof, path.stem, pose=pose).encode()]
        case ".glid":
            return [document_bytes(document)]
        case ".proof.json":
            depths = pose.to_dict() if pose.depths.any() else {}
            return [
                proof_text(model.deformation.certificate).encode(),
                json_text({**map_.to_dict(), **depths}).encode(),
            ]
        case _:
            return [python_code(document, files_of(path)[1].name).encode(), png(image)]


def _write(model: EditorModel, owner: Path, contents: Mapping[Path, bytes], replace: bool) -> None:
    """Write files that belong to ``owner``."""
    new = {path: data for path, data in contents.items() if not _holds(path, data)}
    if not replace:
        check_free(model, list(new), owner)
    for path, data in new.items():
        write_bytes_atomically(path, data)
    model.own_files.note(contents, owner)


def _holds(path: Path, data: bytes) -> bool:
    return path.is_file() and path.stat().st_size == len(data) and path.read_bytes() == data


def last_export() -> dict[str, Any]:
    """What `remember_export` wrote last; empty where nothing can be read."""
    try:
        known = json.loads(_last_export().read_bytes())
    except (OSError, ValueError):  # none yet, or damaged
        return {}
    return known if isinstance(known, dict) else {}


def remember_export(choices: Mapping[str, Any]) -> None:
    """Keep the choices of an export in the user's data folder, if that can be written."""
    path = _last_export()
    with contextlib.suppress(OSError):  # the export itself needs no such folder
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes_atomically(path, json_text(choices).encode())


def _last_export() -> Path:
    return data_directory() / "last-export.json"
