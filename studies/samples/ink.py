"""A sheet of paper to draw on: anti-aliased fills, soft shading, outlines of varying weight.

Coverage comes from matplotlib's Agg rasteriser; NumPy composes the layers. Light falls from the
upper left. Shades, highlights and the weight of the outline depend on it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import shapely
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from shapely.geometry.base import BaseGeometry

from studies.samples.bezier import ROUND, moved

LIGHT = (-0.55, 0.84)  # unit vector towards the light

Window: TypeAlias = tuple[slice, slice]
Mask: TypeAlias = NDArray[np.float32]


@dataclass(frozen=True)
class Linear:
    """A colour gradient through `colours` from the point `start` to the point `end`."""

    start: tuple[float, float]
    end: tuple[float, float]
    colours: Sequence[str]

    def __call__(self, x: Mask, y: Mask) -> Mask:
        """Colour at world points: arrays (h, w) -> (h, w, 3)."""
        dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
        t = ((x - self.start[0]) * dx + (y - self.start[1]) * dy) / (dx * dx + dy * dy)
        return _ramp(t, self.colours)


Colour: TypeAlias = str | Linear


def _ramp(t: NDArray[np.floating], colours: Sequence[str]) -> Mask:
    stops = np.linspace(0, 1, len(colours))
    table = np.array([to_rgb(c) for c in colours])
    return np.stack([np.interp(t, stops, c) for c in table.T], axis=-1).astype(np.float32)


class Sheet:
    """A transparent sheet of `width` x `height` pixels, drawn on in world coordinates.

    Fills cover earlier fills. With `within` they only tint: the colour changes inside that shape,
    and the alpha channel stays unchanged, so the silhouette keeps one clean edge.
    """

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self.scale = max(width, height) / 20  # pixels per world unit
        self._rgb = np.zeros((height, width, 3), np.float32)  # premultiplied
        self._alpha = np.zeros((height, width), np.float32)

    def fill(
        self,
        shape: BaseGeometry,
        colour: Colour,
        *,
        opacity: float = 1.0,
        blur: float = 0.0,
        within: BaseGeometry | None = None,
    ) -> None:
        """Paint a shape, its edge softened by a Gaussian of standard deviation `blur` units."""
        window = self._window(shape, 3 * blur)
        if window is None:
            return
        mask = self._coverage(shape, window, blur) * np.float32(opacity)
        if within is not None:
            mask *= self._coverage(within, window)
        self._paint(window, mask, colour, over=within is None)

    def shade(
        self,
        shape: BaseGeometry,
        colour: Colour,
        *,
        depth: float,
        opacity: float,
        towards_light: bool = False,
        within: BaseGeometry | None = None,
    ) -> None:
        """Make a filled shape look round: a soft shadow inside its edge, on the side away from
        light.

        `depth` is the width of the shadow, in units. `towards_light` puts it on the lit side; with
        a pale colour this is a sheen. `within` restricts it to a part of the shape.
        """
        window = self._window(shape, 0)
        if window is None:
            return
        away = depth * (-0.7 if towards_light else 0.7)
        lit = moved(shape, LIGHT[0] * away, LIGHT[1] * away)
        mask = np.float32(opacity) * (1 - self._coverage(lit, window, depth / 2))
        mask *= self._coverage(shape if within is None else within, window)
        self._paint(window, mask, colour, over=False)

    def outline(
        self,
        shape: BaseGeometry,
        colour: Colour,
        width: float,
        *,
        swell: float = 0.45,
        opacity: float = 1.0,
        within: BaseGeometry | None = None,
    ) -> None:
        """Ink the inside edge of a shape; away from the light the line is wider by `swell`.

        Every pixel on the edge is inked too, so that no pale rim remains. The alpha channel does
        not change.
        """
        inset = shape.buffer(-width, quad_segs=ROUND)
        core = moved(inset, LIGHT[0] * width * swell, LIGHT[1] * width * swell)
        line = shape.buffer(1.5 / self.scale, quad_segs=ROUND).difference(core)
        window = self._window(line, 0)
        if window is None:
            return
        mask = self._coverage(line, window) * np.float32(opacity)
        if within is not None:
            mask *= self._coverage(within, window)
        self._paint(window, mask, colour, over=False)

    def image(self, matte: str) -> NDArray[np.uint8]:
        """The drawing as RGBA (h, w, 4), not premultiplied. Transparent pixels have the colour
        `matte`, so that simple resampling does not blacken the outline."""
        alpha = np.clip(self._alpha, 0, 1)[..., None]
        solid = self._rgb / np.maximum(alpha, 1 / 512)
        rgb = np.where(alpha > 1 / 512, solid, np.asarray(to_rgb(matte), np.float32))
        rgba = np.concatenate([rgb, np.where(alpha > 1 / 512, alpha, 0)], axis=-1)
        return np.round(255 * np.clip(rgba, 0, 1)).astype(np.uint8)

    def _window(self, shape: BaseGeometry, margin: float) -> Window | None:
        """Rows and columns of pixels that a shape can touch; None if it is outside the sheet."""
        if shape.is_empty:
            return None
        x0, y0, x1, y1 = shape.bounds
        left = max(0, int(np.floor((x0 - margin) * self.scale + self.width / 2)) - 1)
        right = min(self.width, int(np.ceil((x1 + margin) * self.scale + self.width / 2)) + 1)
        top = max(0, int(np.floor(self.height / 2 - (y1 + margin) * self.scale)) - 1)
        foot = min(self.height, int(np.ceil(self.height / 2 - (y0 - margin) * self.scale)) + 1)
        if left >= right or top >= foot:
            return None
        return slice(top, foot), slice(left, right)

    def _coverage(self, shape: BaseGeometry, window: Window, blur: float = 0.0) -> Mask:
        """(rows, columns) share of each pixel of a window that a shape covers, 0 to 1."""
        pad = int(np.ceil(3 * blur * self.scale))
        rows, columns = window
        top, left = rows.start - pad, columns.start - pad
        high, wide = rows.stop + pad - top, columns.stop + pad - left
        place = (
            Affine2D()
            .scale(self.scale)
            .translate(self.width / 2 - left, high - (self.height / 2 - top))
        )
        agg = RendererAgg(wide, high, 72)
        pen = agg.new_gc()
        pen.set_linewidth(0)
        pen.set_snap(False)
        path = _path(shape)
        if path is not None:
            agg.draw_path(pen, path, place, (0.0, 0.0, 0.0))
        mask = np.asarray(agg.buffer_rgba())[..., 3].astype(np.float32) / np.float32(255)
        if blur > 0:
            mask = gaussian_filter(mask, blur * self.scale, truncate=3.0)
        return mask[pad : high - pad, pad : wide - pad]

    def _paint(self, window: Window, mask: Mask, colour: Colour, *, over: bool) -> None:
        """Paint a colour over the window, or only tint it (alpha stays unchanged)."""
        rows, columns = window
        if isinstance(colour, str):
            paint = np.asarray(to_rgb(colour), np.float32)
        else:
            across = (np.arange(columns.start, columns.stop) + 0.5 - self.width / 2) / self.scale
            down = (self.height / 2 - np.arange(rows.start, rows.stop) - 0.5) / self.scale
            x, y = np.meshgrid(across.astype(np.float32), down.astype(np.float32))
            paint = colour(x, y)
        alpha = self._alpha[window]
        if over:
            self._alpha[window] = alpha = mask + alpha * (1 - mask)
            self._rgb[window] += mask[..., None] * (paint - self._rgb[window])
        else:
            self._rgb[window] += mask[..., None] * (paint * alpha[..., None] - self._rgb[window])


def _path(shape: BaseGeometry) -> Path | None:
    """The polygons of a shape as one compound path; holes have the opposite orientation."""
    rings = []
    for part in shapely.get_parts(shape):
        if part.geom_type == "Polygon" and not part.is_empty:
            oriented = shapely.geometry.polygon.orient(part)
            rings += [oriented.exterior, *oriented.interiors]
    if not rings:
        return None
    return Path.make_compound_path(*(Path(shapely.get_coordinates(r), closed=True) for r in rings))
