"""Filtered texture look-ups with premultiplied alpha and anisotropic sampling."""

import itertools
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.imaging.read import as_rgba

_CHUNK = 1 << 14  # look-ups at a time, whose arrays stay in the cache
_MOST_PROBES = 16  # look-ups along an axis of a pixel's footprint
_MOST_BLUR = 1.5  # by which nearly all of a minified picture may lose resolution
_ROWS = 256  # rows of a picture that are converted at a time, to bound the memory

# Weights of four neighbours by the powers 0 to 3 of the place between the middle two.
_CATMULL_ROM = np.array([[0, -1, 2, -1], [2, 0, -5, 3], [0, 1, 4, -3], [0, 0, -1, 1]]) / 2


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture prepared for drawing: (h, w, 4) with premultiplied alpha, 16 bits per channel."""

    pixels: NDArray[np.uint16] = field(repr=False)
    _reduced: dict[int, NDArray[np.uint16]] = field(default_factory=dict, repr=False)

    @classmethod
    def from_image(cls, image: "ArrayLike | Texture") -> "Texture":
        """Prepare a picture, as `as_rgba` takes it; a texture stays as it is."""
        if isinstance(image, Texture):
            return image
        source = as_rgba(image)
        pixels = np.empty(source.shape, np.uint16)
        for top in range(0, len(source), _ROWS):
            wide = source[top : top + _ROWS].astype(np.uint32)
            wide *= 257 if source.dtype == np.uint8 else 1
            wide[..., :3] = (wide[..., :3] * wide[..., 3:] + 32767) // 65535
            pixels[top : top + _ROWS] = wide
        return cls(pixels)

    @property
    def size(self) -> tuple[int, int]:
        """(w, h) in pixels."""
        return self.pixels.shape[1], self.pixels.shape[0]

    def reduced(self, n: int) -> NDArray[np.uint16]:
        """Averages over blocks of n x n pixels; the last row and column are repeated."""
        if n == 1 or n in self._reduced:
            return self._reduced.get(n, self.pixels)
        rest = ((0, -self.size[1] % n), (0, -self.size[0] % n), (0, 0))
        pixels = np.pad(self.pixels, rest, mode="edge")
        blocks = pixels.reshape(pixels.shape[0] // n, n, -1, n, 4)
        means = np.rint(blocks.mean(axis=(1, 3), dtype=np.float32))
        self._reduced[n] = means.astype(np.uint16)  # of an animation, wanted for every frame
        return self._reduced[n]


def gradients(corners: Floats, values: Floats) -> Floats:
    """Slopes (t, k, 2) of linear functions with values (t, 3, k) at corners; 0 without an area."""
    e, rise = corners[:, 1:] - corners[:, :1], values[:, 1:] - values[:, :1]
    with np.errstate(over="ignore", invalid="ignore"):
        cofactors = np.stack([e[:, 1, ::-1] * [1, -1], e[:, 0, ::-1] * [-1, 1]], axis=1)
        det = e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]
        inverse = np.divide(1.0, det, out=np.zeros_like(det), where=np.abs(det) > 1e-300)
        slopes = np.einsum("tek,tea,t->tka", rise, cofactors, inverse)
    return np.nan_to_num(slopes, nan=0.0, posinf=0.0, neginf=0.0)


class Sampler:
    """Samples a texture through triangles with corners (t, 3, 2) in the output and in the picture.

    A disc of one output pixel maps to an ellipse in the texture. Up to 16 x 16 look-ups along its
    axes are averaged, in a picture that is scaled down first if it is minified nearly everywhere. A
    look-up interpolates by Catmull-Rom cubics, which reproduce an undeformed picture.
    """

    def __init__(self, texture: Texture, positions: Floats, places: Floats) -> None:
        jacobian = gradients(positions, places).clip(-1e6, 1e6)
        axes, radii, _ = np.linalg.svd(jacobian)
        shorter = np.append(radii[:, 1][radii[:, 1] > 0], max(texture.size))
        stretched, typical = np.quantile(shorter, [0.05, 0.5])
        scale = max(1, int(min(_MOST_BLUR * stretched, typical)))
        self._pixels = texture.reduced(scale)
        self._size = np.array(self._pixels.shape[1::-1])
        self._anchor, self._origin = positions[:, 0], places[:, 0] / scale
        self._jacobian, radii = jacobian / scale, radii / scale
        self._radius = radii[:, 0]
        self._probes = np.ceil(radii - 0.25).clip(1, _MOST_PROBES).astype(int)
        self._steps = axes * (radii / self._probes)[:, None]

    def __call__(self, triangle: NDArray[np.integer], x: Floats, y: Floats) -> NDArray[np.float32]:
        """(k, 4) premultiplied RGBA in [0, 1] at points of the output, each seen in a triangle."""
        result = np.empty((len(triangle), 4), np.float32)
        lookups = np.cumsum(self._probes[triangle].prod(axis=1))
        cuts = np.flatnonzero(np.diff(lookups // _CHUNK)) + 1
        for low, high in itertools.pairwise([0, *cuts.tolist(), len(triangle)]):
            chunk = slice(low, high)
            result[chunk] = self._colours(triangle[chunk], np.stack([x[chunk], y[chunk]], axis=1))
        return result

    def _colours(self, triangle: Array, points: Floats) -> Array:
        place = self._origin[triangle]
        place = place + _times(self._jacobian[triangle], points - self._anchor[triangle])
        n_lookups = self._probes[triangle].prod(axis=1)
        point = np.repeat(np.arange(len(points)), n_lookups)
        first, seen = np.cumsum(n_lookups) - n_lookups, triangle[point]
        number = np.divmod(np.arange(len(point)) - first[point], self._probes[seen, 1])
        share = np.stack(number, axis=1) - (self._probes[seen] - 1) / 2
        colours = _bicubic(self._pixels, place[point] + _times(self._steps[seen], share) - 0.5)
        total = np.add.reduceat(colours, first) / (65535 * n_lookups[:, None])
        # Distance from the picture, in output pixels.
        outside = np.maximum(-place, place - self._size).max(axis=1)
        total *= (1 - outside / np.maximum(self._radius[triangle], 1e-6)).clip(0, 1)[:, None]
        # Cubics overshoot: restore 0 <= colour <= alpha <= 1, with the hue where alpha exceeds 1.
        total /= np.maximum(total[:, 3:], 1)
        alpha = np.maximum(total[:, 3:], 0)
        return np.concatenate([np.clip(total[:, :3], 0, alpha), alpha], axis=1)


def _times(matrices: Floats, vectors: Floats) -> Floats:
    return matrices[:, :, 0] * vectors[:, :1] + matrices[:, :, 1] * vectors[:, 1:]


def _bicubic(pixels: NDArray[np.uint16], at: Floats) -> NDArray[np.float32]:
    """(k, 4) Catmull-Rom interpolation at places (k, 2) in pixels from the first one's centre."""
    height, width, _ = pixels.shape
    (column, across), (row, down) = _neighbours(at[:, 0], width), _neighbours(at[:, 1], height)
    texels, total = pixels.reshape(-1, 4), np.zeros((len(at), 4), np.float32)
    for i, j in np.ndindex(4, 4):
        total += (down[i] * across[j])[:, None] * texels.take(row[i] * width + column[j], axis=0)
    return total


def _neighbours(t: Floats, n: int) -> tuple[Array, NDArray[np.float32]]:
    """(4, k) the pixels of n around places t (k,), and their weights."""
    middle = np.floor(t)
    index = middle.astype(np.intp) + np.arange(-1, 3)[:, None]
    powers = (t - middle) ** np.arange(4)[:, None]
    return index.clip(0, n - 1), (_CATMULL_ROM @ powers).astype(np.float32)
