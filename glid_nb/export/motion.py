"""A motion with a picture as a file of any kind, chosen by its suffix."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._errors import InputError
from glid_nb._files import write_bytes_atomically, zipped
from glid_nb.export import encode
from glid_nb.export.encode import Color
from glid_nb.export.mesh import motion_glb
from glid_nb.export.moving import Progress, Stopped, frames
from glid_nb.export.page import page_html
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.imaging.read import png
from glid_nb.imaging.render import check_fits
from glid_nb.motion import Motion, file
from glid_nb.motion.settings import checked
from glid_nb.solvers import Pose

MOTION_FORMATS = {
    ".gif": "Animation (GIF)",
    ".apng": "Animation with transparency (PNG)",
    ".mp4": "Video (MP4)",
    ".webm": "Video (WebM)",
    ".html": "Page that plays it (HTML)",
    ".glb": "Moving mesh (glTF)",
    ".sheet.png": "Sprite sheet (PNG and JSON)",
    ".zip": "Frames (PNG in a zip)",
    ".motion.json": "Motion and proof for glid-check (JSON)",
}
"""What each suffix of a moving picture stands for. A name without one is a folder of frames."""

_VIDEO = (".mp4", ".webm")
_FPS = 25.0
_MAKE_ONE = "make one of certified maps"


def animate(
    path: str | Path,
    image: ArrayLike,
    motion: Motion,
    poses: Sequence[Pose] | None = None,
    **settings: Any,
) -> tuple[Path, ...]:
    """Write a motion as the path's suffix says; the settings are those of `motion_files`.

    Returns the written files, none where ``progress`` stopped it. A path without a suffix is a
    folder, which is made; an InputError where it holds frames that would stay. An OSError where a
    file cannot be written.
    """
    path = Path(path)
    check_type("motion", motion, Motion, _MAKE_ONE, InputError)
    _check_place(path, motion, settings.get("frames_per_second", _FPS))
    files = motion_files(path.name, image, motion, poses, **settings)
    if files and not path.suffix:
        path.mkdir(exist_ok=True)
    for name, data in files.items():
        write_bytes_atomically(path.parent / name, data)
    return tuple(path.parent / name for name in files)


def _check_place(path: Path, motion: Motion, fps: float) -> None:
    """Raise an InputError unless the files can be where the path says, and are the only frames."""
    if not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent.absolute()}; make it first")
    if suffix_of(path.name):
        if path.is_dir():
            raise InputError(f"{path} is a folder; name a file")
    elif path.is_file():
        raise InputError(f"{path} is a file; name a folder")
    elif (found := {frame.name for frame in path.glob("frame-*.png")}) and (
        left := found - {*encode.names(len(motion.frame_times(fps)))}
    ):
        stays = f"{path} holds {max(left)} of another export, which would stay"
        raise InputError(f"{stays}; delete the old frames, or name another folder")


def motion_files(
    name: str,
    image: ArrayLike,
    motion: Motion,
    poses: Sequence[Pose] | None = None,
    *,
    size: int = 480,
    frames_per_second: float = _FPS,
    background: Color | None = (255, 255, 255),
    loop: bool = True,
    progress: Progress | None = None,
) -> dict[str, bytes]:
    """A motion as files, by name: that of the given name, and what comes with it.

    The suffix says the format: one of `MOTION_FORMATS`, of which .mp4 and .webm need
    ``glid-nb[video]``; .sheet.png comes with .sheet.json, .motion.json with .motion.proof.json, as
    `Motion.save` writes them; without a suffix frames are in a folder.
    The image, (h, w), (h, w, 3) or (h, w, 4), is the one that the cage was traced from. The depths
    of poses, one per keyframe, say which part is in front where the shape overlaps itself.

    Frames have a longer side of ``size`` pixels, 16 to 8192, and even sides; there are at most 100
    per second, of GIF 50. The background's red, green and blue are 0 to 255; None is transparent,
    which GIF and MP4 cannot be. With ``loop`` GIF, APNG and page begin again at the end.
    ``progress`` is called with the numbers of finished and of all frames, or stages where there are
    no frames; when it returns True the export stops, and there are no files.

    Raises an InputError for another suffix, a setting that is out of range, or a missing package.
    """
    suffix = suffix_of(name)
    check_type("motion", motion, Motion, _MAKE_ONE, InputError)
    encode.check_settings(size, frames_per_second, background, suffix == ".gif")
    checked("loop", bool, loop)
    image = as_rgba8(image)
    check_fits(PixelFrame(*image.shape[1::-1]), motion.keyframes[0])
    if background is None and suffix in (".gif", ".mp4"):
        remedy = "choose a background, or .apng or .webm"
        raise InputError(f"{name}: {suffix[1:].upper()} has no transparency; {remedy}")
    if suffix in _VIDEO:
        encode.check_video()
    fps = frames_per_second
    try:
        if suffix == ".html":
            page = page_html(
                image, motion, title=name[:-5], pose=poses, loop=loop, progress=progress
            )
            return {name: page.encode()}
        if suffix == ".glb":
            return {name: motion_glb(image, motion, poses, progress=progress)}
        if suffix == ".motion.json":
            texts = map(str.encode, file.texts(motion))
            return dict(zip(motion_file_names(name), texts, strict=True))
        drawn = frames(image, motion, poses, size, fps, background, progress)
        if suffix in (".gif", ".apng"):
            encode.check_count(drawn)
        if suffix == ".gif" and background is not None:
            return {name: encode.gif(drawn.pictures, fps, background, loop)}
        if suffix == ".apng":
            return {name: encode.apng(drawn.pictures, fps, loop)}
        if suffix in _VIDEO:
            return {name: encode.video(drawn, fps, suffix[1:], background is None)}
        if suffix == ".sheet.png":
            sheet, told = encode.sprite_sheet(drawn, fps, name, png)
            return dict(zip(motion_file_names(name), (sheet, told), strict=True))
        files = dict(zip(encode.names(drawn.count), map(png, drawn.pictures), strict=True))
    except Stopped:
        return {}
    if suffix == ".zip":
        return {name: zipped(files, stored=files)}
    return {f"{name}/{frame}": data for frame, data in files.items()}


def motion_file_names(name: str) -> tuple[str, ...]:
    """The name and those of the files that come with it: a sheet's JSON, a motion's proof."""
    beside = {".sheet.png": ".json", ".motion.json": ".proof.json"}.get(suffix_of(name))
    return (name,) if beside is None else (name, str(Path(name).with_suffix(beside)))


def suffix_of(name: str) -> str:
    """The one of `MOTION_FORMATS` that a name ends in, "" for a folder."""
    found = next((suffix for suffix in MOTION_FORMATS if name.lower().endswith(suffix)), "")
    if len(name) == len(found) or (not found and Path(name).suffix):
        ends = f"{', '.join(MOTION_FORMATS)}, or have no suffix for a folder of frames"
        raise InputError(f"{name!r:.200} cannot be written: the name must end in {ends}")
    return found
