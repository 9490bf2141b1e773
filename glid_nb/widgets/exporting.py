"""What an editor can write for other programs, by the name of the file."""

from __future__ import annotations

from pathlib import Path

from glid_nb._files import write_bytes_atomically
from glid_nb.export import (
    cage_svg,
    mesh_glb,
    mesh_obj,
    page_html,
    picture_png,
    textured_mesh,
)
from glid_nb.export.picture import png
from glid_nb.imaging.render import View
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.script import python_code

FORMATS = {
    ".png": "Picture (PNG)",
    ".obj": "Mesh and texture (OBJ)",
    ".glb": "Mesh and texture (glTF)",
    ".svg": "Cage (SVG)",
    ".html": "Page that shows it (HTML)",
    ".py": "Python script",
}
"""What each suffix stands for."""


class ExportError(ValueError):
    """Something cannot be exported that way."""


def export(
    model: EditorModel,
    path: str | Path,
    size: tuple[int, int] | None = None,
    view: View = "source",
) -> tuple[Path, ...]:
    """Write what is shown to a file whose suffix says how; returns the files that were written.

    Parameters
    ----------
    model : EditorModel
    path : path
        Ends in one of `FORMATS`. An OBJ mesh and a script come with further files beside them.
    size : (w, h), optional
        Pixels of a picture; by default the original's.
    view : "source" or "fit"
        Whether a picture shows what the original showed, or all of the shape.

    Raises
    ------
    ExportError
        For another suffix.
    OSError
        When a file cannot be written.
    """
    path = Path(path)
    document, map_ = model.document, model.deformation.map
    image, suffix = document.image, path.suffix.lower()
    height, width = image.shape[:2]
    files: dict[str, bytes]
    if suffix == ".png":
        files = {path.name: picture_png(image, map_, size, view)}
    elif suffix == ".obj":
        files = mesh_obj(textured_mesh(image, map_), path.stem)
    elif suffix == ".glb":
        files = {path.name: mesh_glb(textured_mesh(image, map_))}
    elif suffix == ".svg":
        text = cage_svg(map_, (width, height), source=True, pose=model.deformation.pose)
        files = {path.name: text.encode()}
    elif suffix == ".html":
        page = page_html(image, map_, model.deformation.certificate, path.stem)
        files = {path.name: page.encode()}
    elif suffix == ".py":
        picture = f"{path.stem}.png"
        files = {
            path.name: python_code(document, picture).encode(),
            picture: png(image),
        }
    else:
        raise ExportError(
            f"{path.name}: cannot export to {suffix or 'a file without suffix'!r}; "
            f"use one of {', '.join(FORMATS)}"
        )
    for name, data in files.items():
        write_bytes_atomically(path.parent / name, data)
    return tuple(path.parent / name for name in files)
