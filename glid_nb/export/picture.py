"""The warped picture as a PNG file, and a sequence of them as an animated GIF or PNG."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from glid_nb.figures.style import CYAN, INK
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.imaging.mesh import deformed_loops, deformed_mesh
from glid_nb.imaging.order import order_of
from glid_nb.imaging.read import png
from glid_nb.imaging.render import View, draw_mesh, render
from glid_nb.imaging.sheets import Sheets
from glid_nb.imaging.texture import Texture
from glid_nb.solvers import Pose

Format = Literal["gif", "apng"]

_VERTICES = 3000  # of the mesh of one frame
_TOLERANCE_PX = 0.25  # straight edges stray from the map by less than this
_MARGIN = 0.04  # room around all frames together, as a share of the sides
_TARGET, _HANDLE = 0.017, 0.008  # radii of the marks, as shares of the longer side
_SMOOTH = 4  # the marks are drawn this much larger and scaled down


def picture_png(
    image: ArrayLike,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    view: View = "source",
    pose: Pose | None = None,
) -> bytes:
    """Warp a picture through a map, as `glid_nb.render` does; a PNG file with an alpha channel."""
    return png(render(image, map, size, view=view, pose=pose))


def animation_bytes(
    image: ArrayLike,
    maps: Sequence[HarmonicMap],
    poses: Sequence[Pose] | None = None,
    *,
    size: int = 480,
    frames_per_second: float = 20.0,
    background: tuple[int, int, int] = (255, 255, 255),
    there_and_back: bool = False,
    format: Format = "gif",
    marks: bool = True,
) -> bytes:
    """Warp a picture through a sequence of maps, such as those of a drag.

    The image, (h, w), (h, w, 3) or (h, w, 4), is the one that the maps' cages were traced from.
    There is one frame per map, at least one, whose longer side has ``size`` pixels, at least 16;
    all of them show the same part of the plane, which holds every one of the deformed shapes. With
    poses, one per map, their depths say what is in front, and with ``marks`` their targets are
    drawn as disks, the images of their handles as dots; rings where another part of the shape
    covers them.

    There are at most 100 frames per second; GIF rounds the duration of a frame to hundredths of a
    second. The background's red, green and blue are 0 to 255. ``there_and_back`` appends the frames
    in reverse order, so that the loop has no jump. The format is "gif", which is supported
    everywhere but has 256 colours only, or "apng".

    Raises a ValueError that names an argument out of range.
    """
    maps = list(maps)
    if not maps:
        raise ValueError("maps is empty; an animation needs at least one map")
    if poses is not None and len(poses) != len(maps):
        raise ValueError(f"there are {len(maps)} maps but {len(poses)} poses; give one per map")
    if size < 16:
        raise ValueError(f"size is {size}; it must be at least 16 pixels")
    if not (math.isfinite(frames_per_second) and 0 < frames_per_second <= 100):
        raise ValueError(f"frames_per_second is {frames_per_second}; it must be above 0, up to 100")
    if len(background) != 3 or not all(0 <= channel <= 255 for channel in background):
        raise ValueError(f"background is {background}; it must be three numbers from 0 to 255")
    if format not in get_args(Format):
        raise ValueError(f"unknown format {format!r}; choose one of {', '.join(get_args(Format))}")
    pixels, frame = as_rgba8(image), _common_frame(maps, size)
    texture = Texture.from_image(pixels)
    pictures = []
    for i, map in enumerate(maps):
        pose = None if poses is None else poses[i]
        mesh = deformed_mesh(map, _VERTICES, _TOLERANCE_PX * frame.units_per_pixel, pose)
        picture = Image.new("RGBA", (frame.width, frame.height), (*background, 255))
        picture.alpha_composite(Image.fromarray(draw_mesh(texture, mesh, frame)))
        if pose is not None and marks:
            hidden = Sheets(map, order_of(map.domain.cage, pose), pixels).hidden(pose.handles)
            picture.alpha_composite(_marks(pose, map, frame, hidden))
        pictures.append(picture.convert("RGB"))
    if there_and_back:
        pictures += pictures[-2:0:-1]
    duration = 1000.0 / frames_per_second
    if format == "gif":
        pictures, duration = _with_palette(pictures, background), 10 * max(1, round(duration / 10))
    kind: Any = {"format": "GIF" if format == "gif" else "PNG", "save_all": True, "optimize": False}
    buffer = io.BytesIO()
    pictures[0].save(buffer, append_images=pictures[1:], duration=duration, loop=0, **kind)
    return buffer.getvalue()


def _common_frame(maps: list[HarmonicMap], size: int) -> PixelFrame:
    """A frame that holds all the deformed shapes; their boundaries suffice to find it."""
    points = np.concatenate([deformed_loops(map)[0] for map in maps])
    extent = np.ptp(points, axis=0)
    width, height = (max(1, math.ceil(side)) for side in size * (extent / extent.max()))
    return PixelFrame(width, height).showing([points.min(axis=0), points.max(axis=0)], _MARGIN)


def _marks(
    pose: Pose, map: HarmonicMap, frame: PixelFrame, hidden: NDArray[np.bool_]
) -> Image.Image:
    """Disks at the targets, dots at the images of the handles, lines between; rings if hidden."""
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


def _with_palette(
    pictures: list[Image.Image], background: tuple[int, int, int]
) -> list[Image.Image]:
    """The pictures with one palette, made from at most eight of them.

    Flat areas would flicker if each had its own. The exact background comes first; an averaged one
    would show a dither pattern.
    """
    chosen = pictures[:: math.ceil(len(pictures) / 8)]
    montage = Image.fromarray(np.concatenate([np.asarray(picture) for picture in chosen]))
    colors = [*background, *(montage.quantize(255).getpalette() or [])]
    palette = Image.new("P", (1, 1))
    palette.putpalette(colors)
    result = []
    for picture in pictures:
        indices = np.array(picture.quantize(palette=palette))
        # Pillow looks up colours in bins of four levels, so it may miss the background.
        indices[(np.asarray(picture) == background).all(axis=2)] = 0
        result.append(Image.fromarray(indices))
        result[-1].putpalette(colors)
    return result
