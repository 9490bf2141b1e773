"""Export the warped picture as a PNG file, or a sequence of pictures as an animated GIF or PNG."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.export.encode import Frames, check_settings, encoded
from glid_nb.export.parts import checked_parts
from glid_nb.figures.style import CYAN, INK
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, Sheets, as_rgba8, deformed_loops, deformed_mesh, order_of
from glid_nb.imaging.backdrop import (
    WHITE,
    Backdrop,
    Background,
    check_background,
    drawn_backdrop,
    over,
)
from glid_nb.imaging.progress import Progress
from glid_nb.imaging.read import png
from glid_nb.imaging.render import (
    MARGIN,
    TOLERANCE_PX,
    View,
    check_fits,
    draw_mesh,
    frame_of,
    mesh_in,
    render,
)
from glid_nb.imaging.texture import Texture
from glid_nb.motion.settings import checked
from glid_nb.pose import Pose

Format = Literal["gif", "apng"]

_VERTICES = 3000  # of the mesh of one frame
_TARGET, _HANDLE = 0.017, 0.008  # radii of the marks, as shares of the longer side
_SMOOTH = 4  # marks are drawn this many times larger and scaled down


def picture_png(
    image: ArrayLike,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    view: View = "source",
    pose: Pose | None = None,
    progress: Progress | None = None,
    background: Background = None,
) -> bytes:
    """Warp a picture through a map, like `glid_nb.render`. A PNG file with an alpha channel."""
    shown = {"view": view, "pose": pose, "progress": progress, "background": background}
    return png(render(image, map, size, **shown))


@dataclass(frozen=True, eq=False)
class StillPart:
    """A shape of a picture: its own picture, its map, and a pose whose depths order its sheets."""

    image: ArrayLike
    map: HarmonicMap
    pose: Pose | None = None


def parts_png(
    parts: Sequence[StillPart],
    size: tuple[int, int] | None = None,
    view: View = "source",
    background: Background = None,
) -> bytes:
    """Warp several shapes, the rearmost first. Later ones cover earlier ones.

    Their pictures have the same size. The arguments are those of `glid_nb.render`.
    """
    parts = checked_parts(parts, StillPart)
    for i, part in enumerate(parts):
        check_type(
            f"the map of parts[{i}]", part.map, HarmonicMap, "for example result.map", InputError
        )
    textures = [Texture.from_image(as_rgba8(part.image)) for part in parts]
    source = PixelFrame(*textures[0].size)
    frame = frame_of(source, [part.map for part in parts], size, view)
    pixels = drawn_backdrop(check_background(background), frame)
    for texture, part in zip(textures, parts, strict=True):
        mesh = mesh_in(frame, part.map, part.pose)
        pixels = over(draw_mesh(texture, mesh, frame), pixels)
    assert pixels is not None
    return png(pixels)


def animation_bytes(
    image: ArrayLike,
    maps: Sequence[HarmonicMap],
    poses: Sequence[Pose] | None = None,
    *,
    size: int = 480,
    frames_per_second: float = 20.0,
    background: Background = WHITE,
    there_and_back: bool = False,
    format: Format = "gif",
    marks: bool = True,
) -> bytes:
    """Warp a picture through a sequence of maps, such as those of a drag.

    The image is the one from which the maps' cages were traced. There is one frame per map, whose
    longer side has ``size`` pixels, at least 16. All frames show the same part of the plane, which
    contains all deformed shapes. With poses, one per map, their depths decide which part is in
    front. With ``marks``, the targets of the poses are drawn as disks and the images of their
    handles as dots. Handles that another part of the shape covers are rings.

    There are at most 100 frames per second, 50 for a GIF. The background's red, green and blue are
    0 to 255. None is transparent, for an "apng" only. If the background is a picture, as in
    `glid_nb.render`, the frames show its rectangle. ``there_and_back`` appends the frames in
    reverse order, so that the loop has no jump. A "gif" is supported everywhere but has only 256
    colours; an "apng" keeps all colours. Raises an InputError that names an argument out of range.
    """
    for name, given, kind in (("maps", maps, HarmonicMap), ("poses", poses or (), Pose)):
        check_type(name, given, Sequence, "of a motion give motion.resample(20)[1]", InputError)
        for one in given:
            check_type(f"each of {name}", one, kind, "give one for each frame", InputError)
    if not maps:
        raise InputError("maps is empty; an animation needs at least one map")
    if poses is not None and len(poses) != len(maps):
        raise InputError(f"there are {len(maps)} maps but {len(poses)} poses; give one per map")
    checked("format", Format, format)
    ground = check_settings(size, frames_per_second, background, f".{format}")
    pixels = as_rgba8(image)
    for map in maps:
        check_fits(PixelFrame(pixels.shape[1], pixels.shape[0]), map)
    # The boundaries are enough to find the box around all deformed shapes.
    points = np.concatenate([deformed_loops(map)[0] for map in maps])
    frame = frame_around(points, size, ground)
    behind = drawn_backdrop(ground, frame)
    texture, frames = Texture.from_image(pixels), []
    for i, map in enumerate(maps):
        pose = None if poses is None else poses[i]
        mesh = deformed_mesh(map, _VERTICES, TOLERANCE_PX * frame.units_per_pixel, pose)
        drawn = draw_mesh(texture, mesh, frame)
        picture = Image.fromarray(over(drawn, behind))
        if pose is not None and marks:
            hidden = Sheets(map, order_of(map.domain.cage, pose), pixels).hidden(pose.handles)
            picture.alpha_composite(_marks(pose, map, frame, hidden))
        frames.append(np.asarray(picture.convert("RGBA" if ground is None else "RGB")))
    if there_and_back:
        frames += frames[-2:0:-1]
    drawn = Frames((frame.width, frame.height), len(frames), frames.__getitem__)
    return encoded(drawn, "", f".{format}", frames_per_second, ground)[0]


def frame_around(points: NDArray[np.float64], size: int, background: Backdrop = None) -> PixelFrame:
    """A frame with a longer side of ``size`` and even sides that contains (k, 2) points. With a
    picture as background, it shows this picture instead."""
    if isinstance(background, np.ndarray):
        points = np.reshape(PixelFrame(*background.shape[1::-1]).bounds, (2, 2))
    extent = np.ptp(points, axis=0)
    width, height = (2 * max(1, math.ceil(side / 2)) for side in size * (extent / extent.max()))
    frame = PixelFrame(width, height)
    if not isinstance(background, np.ndarray):
        return frame.showing([points.min(axis=0), points.max(axis=0)], MARGIN)
    # Even sides have a slightly other aspect ratio; the frame must not show what is beside.
    sides = np.array([width, height])
    room = sides * (extent / sides).min() / 2
    return frame.showing([points.mean(axis=0) - room, points.mean(axis=0) + room], 0)


def _marks(pose: Pose, map: HarmonicMap, frame: PixelFrame, hidden: Array) -> Image.Image:
    """Draw disks at the targets, dots at the handles' images, and lines between them. Hidden
    handles are rings."""
    layer = Image.new("RGBA", (frame.width * _SMOOTH, frame.height * _SMOOTH))
    draw, unit = ImageDraw.Draw(layer), max(layer.size)
    targets = frame.to_pixel(pose.targets) * _SMOOTH
    images = frame.to_pixel(map(pose.handles)) * _SMOOTH
    for ends in np.concatenate([targets, images], axis=1).tolist():
        draw.line(ends, fill=INK, width=max(1, round(unit / 400)))
    for points, radius, color in ((targets, _TARGET, CYAN), (images, _HANDLE, INK)):
        for point in points[~hidden].tolist():
            draw.circle(point, radius * unit, fill=color, outline="white", width=_SMOOTH)
    for point in targets[hidden].tolist():
        draw.circle(point, _TARGET * unit, outline=CYAN, width=2 * _SMOOTH)
    return layer.resize((frame.width, frame.height), Image.Resampling.LANCZOS)
