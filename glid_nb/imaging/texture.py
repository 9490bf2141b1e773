"""Filtered texture look-ups with premultiplied alpha and anisotropic sampling."""

import itertools
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Self

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.imaging.read import as_rgba

_CHUNK = 1 << 14  # look-ups at a time; their arrays fit in the processor's cache
_MOST_PROBES = 16  # most look-ups along an axis of a pixel's footprint
_MOST_BLUR = 1.5  # factor by which nearly all of a minified picture may lose resolution
_ROWS = 256  # rows of a picture that are converted at a time, to bound the memory

# If a patch has more texels per look-up than this, each look-up fetches its own texels.
_SPARSE = 12
_AROUND = np.arange(-1, 3, dtype=np.int32)[:, np.newaxis]


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture prepared for drawing: (h, w, 4) with premultiplied alpha, 16 bits per channel."""

    pixels: NDArray[np.uint16] = field(repr=False)
    _reduced: dict[int, NDArray[np.uint16]] = field(default_factory=dict, repr=False)

    @classmethod
    def from_image(cls, image: "ArrayLike | Texture") -> "Texture":
        """Prepare a picture of any kind that `as_rgba` accepts. A texture is returned as it is."""
        if isinstance(image, Texture):
            return image
        source = as_rgba(image)
        pixels = np.empty(source.shape, np.uint16)
        factor = np.uint16(257 if source.dtype == np.uint8 else 1)
        for top in range(0, len(source), _ROWS):
            band = pixels[top : top + _ROWS]
            np.multiply(source[top : top + _ROWS], factor, out=band)
            if (band[..., 3] < 65535).any():
                wide = band[..., :3].astype(np.uint32) * band[..., 3:]
                band[..., :3] = (wide + 32767) // 65535
        return cls(pixels)

    @property
    def size(self) -> tuple[int, int]:
        """(w, h) in pixels."""
        return self.pixels.shape[1], self.pixels.shape[0]

    def reduced(self, n: int) -> NDArray[np.uint16]:
        """Means over blocks of n x n pixels. The last row and column are repeated as padding."""
        if n == 1 or n in self._reduced:
            return self._reduced.get(n, self.pixels)
        rest = ((0, -self.size[1] % n), (0, -self.size[0] % n), (0, 0))
        pixels = np.pad(self.pixels, rest, mode="edge")
        blocks = pixels.reshape(pixels.shape[0] // n, n, -1, n, 4)
        means = np.rint(blocks.mean(axis=(1, 3), dtype=np.float32))
        self._reduced[n] = means.astype(np.uint16)  # kept, because each frame of an animation asks
        return self._reduced[n]


def gradients(corners: Floats, values: Floats) -> Floats:
    """Slopes (t, k, 2) of linear functions with values (t, 3, k) at corners; 0 if the triangle has
    no area."""
    e, rise = corners[:, 1:] - corners[:, :1], values[:, 1:] - values[:, :1]
    with np.errstate(over="ignore", invalid="ignore"):
        cofactors = np.stack([e[:, 1, ::-1] * [1, -1], e[:, 0, ::-1] * [-1, 1]], axis=1)
        det = e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]
        inverse = np.divide(1.0, det, out=np.zeros_like(det), where=np.abs(det) > 1e-300)
        slopes = np.einsum("tek,tea,t->tka", rise, cofactors, inverse)
    return np.nan_to_num(slopes, nan=0.0, posinf=0.0, neginf=0.0)


def texels_per_pixel(positions: Floats, places: Floats) -> float:
    """By how much a picture may be scaled down before it is drawn on triangles.

    Their corners (t, 3, 2) are ``positions`` in the output and ``places`` in the picture. With this
    scale, the picture is magnified nearly nowhere.
    """
    radii = np.linalg.svd(gradients(positions, places).clip(-1e6, 1e6), compute_uv=False)
    return _scale_for(radii, np.ptp(places.reshape(-1, 2), axis=0).max())


def _scale_for(radii: Floats, largest: float) -> float:
    """The scale for radii (t, 2), the longer first, of a pixel's ellipses in the picture."""
    shorter = np.append(radii[:, 1][radii[:, 1] > 0], largest)
    stretched, typical = np.quantile(shorter, [0.05, 0.5])
    return float(min(_MOST_BLUR * stretched, typical))


class Sampler:
    """Samples a texture through triangles with corners (t, 3, 2) in the output and in the picture.

    A disc of one output pixel maps to an ellipse in the texture. Up to 16 x 16 look-ups along the
    axes of the ellipse are averaged. If the picture is minified nearly everywhere, it is scaled
    down first. A look-up interpolates by Catmull-Rom cubics, which reproduce an undeformed picture.
    """

    def __init__(self, texture: Texture, positions: Floats, places: Floats) -> None:
        jacobian = gradients(positions, places).clip(-1e6, 1e6)
        axes, radii, _ = np.linalg.svd(jacobian)
        scale = max(1, int(_scale_for(radii, max(texture.size))))
        self._pixels = texture.reduced(scale)
        self._size = np.array(self._pixels.shape[1::-1])
        self._affine = affine(positions, places / scale, jacobian / scale)
        radii = radii / scale
        self._radius = radii[:, 0]
        self._probes = np.ceil(radii - 0.25).clip(1, _MOST_PROBES).astype(int)
        self._n_lookups = self._probes.prod(axis=1)
        self._steps = axes * (radii / self._probes)[:, None]

    def __call__(self, triangle: NDArray[np.integer], x: Floats, y: Floats) -> NDArray[np.float32]:
        """(k, 4) premultiplied RGBA in [0, 1] at points of the output, each in a given triangle."""
        result = np.empty((len(triangle), 4), np.float32)
        if not len(triangle):
            return result
        places = placed(self._affine, triangle, x, y)
        n_lookups = self._n_lookups[triangle]
        lookups = np.cumsum(n_lookups)
        patch = _Patch.around(self._pixels, places, self._radius[triangle].max(), lookups[-1])
        cuts = np.flatnonzero(np.diff(lookups // _CHUNK)) + 1
        for low, high in itertools.pairwise([0, *cuts.tolist(), len(triangle)]):
            chunk = slice(low, high)
            result[chunk] = self._colours(
                patch, triangle[chunk], places[:, chunk], n_lookups[chunk]
            )
        return result

    def _colours(self, patch: "_Patch", triangle: Array, places: Floats, n_lookups: Array) -> Array:
        if n_lookups.max() == 1:
            total = patch.bicubic(places[0] - 0.5, places[1] - 0.5)
            total /= np.float32(65535)
        else:
            point = np.repeat(np.arange(len(triangle)), n_lookups)
            first, seen = np.cumsum(n_lookups) - n_lookups, triangle[point]
            number = np.divmod(np.arange(len(point)) - first[point], self._probes[seen, 1])
            share = np.stack(number, axis=1) - (self._probes[seen] - 1) / 2
            at = places[:, point] + _times(self._steps[seen], share).T - 0.5
            total = np.add.reduceat(patch.bicubic(*at), first)
            total /= (65535 * n_lookups[:, None]).astype(np.float32)
        self._fade(total, triangle, places)
        # Cubics overshoot. Restore 0 <= colour <= alpha <= 1; where alpha exceeds 1, keep the hue.
        total /= np.maximum(total[:, 3:], 1)
        alpha = total[:, 3:]
        np.maximum(alpha, 0, out=alpha)
        np.clip(total[:, :3], 0, alpha, out=total[:, :3])
        return total

    def _fade(self, total: Array, triangle: Array, places: Floats) -> None:
        """Fade out colours beyond the picture, by their distance from it in output pixels."""
        (x, y), (width, height) = places, self._size
        if x.min() >= 0 and y.min() >= 0 and x.max() <= width and y.max() <= height:
            return
        outside = np.maximum(np.maximum(-x, x - width), np.maximum(-y, y - height))
        total *= (1 - outside / np.maximum(self._radius[triangle], 1e-6)).clip(0, 1)[:, None]


class _Patch(NamedTuple):
    """The part of a picture that look-ups need."""

    texels: NDArray[Any]
    """(m, 4) texels: the part as float32, or the whole picture if look-ups are few and far apart.
    """
    size: tuple[int, int]  # (w, h) of the whole picture
    corner: tuple[int, int]  # (x, y) of the first texel
    width: int

    @classmethod
    def around(
        cls, pixels: NDArray[np.uint16], places: Floats, radius: float, n_lookups: int
    ) -> Self:
        height, width, _ = pixels.shape
        room = radius + 3  # for the ellipse and the neighbours of a place
        low, high = places.min(axis=1) - room, places.max(axis=1) + room
        x0, y0 = (int(v) for v in np.clip(low, 0, (width - 1, height - 1)))
        x1, y1 = (int(v) + 1 for v in np.clip(high, 0, (width - 1, height - 1)))
        if (x1 - x0) * (y1 - y0) > _SPARSE * n_lookups:
            return cls(pixels.reshape(-1, 4), (width, height), (0, 0), width)
        part = pixels[y0:y1, x0:x1].astype(np.float32).reshape(-1, 4)
        return cls(part, (width, height), (x0, y0), x1 - x0)

    def bicubic(self, x: Floats, y: Floats) -> NDArray[np.float32]:
        """(k, 4) Catmull-Rom interpolation at places, in pixels from the first pixel's centre."""
        (column, across), (row, down) = (
            _neighbours(at, n, first)
            for at, n, first in zip((x, y), self.size, self.corner, strict=True)
        )
        row *= self.width
        if self.texels.dtype != np.float32:
            total = np.zeros((len(x), 4), np.float32)
            for i, j in np.ndindex(4, 4):
                total += (down[i] * across[j])[:, None] * self.texels.take(row[i] + column[j], 0)
            return total
        weights = np.empty((len(x), 16), np.float32)
        index = np.empty((len(x), 16), np.int32)
        for i, j in np.ndindex(4, 4):
            np.multiply(down[i], across[j], out=weights[:, 4 * i + j])
            np.add(row[i], column[j], out=index[:, 4 * i + j])
        starts = np.arange(0, 16 * len(x) + 1, 16, dtype=np.int32)
        # A sparse matrix times the texels: the loop over neighbours is SciPy's, in C++.
        entries = weights.ravel(), index.ravel(), starts
        return scipy.sparse.csr_array(entries, shape=(len(x), len(self.texels))) @ self.texels


def affine(positions: Floats, places: Floats, jacobian: Floats) -> Floats:
    """(t, 6) for `placed`: the rows [a, b, c] of maps from (x, y) to (a x + b y + c, ...)."""
    constant = places[:, 0] - _times(jacobian, positions[:, 0])
    return np.concatenate([jacobian, constant[:, :, None]], axis=2).reshape(-1, 6)


def placed(maps: Floats, triangle: NDArray[np.integer], x: Floats, y: Floats) -> Floats:
    """(2, k) places in the picture of points of the output, by the `affine` maps of their
    triangles."""
    a = maps.take(triangle, axis=0)
    return np.stack([a[:, 0] * x + a[:, 1] * y + a[:, 2], a[:, 3] * x + a[:, 4] * y + a[:, 5]])


def _times(matrices: Floats, vectors: Floats) -> Floats:
    return matrices[:, :, 0] * vectors[:, :1] + matrices[:, :, 1] * vectors[:, 1:]


def _neighbours(t: Floats, n: int, first: int) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """(4, k) indices of the four pixels around each place t (k,), and their weights.

    There are n pixels. Indices are counted from the pixel ``first``.
    """
    middle = np.floor(t)
    index = middle.astype(np.int32) + _AROUND
    np.clip(index, 0, n - 1, out=index)
    index -= first
    f = np.subtract(t, middle).astype(np.float32)
    # Catmull-Rom cubics of the place between the middle two pixels, by Horner's scheme.
    weights = np.empty((4, len(t)), np.float32)
    weights[0] = ((1 - 0.5 * f) * f - 0.5) * f
    weights[1] = (1.5 * f - 2.5) * f * f + 1
    weights[2] = ((2 - 1.5 * f) * f + 0.5) * f
    weights[3] = (0.5 * f - 0.5) * f * f
    return index, weights
