"""Export a motion of a picture as a file. The suffix selects the format."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._errors import InputError
from glid_nb._files import write_atomically
from glid_nb.export import encode
from glid_nb.export.formats import OF_ONE_SHAPE, file_names, part_names, suffix_of
from glid_nb.export.mesh import motion_glb, parts_motion_glb
from glid_nb.export.moving import MovingPart, check_picture, frames, moving_parts
from glid_nb.export.page import PagePart, parts_page_html
from glid_nb.imaging import as_rgba8
from glid_nb.imaging.backdrop import WHITE, Backdrop, Background
from glid_nb.imaging.order import Order
from glid_nb.imaging.progress import Progress, Stopped, report
from glid_nb.motion import Motion
from glid_nb.motion.settings import checked
from glid_nb.pose import Pose

_FPS = 25.0
_MAKE_ONE = "make one of certified maps"


def animate(
    path: str | Path,
    image: ArrayLike,
    motion: Motion,
    poses: Sequence[Pose | Order] | None = None,
    **settings: Any,
) -> tuple[Path, ...]:
    """Write a motion in the format of the path's suffix. The settings are those of `motion_files`.

    Returns the written files; none if ``progress`` stopped the export. A path without a suffix is a
    folder, which is made. Raises an InputError if the folder contains other frames that would stay,
    an OSError if a file cannot be written.
    """
    check_type("motion", motion, Motion, _MAKE_ONE, InputError)

    def made(name: str) -> dict[str, bytes]:
        return motion_files(name, image, motion, poses, **settings)

    return _written(Path(path), motion, settings, made)


def animate_parts(
    path: str | Path, parts: Sequence[MovingPart], **settings: Any
) -> tuple[Path, ...]:
    """Like `animate` for several shapes. The settings are those of `parts_motion_files`."""
    parts = moving_parts(parts)

    def made(name: str) -> dict[str, bytes]:
        return parts_motion_files(name, parts, **settings)

    return _written(Path(path), parts[0].motion, settings, made)


def _written(
    path: Path, motion: Motion, settings: dict[str, Any], made: Callable[[str], dict[str, bytes]]
) -> tuple[Path, ...]:
    _check_place(path, motion, settings.get("frames_per_second", _FPS))
    files = made(path.name)
    if files and not path.suffix:
        path.mkdir(exist_ok=True)
    for name, data in files.items():
        write_atomically(path.parent / name, data)
    return tuple(path.parent / name for name in files)


def _check_place(path: Path, motion: Motion, fps: float) -> None:
    """Raise an InputError unless the files can be written there and no other frames are there."""
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
    poses: Sequence[Pose | Order] | None = None,
    *,
    size: int = 480,
    frames_per_second: float = _FPS,
    background: Background = WHITE,
    loop: bool = True,
    progress: Progress | None = None,
) -> dict[str, bytes]:
    """The contents of the files of an exported motion, by name: the named file and its companions.

    The suffix selects the format, one of `MOTION_FORMATS`. The formats .mp4 and .webm need
    ``glid-nb[video]``. .sheet.png comes with .sheet.json. .motion.json comes with
    .motion.proof.json, as written by `Motion.save`. Without a suffix, the files are frames in a
    folder. The image is the one from which the cage was traced. Where the shape overlaps itself,
    the depths of the poses, one per keyframe, decide which part is in front.

    Frames have a longer side of ``size`` pixels, 16 to 8192, and even sides. There are at most 100
    frames per second, 50 for GIF. The background's red, green and blue are 0 to 255. None is
    transparent, which GIF and MP4 do not support. If the background is a picture, as in
    `glid_nb.render`, frames show its rectangle, whose longer side has ``size`` pixels. A page has a
    ground of its own instead of white. With ``loop``, a GIF, an APNG and a page start again at the
    end. ``progress`` is called with the number of finished frames and the number of all frames, or
    stages for formats without frames. If it returns True, the export stops, and the result is
    empty.

    Raises an InputError for a motion that is not completely proved, another suffix, a setting out
    of range, or a missing package.
    """
    suffix, fps = suffix_of(name), frames_per_second
    check_type("motion", motion, Motion, _MAKE_ONE, InputError)
    if suffix not in OF_ONE_SHAPE | {".glb"}:
        how: dict[str, Any] = {"size": size, "frames_per_second": fps, "background": background}
        how |= {"loop": loop, "progress": progress}
        return parts_motion_files(name, [MovingPart(image, motion, poses)], **how)
    encode.check_settings(size, fps, background, suffix)
    checked("loop", bool, loop)
    image = as_rgba8(image)
    height, width = image.shape[:2]
    _check_motion((width, height), motion)
    try:
        if suffix == ".glb":
            contents = [motion_glb(image, motion, poses, progress=progress)]
        else:  # .motion.json
            report(progress, 0, 1)
            contents = [text.encode() for text in motion.texts(image_size=(width, height))]
            report(progress, 1, 1)
    except Stopped:
        return {}
    return _named(name, suffix, contents)


def parts_motion_files(
    name: str,
    parts: Sequence[MovingPart],
    *,
    size: int = 480,
    frames_per_second: float = _FPS,
    background: Background = WHITE,
    loop: bool = True,
    progress: Progress | None = None,
) -> dict[str, bytes]:
    """Like `motion_files` for several shapes, the rearmost first.

    Their motions have the same times. Frames and a page show all shapes; later ones cover earlier
    ones. A glTF file has a node for each. The formats in `OF_ONE_SHAPE` hold one shape. So there
    are files for each part, with its name in theirs (`part_names`).
    """
    suffix, fps, parts = suffix_of(name), frames_per_second, moving_parts(parts)
    if suffix in OF_ONE_SHAPE:
        how: dict[str, Any] = {"size": size, "frames_per_second": fps, "background": background}
        how |= {"loop": loop, "progress": progress}
        names = part_names(name, suffix, [part.name for part in parts])
        files = [
            motion_files(own, part.image, part.motion, part.poses, **how)
            for own, part in zip(names, parts, strict=True)
        ]
        return {n: data for each in files for n, data in each.items()} if all(files) else {}
    ground = encode.check_settings(size, fps, background, suffix)
    checked("loop", bool, loop)
    for part in parts:
        height, width = as_rgba8(part.image).shape[:2]
        _check_motion((width, height), part.motion, part.name)
    try:
        if suffix == ".glb":
            contents = [parts_motion_glb(parts, progress=progress)]
        elif suffix == ".html":
            contents = [_page(parts, name[: -len(suffix)], loop, progress, ground)]
        else:
            drawn = frames(parts, size, fps, ground, progress)
            contents = encode.encoded(drawn, name, suffix, fps, ground, loop)
    except Stopped:
        return {}
    return _named(name, suffix, contents)


def _page(
    parts: Sequence[MovingPart],
    title: str,
    loop: bool,
    progress: Progress | None,
    background: Backdrop,
) -> bytes:
    shown = [PagePart(part.image, part.motion, None, part.poses, part.name) for part in parts]
    behind = None if isinstance(background, tuple) and background == WHITE else background
    how: dict[str, Any] = {"loop": loop, "progress": progress, "background": behind}
    return parts_page_html(shown, title, **how).encode()


def _check_motion(size: tuple[int, int], motion: Motion, name: str = "") -> None:
    check_picture(size, motion)
    if not motion.certificate.certified:
        of = f"The part {name!r}: " if name else ""
        remedy = 'add a keyframe before that, or choose between="auto"'
        why = f"{of}{motion.certificate.reason}"
        raise InputError(f"{why} Nothing uncertified is exported; {remedy}.")


def _named(name: str, suffix: str, contents: list[bytes]) -> dict[str, bytes]:
    pictures = (f"{name}/{frame}" for frame in encode.names(len(contents)))
    return dict(zip(file_names(name) if suffix else pictures, contents, strict=True))
