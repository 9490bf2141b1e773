"""What lies behind the shape: nothing, a colour, or the old picture with its hole filled in."""

import math
from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import ArrayLike, NDArray
from PIL import Image
from scipy.ndimage import distance_transform_edt, gaussian_filter

from glid_nb._arguments import plain, unmet
from glid_nb._arrays import Array, read_only
from glid_nb._errors import InputError
from glid_nb.geometry import Cage
from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.matte import cut_out, grown
from glid_nb.imaging.rasterise import render_mesh
from glid_nb.imaging.read import ImageSource, as_rgba8, read_image
from glid_nb.imaging.trace import Tracing

RGB = tuple[int, int, int]
Background = RGB | ArrayLike | None
"""A colour, a picture of the same place as the deformed one, or None for transparent."""
Backdrop = RGB | NDArray[np.uint8] | None
"""A background that `check_background` has read: a picture is (h, w, 4) RGBA."""

WHITE: RGB = (255, 255, 255)

# The hole is filled in a scaled picture, so that the time has a limit.
# _MOST_PIXELS: of the scaled picture.
# _MOST_UNKNOWNS: of its hole when the smooth part of the colours is solved for.
_MOST_PIXELS, _MOST_UNKNOWNS = 600_000, 20_000
_ROOM = 0.006  # around the shape, which has a blurred rim, relative to the picture's longer side
# Relative to the longer side: the blur that separates smooth colours from texture, and the distance
# from the border up to which the hole has texture.
_SMOOTH, _REACH = 0.008, 0.06
_CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])


def filled_in(image: ImageSource, tracing: Tracing, cage: Cage | None = None) -> NDArray[np.uint8]:
    """The picture without the traced shape: (h, w, 4) RGBA, with the hole filled in.

    Smooth colours continue into the hole by Laplace's equation. Texture is mirrored at the hole's
    border and fades away from there. The arguments are those of `cut_out`. Raises a TraceError for
    a picture with transparency of its own, which has nothing behind its shape.
    """
    pixels = as_rgba8(read_image(image))
    if (pixels[..., 3] < 255).any():
        what = "the picture is transparent, so nothing of its background is known"
        raise TraceError(f"{what}; choose a colour as background, or none")
    hole = cut_out(pixels, tracing, cage)[..., 3] > 0
    return filled(pixels, hole)


def filled(pixels: NDArray[np.uint8], hole: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """An opaque picture (h, w, 4) with a hole (h, w) filled in from its surroundings."""
    height, width = hole.shape
    scale = min(1.0, math.sqrt(_MOST_PIXELS / hole.size))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    room = 2 * math.ceil(_ROOM * max(size)) + 3
    small_hole = grown(np.array(Image.fromarray(hole).resize(size)), room)
    small = Image.fromarray(pixels[..., :3].copy()).resize(size, Image.Resampling.BOX)
    filling = _filling(np.asarray(small, np.float32) / 255, small_hole)
    coarse = Image.fromarray(np.rint(255 * filling.clip(0, 1)).astype(np.uint8))
    # The old picture fades into the filling over a pixel or two.
    cover = gaussian_filter(255 * small_hole.astype(np.float32), 1).astype(np.uint8)
    cover[small_hole] = 255
    fine = (coarse.resize((width, height), Image.Resampling.BICUBIC), (width, height))
    mask = Image.fromarray(cover).resize(fine[1], Image.Resampling.BILINEAR)
    result = Image.composite(fine[0], Image.fromarray(pixels[..., :3].copy()), mask)
    return read_only(np.asarray(result.convert("RGBA")).copy())


def _filling(rgb: Array, hole: NDArray[np.bool_]) -> Array:
    known = ~hole
    if not known.any():
        return np.broadcast_to(rgb.mean(axis=(0, 1)), rgb.shape)
    sigma = max(1.0, _SMOOTH * max(hole.shape))
    weight = gaussian_filter(known.astype(np.float32), sigma)
    smooth = np.empty_like(rgb)
    for c in range(3):
        total = gaussian_filter(np.where(known, rgb[..., c], 0), sigma)
        smooth[..., c] = total / np.maximum(weight, 1e-6)
    texture = np.where(known[..., None], rgb - smooth, 0)
    smooth[hole] = _membrane(smooth, hole)[hole]
    # A place in the hole takes the texture of its mirror image at the nearest border.
    found: Any = distance_transform_edt(hole, return_indices=True)
    distance, nearest = found
    places = np.indices(hole.shape)
    rows, columns = (
        np.abs(n - 1 - np.abs(n - 1 - np.abs(2 * near - place)))
        for n, near, place in zip(hole.shape, nearest, places, strict=True)
    )
    rows, columns = rows.clip(0, hole.shape[0] - 1), columns.clip(0, hole.shape[1] - 1)
    fade = (1 - distance / (_REACH * max(hole.shape))).clip(0, 1).astype(np.float32)[..., None]
    return np.where(hole[..., None], smooth + fade * texture[rows, columns], rgb)


def _membrane(colours: Array, hole: NDArray[np.bool_]) -> Array:
    """Colours (h, w, 3) that solve Laplace's equation in the hole; those around it stay."""
    scale = min(1.0, math.sqrt(_MOST_UNKNOWNS / np.count_nonzero(hole)))
    height, width = (max(2, round(n * scale)) for n in hole.shape)
    rows, columns = (
        np.minimum(((np.arange(n) + 0.5) * whole / n).astype(int), whole - 1)
        for n, whole in zip((height, width), hole.shape, strict=True)
    )
    small, inner = colours[np.ix_(rows, columns)].copy(), hole[np.ix_(rows, columns)]
    if inner.any() and not inner.all():
        number = np.arange(inner.size).reshape(inner.shape)
        pairs = np.concatenate(
            [
                np.stack([number[:, 1:].ravel(), number[:, :-1].ravel()]),
                np.stack([number[1:].ravel(), number[:-1].ravel()]),
            ],
            axis=1,
        )
        ones = np.ones(pairs.shape[1])
        beside = scipy.sparse.coo_array((ones, tuple(pairs)), (inner.size, inner.size)).tocsr()
        beside = beside + beside.T
        laplacian = (scipy.sparse.diags_array(beside.sum(axis=1)) - beside).tocsr()[inner.ravel()]
        free = inner.ravel()
        right = -(laplacian[:, ~free] @ small[~inner].astype(np.float64))
        small[inner] = scipy.sparse.linalg.spsolve(laplacian[:, free].tocsc(), right)
    size = hole.shape[1], hole.shape[0]
    parts = (
        Image.fromarray(small[..., c].copy()).resize(size, Image.Resampling.BICUBIC)
        for c in range(3)
    )
    return np.stack([np.asarray(part) for part in parts], axis=-1)


def check_background(background: Any) -> Backdrop:
    """A background as an RGB tuple, an RGBA picture or None. Raises an InputError for others."""
    if background is None or np.ndim(background) == 3:
        return None if background is None else as_rgba8(background)
    rgb: Any = {"least": 0, "most": 255, "form": "three whole numbers from 0 to 255"}
    if wanted := unmet(RGB, given := plain(background), rgb):
        wanted = f"it must be {wanted}, a picture or None"
        raise InputError(f"background is {background!r:.60}; {wanted}")
    return given


def drawn_backdrop(background: Backdrop, frame: PixelFrame) -> NDArray[np.uint8] | None:
    """The (h, w, 4) picture of a background in a frame; None if it is transparent."""
    if background is None:
        return None
    if isinstance(background, tuple):
        return np.full((frame.height, frame.width, 4), (*background, 255), np.uint8)
    size = background.shape[1::-1]
    places = _CORNERS * size
    positions = frame.to_pixel(PixelFrame(*size).to_world(places))
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    return render_mesh(background, places, positions, triangles, (frame.width, frame.height))


def over(pixels: NDArray[np.uint8], behind: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    """Pixels (h, w, 4) drawn over a backdrop of the same size."""
    if behind is None:
        return pixels
    picture = Image.fromarray(behind)
    return np.asarray(Image.alpha_composite(picture, Image.fromarray(pixels)))
