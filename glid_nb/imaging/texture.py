"""Filtered texture look-ups with premultiplied alpha and anisotropic sampling."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._jax import jax, jit, jnp, lax
from glid_nb.imaging.read import as_rgba

_CHUNK = 1 << 12  # points per call of the compiled program: little padding, little memory
_MOST_PROBES = 16  # look-ups along an axis of a pixel's footprint
_MOST_BLUR = 1.5  # by which nearly all of a minified picture may lose resolution
# Smaller pictures and meshes are padded, so that they share one compiled program.
_LEAST_TEXELS = 1 << 16
_LEAST_TRIANGLES = 1 << 12
_ROWS = 256  # rows of a picture that are converted at a time, to bound the memory

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture prepared for drawing: (h, w, 4) with premultiplied alpha, 16 bits per channel.

    Premultiplication keeps the colours of transparent pixels from bleeding into visible ones.
    """

    pixels: NDArray[np.uint16] = field(repr=False)
    _reduced: dict[int, NDArray[np.uint16]] = field(default_factory=dict, repr=False)

    @classmethod
    def from_image(cls, image: ArrayLike | Texture) -> Texture:
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


def _bucket(n: int, least: int) -> int:
    """``n`` rounded up to one of eight sizes per octave: similar inputs share a program."""
    grain = 1 << max(n.bit_length() - 4, 0)
    return max(-(-n // grain) * grain, least)


def gradients(corners: Floats, values: Floats) -> Floats:
    """Slopes along x and y, (t, k, 2), of linear functions on triangles.

    ``values`` (t, 3, k) are the functions' values at the ``corners`` (t, 3, 2). Triangles without
    area get slope 0; they cover no sample.
    """
    e, rise = corners[:, 1:] - corners[:, :1], values[:, 1:] - values[:, :1]
    with np.errstate(over="ignore", invalid="ignore"):
        cofactors = np.stack([e[:, 1, ::-1] * [1, -1], e[:, 0, ::-1] * [-1, 1]], axis=1)
        det = e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]
        inverse = np.divide(1.0, det, out=np.zeros_like(det), where=np.abs(det) > 1e-300)
        slopes = np.einsum("tek,tea,t->tka", rise, cofactors, inverse)
    return np.nan_to_num(slopes, nan=0.0, posinf=0.0, neginf=0.0)


class Sampler:
    """Samples a texture through the triangles of a mesh, with anisotropic filtering.

    A disc of one output pixel maps to an ellipse in the texture. Up to 16 x 16 look-ups along its
    axes are averaged, in a picture that is scaled down first if it is minified nearly everywhere. A
    look-up interpolates by Catmull-Rom cubics, which reproduce an undeformed picture. Outside the
    picture colours fade to transparent within one output pixel.

    ``positions`` and ``places`` (t, 3, 2) are the triangles' corners in the output and in the
    picture, continuous pixels.
    """

    def __init__(self, texture: Texture, positions: Floats, places: Floats) -> None:
        jacobian = gradients(positions, places).clip(-1e6, 1e6)
        axes, radii, _ = np.linalg.svd(jacobian)
        shorter = np.append(radii[:, 1][radii[:, 1] > 0], max(texture.size))
        stretched, typical = np.quantile(shorter, [0.05, 0.5])
        scale = max(1, int(min(_MOST_BLUR * stretched, typical)))
        pixels = texture.reduced(scale)
        jacobian, radii = jacobian / scale, radii / scale
        probes = np.ceil(radii - 0.25).clip(1, _MOST_PROBES)
        steps = axes * (radii / probes)[:, None]
        # The anchor is rounded to single precision first, so that its own place stays exact.
        anchor = positions.mean(axis=1).astype(np.float32).astype(np.float64)
        offset = np.einsum("tka,ta->tk", jacobian, anchor - positions[:, 0])
        maps = (anchor, places[:, 0] / scale + offset, jacobian, steps, probes)
        columns = np.column_stack([part.reshape(len(positions), -1) for part in maps])
        table = np.zeros((_bucket(len(positions), _LEAST_TRIANGLES), 14), np.float32)
        table[: len(positions)] = columns
        n_texels = pixels.shape[0] * pixels.shape[1]
        texels = np.zeros((_bucket(n_texels, _LEAST_TEXELS), 4), np.uint16)
        texels[:n_texels] = pixels.reshape(-1, 4)
        size = np.array(pixels.shape[1::-1], np.int32)
        self._n_lookups = probes.prod(axis=1).astype(np.uint16)
        self._arrays = jnp.asarray(texels), jnp.asarray(size), jnp.asarray(table)

    def __call__(self, triangle: NDArray[np.integer], x: Floats, y: Floats) -> NDArray[np.float32]:
        """(k, 4) premultiplied RGBA in [0, 1] at points of the output.

        ``triangle`` (k,) is the one that each point is seen through; ``x`` and ``y`` are continuous
        output pixels.
        """
        result = np.empty((len(triangle), 4), np.float32)
        n_lookups = self._n_lookups[triangle]
        # Sorted, because all points of a chunk take as many look-ups as its last one.
        order = np.argsort(n_lookups, kind="stable")
        for start in range(0, len(order), _CHUNK):
            part = order[start : start + _CHUNK]
            index = np.zeros(_CHUNK, np.int32)
            points = np.zeros((2, _CHUNK), np.float32)
            index[: len(part)] = triangle[part]
            points[:, : len(part)] = x[part], y[part]
            colours = _colours(*self._arrays, index, points, int(n_lookups[part[-1]]))
            result[part] = np.asarray(colours)[: len(part)]
        return result


@jit
def _colours(
    texels: jax.Array,
    size: jax.Array,
    table: jax.Array,
    triangle: jax.Array,
    points: jax.Array,
    n_lookups: int,
) -> jax.Array:
    """(c, 4) premultiplied colours in single precision, with any JAX configuration."""
    row = table[triangle]
    offset = points.T - row[:, :2]
    place = row[:, 2:4] + row[:, 4:8:2] * offset[:, :1] + row[:, 5:8:2] * offset[:, 1:]
    long, short, probes = row[:, 8:12:2], row[:, 9:12:2], row[:, 12:]
    n_long, n_short = probes[:, :1], probes[:, 1:]

    def lookup(i: jax.Array, total: jax.Array) -> jax.Array:
        along = jnp.floor(i.astype(jnp.float32) / n_short)
        across = i.astype(jnp.float32) - along * n_short
        at = place + (along - (n_long - 1) / 2) * long + (across - (n_short - 1) / 2) * short
        colour = _bicubic(texels, size, at - 0.5)
        return total + jnp.where(along < n_long, colour / (n_long * n_short), 0.0)

    total = jnp.zeros((points.shape[1], 4), jnp.float32)
    total = lax.fori_loop(0, n_lookups, lookup, total) * np.float32(1 / 65535)
    # Distance from the picture, in output pixels.
    outside = jnp.maximum(-place, place - size.astype(jnp.float32)[None]).max(axis=1)
    radius = n_long[:, 0] * jnp.hypot(long[:, 0], long[:, 1])
    total = total * jnp.clip(1 - outside / jnp.maximum(radius, 1e-6), 0, 1)[:, None]
    # Cubics overshoot: restore 0 <= colour <= alpha <= 1, keeping the hue where alpha exceeds 1.
    total = total / jnp.maximum(total[:, 3:], 1)
    alpha = jnp.maximum(total[:, 3:], 0)
    return jnp.concatenate([jnp.clip(total[:, :3], 0, alpha), alpha], axis=1)


def _bicubic(texels: jax.Array, size: jax.Array, at: jax.Array) -> jax.Array:
    """(c, 4) Catmull-Rom interpolation at places (c, 2) in texels from the first one's centre."""
    column, across = _neighbours(at[:, :1], size[0])
    row, down = _neighbours(at[:, 1:], size[1])
    index = (row * size[0])[:, :, None] + column[:, None, :]
    weight = down[:, :, None] * across[:, None, :]
    return jnp.sum(weight[..., None] * texels[index].astype(jnp.float32), axis=(1, 2))


def _neighbours(t: jax.Array, n: jax.Array) -> tuple[jax.Array, jax.Array]:
    """The four of n texels around places t (c, 1), and their weights."""
    middle = jnp.floor(t)
    index = middle.astype(jnp.int32) + jnp.arange(-1, 3, dtype=jnp.int32)[None]
    t = t - middle
    t2, t3 = t * t, t * t * t
    weights = (
        -0.5 * t3 + t2 - 0.5 * t,
        1.5 * t3 - 2.5 * t2 + 1.0,
        -1.5 * t3 + 2.0 * t2 + 0.5 * t,
        0.5 * t3 - 0.5 * t2,
    )
    return jnp.clip(index, 0, n - 1), jnp.concatenate(weights, axis=1)
