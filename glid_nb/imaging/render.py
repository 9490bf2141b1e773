"""Warp a picture through a harmonic map."""

from collections.abc import Sequence
from typing import Any, Literal, get_args

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type, plain, unmet
from glid_nb._errors import InputError
from glid_nb.geometry import place
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.backdrop import Background, check_background, drawn_backdrop, over
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.mesh import DeformedMesh, deformed_loops, deformed_mesh
from glid_nb.imaging.progress import Progress
from glid_nb.imaging.rasterise import render_mesh, render_nearest
from glid_nb.imaging.texture import Texture
from glid_nb.pose import Pose

View = Literal["source", "fit"]
Interpolation = Literal["smooth", "nearest"]
_SIZE = {"least": -np.inf, "form": "(width, height) in whole pixels"}

TOLERANCE_PX = 0.25  # straight mesh edges may deviate from the map by this many output pixels
_PIXELS_PER_VERTEX = 500  # output pixels per vertex of the mesh before refinement
_EVEN_VERTICES = 1000, 8000  # least and most of these vertices
_MOST_PIXELS = 1 << 30
MARGIN = 0.04  # room around the shape with view="fit", as a share of the output's sides
_OVERHANG = 2.0  # world units by which a cage may reach beyond its picture because of its offset


class RenderError(InputError):
    """A picture cannot be warped with these arguments; the message says why."""


def render(
    image: ArrayLike | Texture,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    n_vertices: int | None = None,
    view: View = "source",
    pose: Pose | None = None,
    interpolation: Interpolation = "smooth",
    fill: float = 0,
    progress: Progress | None = None,
    background: Background = None,
) -> NDArray[Any]:
    """Warp a picture through a map; (h, w, 4) uint8 RGBA with straight alpha.

    The image is (h, w), (h, w, 3), (h, w, 4) or a Texture. It is the picture from which the map's
    cage was traced, or one of the same aspect ratio; its longer side is 20 world units. The result
    has ``size``, (w, h) pixels, by default the image's own, and is transparent beside the shape.

    The shape of a photograph is all that lies in its cage, with a rim of the old background.
    `cut_out` gives it soft edges instead: ``render(cut_out(image, tracing), map)``. The background
    is a colour, red, green and blue from 0 to 255, or a picture that lies where the image lies,
    such as that of `filled_in`.

    With ``interpolation="nearest"`` the image may be (h, w) or (h, w, c) numbers of any type, such
    as labels. The result has the same type: each pixel takes the value of one pixel of the image,
    or ``fill`` beside the shape. Where the shape overlaps itself, pixels of the value ``fill``
    cover nothing.

    The view "source" shows the rectangle of the image, letter-boxed if ``size`` has another aspect
    ratio. The view "fit" shows all of the deformed shape, with a margin. The depths of a pose
    decide which part is in front where the shape overlaps itself. The mesh has about
    ``n_vertices``, evenly spread. The default number keeps its straight edges within 0.25 output
    pixels of the map.

    A large picture is drawn in tiles, on all cores. ``progress`` is called with the numbers of
    finished and of all tiles. If it returns True, the drawing ends with
    `glid_nb.imaging.progress.Stopped`.

    Raises a RenderError when an argument is out of range, the map's cage does not fit the picture,
    or the map collapses the shape.
    """
    check_type("map", map, HarmonicMap, "for example result.map")
    check_type("pose", pose, Pose | None, "the pose gives the depths")
    if interpolation not in get_args(Interpolation):
        known = ", ".join(get_args(Interpolation))
        raise RenderError(f"unknown interpolation {interpolation!r:.60}; choose one of {known}")
    behind = check_background(background)
    if behind is not None and interpolation == "nearest":
        raise RenderError('with interpolation="nearest" there is no background; use fill')
    source = Texture.from_image(image) if interpolation == "smooth" else _values(image, fill)
    own = source.size if isinstance(source, Texture) else source.shape[1::-1]
    frame = frame_of(PixelFrame(own[0], own[1]), map, size, view)
    mesh = mesh_in(frame, map, pose, n_vertices)
    if isinstance(source, Texture):
        return over(draw_mesh(source, mesh, frame, progress), drawn_backdrop(behind, frame))
    return _moved(source, mesh, frame, fill, progress)


def mesh_in(
    frame: PixelFrame, map: HarmonicMap, pose: Pose | None, n_vertices: int | None = None
) -> DeformedMesh:
    """The mesh that `render` draws in a frame."""
    tolerance = None
    if n_vertices is None:
        tolerance = TOLERANCE_PX * frame.units_per_pixel
        n_vertices = int(np.clip(frame.width * frame.height / _PIXELS_PER_VERTEX, *_EVEN_VERTICES))
    return deformed_mesh(map, n_vertices, tolerance, pose, frame.bounds)


def _moved(
    values: NDArray[Any],
    mesh: DeformedMesh,
    frame: PixelFrame,
    fill: float,
    progress: Progress | None,
) -> NDArray[Any]:
    """Move values (h, w) or (h, w, c) with a deformed mesh whose cage was traced from them."""
    height, width = values.shape[:2]
    places = PixelFrame(width, height).to_pixel(mesh.vertices)
    positions, size = frame.to_pixel(mesh.images), (frame.width, frame.height)
    pixels = values.reshape(height, width, -1)
    where = places, positions, mesh.triangles, size, mesh.heights
    result = render_nearest(pixels, *where, fill, progress)
    return result.reshape(frame.height, frame.width, *values.shape[2:])


def _values(image: ArrayLike | Texture, fill: float) -> NDArray[Any]:
    """The array for interpolation="nearest". Raises a RenderError if the image is no array of
    numbers or cannot hold `fill`."""
    if isinstance(image, Texture):
        what = "a Texture has been prepared for interpolation"
        raise RenderError(f'{what}; for interpolation="nearest" give the array itself')
    if np.ma.is_masked(image):
        raise RenderError("the image has masked values; replace them first, by image.filled(value)")
    try:
        values: NDArray[Any] = np.asarray(image)
    except ValueError as error:  # rows of different lengths
        raise RenderError(f"the image is not an array: {error}") from None
    if values.ndim not in (2, 3) or not values.size or values.dtype.kind not in "biufc":
        wanted = "(h, w) or (h, w, c) numbers, at least one"
        given = f"{values.dtype} of the shape {values.shape}"
        raise RenderError(f"the image must be {wanted}, not {given}")
    try:
        with np.errstate(all="ignore"):
            kept = np.array(fill).astype(values.dtype)
        holds = bool(kept == fill) or (fill != fill and kept != kept)
    except (TypeError, ValueError, OverflowError):
        holds = False
    if not holds:
        raise RenderError(
            f"fill is {fill!r:.60}, which the image's type {values.dtype} cannot hold"
        )
    return values


def frame_of(
    source: PixelFrame,
    map: HarmonicMap | Sequence[HarmonicMap],
    size: tuple[int, int] | None,
    view: View,
) -> PixelFrame:
    """The frame of the picture that `render` draws from a picture with the frame ``source``; with
    several maps, the frame for all of them."""
    maps = [map] if isinstance(map, HarmonicMap) else map
    if view not in get_args(View):
        raise RenderError(f"unknown view {view!r}; choose one of {', '.join(get_args(View))}")
    sides = (source.width, source.height) if size is None else plain(size)
    if wanted := unmet(tuple[int, int], sides, _SIZE):
        raise RenderError(f"size must be {wanted}, not {size!r:.60}")
    width, height = sides
    if min(width, height) < 1 or width * height >= _MOST_PIXELS:
        limits = "a side has at least 1 pixel, and at most 2^30 pixels can be drawn"
        raise RenderError(f"size is {width} x {height} pixels; {limits}")
    for one in maps:
        check_fits(source, one)
    shown, margin = np.reshape(source.bounds, (2, 2)), 0.0
    if view == "fit":
        exterior = np.concatenate([deformed_loops(one)[0] for one in maps])
        shown, margin = np.stack([exterior.min(axis=0), exterior.max(axis=0)]), MARGIN
    if np.ptp(shown, axis=0).min() <= 0:
        raise RenderError("the map collapses the shape to a point or a line; nothing is visible")
    return PixelFrame(width, height).showing(shown, margin)


def share_outside(map: HarmonicMap, frame: PixelFrame) -> float:
    """Share of the deformed shape's area outside a frame, from 0 to 1."""
    mesh = deformed_mesh(map)
    triangles = shapely.polygons(mesh.images[mesh.triangles])
    area = shapely.area(triangles)
    inside = shapely.area(shapely.clip_by_rect(triangles, *frame.bounds))
    return float(np.maximum(area - inside, 0).sum() / area.sum())


def check_fits(frame: PixelFrame, map: HarmonicMap) -> None:
    """Raise a RenderError if the cage was traced from a picture of another aspect ratio."""
    xmin, ymin, xmax, ymax = frame.bounds
    low, high = map.domain.cage.exterior.min(axis=0), map.domain.cage.exterior.max(axis=0)
    beyond = max(xmin - low[0], ymin - low[1], high[0] - xmax, high[1] - ymax)
    if beyond > _OVERHANG:
        raise RenderError(
            f"the map's cage spans {place(low, 4)} to {place(high, 4)} but the picture, "
            f"{frame.width} x {frame.height} pixels, only {place((xmin, ymin), 4)} to "
            f"{place((xmax, ymax), 4)}; take the picture that the cage was traced from"
        )


def draw_mesh(
    texture: Texture, mesh: DeformedMesh, frame: PixelFrame, progress: Progress | None = None
) -> NDArray[np.uint8]:
    """Draw a deformed mesh whose cage was traced from the texture; RGBA pixels."""
    places = PixelFrame(*texture.size).to_pixel(mesh.vertices)
    positions, size = frame.to_pixel(mesh.images), (frame.width, frame.height)
    return render_mesh(texture, places, positions, mesh.triangles, size, mesh.heights, progress)
