"""The warped picture as a PNG file, and a sequence of them as an animated GIF or PNG."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from glid_nb.figures.style import CYAN, INK
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.mesh import deformed_mesh
from glid_nb.imaging.render import OutputFrame, View, draw_mesh, outline_points, render
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
) -> bytes:
    """Warp a picture through a map; the result is a PNG file with an alpha channel.

    Parameters
    ----------
    image : (h, w, 4), (h, w, 3) or (h, w) array
        The picture that the map's cage was traced from.
    map : HarmonicMap
    size : (w, h), optional
        Pixels of the result; by default the image's own.
    view : "source" or "fit"
        Show what the picture showed, or all of the deformed shape; see `glid_nb.render`.

    Raises
    ------
    ValueError
        When an argument is out of range; the message names it.
    """
    return png(render(image, map, size, view=view))


def png(pixels: NDArray[np.uint8], compress_level: int = 6) -> bytes:
    """A PNG file of (h, w), (h, w, 3) or (h, w, 4) pixels."""
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG", compress_level=compress_level)
    return buffer.getvalue()


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
) -> bytes:
    """Warp a picture through a sequence of maps, such as those of a drag.

    All frames show the same part of the plane, which holds every one of the deformed shapes.

    Parameters
    ----------
    image : (h, w, 4), (h, w, 3) or (h, w) array
        The picture that the maps' cages were traced from.
    maps : sequence of HarmonicMap
        One per frame, at least one.
    poses : sequence of Pose, optional
        One per map: its targets are drawn as disks, the images of its handles as dots.
    size : int
        Pixels of the longer side, at least 16.
    frames_per_second : float
        At most 100. GIF rounds the duration of a frame to hundredths of a second.
    background : (red, green, blue)
        0 to 255 each.
    there_and_back : bool
        Append the frames in reverse order, so that the loop has no jump.
    format : "gif" or "apng"
        GIF is supported everywhere but has 256 colours only.

    Raises
    ------
    ValueError
        When an argument is out of range; the message names it.
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
    texture = Texture.from_image(image)
    frame = _common_frame(maps, size)
    tolerance = _TOLERANCE_PX / frame.pixels_per_unit
    pictures = []
    for i, map in enumerate(maps):
        mesh = deformed_mesh(map, _VERTICES, tolerance)
        picture = _on_background(draw_mesh(texture, mesh, frame), background)
        if poses is not None:
            picture = _with_marks(picture, poses[i], map, frame)
        pictures.append(picture)
    if there_and_back:
        pictures += pictures[-2:0:-1]
    return _encoded(pictures, 1000.0 / frames_per_second, background, format)


def _common_frame(maps: list[HarmonicMap], size: int) -> OutputFrame:
    """A frame that holds all the deformed shapes; their boundaries suffice to find it."""
    loops = [map(outline_points(map)) for map in maps]
    low = np.min([loop.min(axis=0) for loop in loops], axis=0)
    high = np.max([loop.max(axis=0) for loop in loops], axis=0)
    extent = (high - low) / (1 - 2 * _MARGIN)
    scale = size / float(extent.max())
    width, height = (max(1, math.ceil(side * scale)) for side in extent)
    x, y = (low + high) / 2
    return OutputFrame((width, height), scale, (float(x), float(y)))


def _on_background(pixels: NDArray[np.uint8], background: tuple[int, int, int]) -> Image.Image:
    ground = Image.new("RGBA", (pixels.shape[1], pixels.shape[0]), (*background, 255))
    return Image.alpha_composite(ground, Image.fromarray(pixels)).convert("RGB")


def _with_marks(
    picture: Image.Image, pose: Pose, map: HarmonicMap, frame: OutputFrame
) -> Image.Image:
    if not len(pose):
        return picture
    size = (picture.width * _SMOOTH, picture.height * _SMOOTH)
    layer = Image.new("RGBA", size, (0, 0, 0, 0))
    draw = ImageDraw.Draw(layer)
    targets = frame.to_pixel(pose.targets) * _SMOOTH
    images = frame.to_pixel(map(pose.handles)) * _SMOOTH
    unit = max(size)
    for (x, y), (u, v) in zip(targets, images, strict=True):
        draw.line([(x, y), (u, v)], fill=INK, width=max(1, round(unit / 400)))
    for points, radius, color in ((targets, _TARGET, CYAN), (images, _HANDLE, INK)):
        r = radius * unit
        for x, y in points:
            draw.ellipse((x - r, y - r, x + r, y + r), fill=color, outline="white", width=_SMOOTH)
    small = layer.resize(picture.size, Image.Resampling.LANCZOS)
    return Image.alpha_composite(picture.convert("RGBA"), small).convert("RGB")


def _encoded(
    pictures: list[Image.Image],
    milliseconds: float,
    background: tuple[int, int, int],
    format: Format,
) -> bytes:
    kind = "PNG"
    if format == "gif":
        # Flat areas would flicker if each frame had its own palette.
        palette = _palette(pictures, background)
        pictures = [_with_palette(picture, palette, background) for picture in pictures]
        kind, milliseconds = "GIF", 10 * max(1, round(milliseconds / 10))
    buffer = io.BytesIO()
    pictures[0].save(
        buffer,
        format=kind,
        save_all=True,
        append_images=pictures[1:],
        duration=milliseconds,
        loop=0,
        optimize=False,
    )
    return buffer.getvalue()


def _palette(pictures: list[Image.Image], background: tuple[int, int, int]) -> Image.Image:
    """A picture with a palette for all frames, made from at most eight of them.

    The exact background comes first; an averaged one would show a dither pattern.
    """
    chosen = pictures[:: max(1, math.ceil(len(pictures) / 8))]
    width, height = pictures[0].size
    montage = Image.new("RGB", (width, height * len(chosen)))
    for i, picture in enumerate(chosen):
        montage.paste(picture, (0, i * height))
    colors = montage.quantize(255, method=Image.Quantize.MEDIANCUT).getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([*background, *colors[: 3 * 255]])
    return palette


def _with_palette(
    picture: Image.Image, palette: Image.Image, background: tuple[int, int, int]
) -> Image.Image:
    indices = np.array(picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG))
    # Pillow looks up colours in bins of four levels, so it may miss the background.
    indices[(np.asarray(picture) == background).all(axis=2)] = 0
    result = Image.fromarray(indices)
    result.putpalette(palette.getpalette() or [])
    return result
