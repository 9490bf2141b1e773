"""Warp a picture through a harmonic map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.errors import RenderError
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.mesh import DeformedMesh, deformed_mesh
from glid_nb.imaging.rasterise import render_mesh
from glid_nb.imaging.texture import Texture

View = Literal["source", "fit"]

_TOLERANCE_PX = 0.25  # straight mesh edges may stray from the map by this many output pixels
_PIXELS_PER_VERTEX = 500  # output pixels per vertex of the mesh before refinement
_EVEN_VERTICES = 1000, 8000  # least and most of these vertices
_MARGIN = 0.04  # room around the shape with view="fit", as a share of the output's sides
_OVERHANG = 2.0  # world units by which a cage may reach beyond its picture, due to its offset


@dataclass(frozen=True)
class OutputFrame:
    """The similarity transform from world coordinates to the pixels of an output picture.

    Parameters
    ----------
    size : (w, h)
        Pixels.
    pixels_per_unit : float
        Scale, output pixels per world unit.
    centre : (x, y)
        World coordinates at the middle of the picture.
    """

    size: tuple[int, int]
    pixels_per_unit: float
    centre: tuple[float, float]

    def to_pixel(self, world: ArrayLike) -> NDArray[np.float64]:
        """Continuous pixel coordinates of world coordinates; shape (k, 2) in and out."""
        offset = (np.asarray(world, dtype=np.float64) - self.centre) * self.pixels_per_unit
        return np.array(self.size) / 2 + offset * [1, -1]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The rectangle shown, (xmin, ymin, xmax, ymax) in world units."""
        half = np.array(self.size) / (2 * self.pixels_per_unit)
        low, high = self.centre - half, self.centre + half
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])


@dataclass(frozen=True, eq=False)
class Rendering:
    """A warped picture and how it was made.

    Attributes
    ----------
    picture : (h, w, 4) uint8 array
        RGBA, straight alpha.
    frame : OutputFrame
    mesh : DeformedMesh
    outside : float
        Share of the deformed shape's area outside the frame, from 0 to 1.
    error_px : float
        How far the mesh's straight edges stray from the map, output pixels.
    """

    picture: NDArray[np.uint8]
    frame: OutputFrame
    mesh: DeformedMesh
    outside: float
    error_px: float


def render(
    image: ArrayLike | Texture,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    n_vertices: int | None = None,
    view: View = "source",
) -> NDArray[np.uint8]:
    """Warp a picture through a map; see `rendering`, whose ``picture`` this is.

    Returns
    -------
    (h, w, 4) uint8 array
        RGBA with straight alpha, transparent where the deformed shape is not.
    """
    return rendering(image, map, size, n_vertices, view).picture


def rendering(
    image: ArrayLike | Texture,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    n_vertices: int | None = None,
    view: View = "source",
) -> Rendering:
    """Warp a picture through a map.

    Parameters
    ----------
    image : (h, w, 4), (h, w, 3) or (h, w) array, or Texture
        The picture that the map's cage was traced from, or one of the same aspect ratio; its longer
        side is 20 world units.
    map : HarmonicMap
    size : (w, h), optional
        Pixels of the result; by default the image's own.
    n_vertices : int, optional
        About how many vertices the mesh gets, evenly spread. By default it is refined until its
        straight edges stray from the map by less than 0.25 output pixels.
    view : "source" or "fit"
        Show the rectangle of the image, letter-boxed if ``size`` has another aspect ratio; or all
        of the deformed shape, with a margin.

    Raises
    ------
    RenderError
        An argument is out of range, the map's cage does not fit the picture, or the map collapses
        the shape; the message says which.
    """
    if view not in get_args(View):
        raise RenderError(f"unknown view {view!r}; choose one of {', '.join(get_args(View))}")
    texture = image if isinstance(image, Texture) else Texture.from_image(image)
    source = PixelFrame(texture.width, texture.height)
    width, height = (texture.width, texture.height) if size is None else size
    if min(width, height) < 1:
        raise RenderError(f"size is {width} x {height} pixels; both sides must be at least 1")

    _check_fits(source, map)
    xmin, ymin, xmax, ymax = source.bounds
    margin = 0.0
    if view == "fit":
        outline = map(outline_points(map))
        (xmin, ymin), (xmax, ymax) = outline.min(axis=0), outline.max(axis=0)
        margin = _MARGIN
    if xmax <= xmin or ymax <= ymin:
        raise RenderError(
            "the map collapses the shape to a point or a line; there is nothing to show"
        )
    scale = float(min(width / (xmax - xmin), height / (ymax - ymin))) * (1 - 2 * margin)
    centre = float(xmin + xmax) / 2, float(ymin + ymax) / 2
    frame = OutputFrame((int(width), int(height)), scale, centre)

    if n_vertices is None:
        even = int(np.clip(width * height / _PIXELS_PER_VERTEX, *_EVEN_VERTICES))
        mesh = deformed_mesh(map, even, _TOLERANCE_PX / scale)
    else:
        mesh = deformed_mesh(map, n_vertices)
    picture = draw_mesh(texture, mesh, frame)
    return Rendering(picture, frame, mesh, _share_outside(mesh, frame), mesh.error * scale)


def _check_fits(frame: PixelFrame, map: HarmonicMap) -> None:
    """Raise a RenderError if the cage was traced from a picture of another aspect ratio."""
    xmin, ymin, xmax, ymax = frame.bounds
    low, high = map.domain.cage.exterior.min(axis=0), map.domain.cage.exterior.max(axis=0)
    beyond = max(xmin - low[0], ymin - low[1], high[0] - xmax, high[1] - ymax)
    if beyond > _OVERHANG:
        raise RenderError(
            f"the map's cage spans ({low[0]:.4g}, {low[1]:.4g}) to ({high[0]:.4g}, {high[1]:.4g}) "
            f"but the picture, {frame.width} x {frame.height} pixels, only ({xmin:.4g}, "
            f"{ymin:.4g}) to ({xmax:.4g}, {ymax:.4g}); take the picture that the cage was traced "
            "from"
        )


def draw_mesh(
    texture: ArrayLike | Texture,
    mesh: DeformedMesh,
    frame: OutputFrame,
    places: NDArray[np.float64] | None = None,
) -> NDArray[np.uint8]:
    """The RGBA pixels of a textured mesh.

    ``places`` (v, 2) are the vertices in the texture, pixels; by default their undeformed positions
    in the picture that the cage was traced from.
    """
    texture = texture if isinstance(texture, Texture) else Texture.from_image(texture)
    if places is None:
        places = PixelFrame(texture.width, texture.height).to_pixel(mesh.vertices)
    positions = frame.to_pixel(mesh.images)
    return render_mesh(texture, places, positions, mesh.triangles, frame.size, mesh.heights)


def outline_points(map: HarmonicMap) -> NDArray[np.float64]:
    """Points on the exterior loop, dense enough to bound the deformed shape."""
    return along_loop(map.domain.cage.exterior, 16)


def along_loop(loop: NDArray[np.float64], per_edge: int) -> NDArray[np.float64]:
    """(n * per_edge, 2) points along a polygon (n, 2), evenly spread on each edge."""
    t = np.linspace(0, 1, per_edge, endpoint=False)[:, None]
    return (loop[:, None] + t * (np.roll(loop, -1, axis=0) - loop)[:, None]).reshape(-1, 2)


def _share_outside(mesh: DeformedMesh, frame: OutputFrame) -> float:
    corners = mesh.images[mesh.triangles]
    e = corners[:, 1:] - corners[:, :1]
    area = np.abs(e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]) / 2
    low, high = corners.min(axis=1), corners.max(axis=1)
    xmin, ymin, xmax, ymax = frame.bounds
    out = ((high <= [xmin, ymin]) | (low >= [xmax, ymax])).any(axis=1)
    cut = ~out & ((low < [xmin, ymin]) | (high > [xmax, ymax])).any(axis=1)
    lost = area[out].sum()
    if cut.any():
        rings = np.concatenate([corners[cut], corners[cut][:, :1]], axis=1)
        kept = shapely.area(shapely.clip_by_rect(shapely.polygons(rings), xmin, ymin, xmax, ymax))
        lost += np.maximum(area[cut] - kept, 0).sum()
    return float(lost / area.sum()) if area.sum() > 0 else 0.0
