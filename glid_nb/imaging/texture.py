"""Filtered texture look-ups: an image pyramid with premultiplied alpha, anisotropic sampling."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._jax import jax, jit, jnp, lax
from glid_nb.imaging.read import as_rgba

_CHUNK = 1 << 15  # points per call of the compiled program; this bounds the memory
_MOST_PROBES = 16  # look-ups along the longer axis of a pixel's footprint
_SHARP = 0.2  # up to this level of detail only the finest pyramid level is used
_MAX_LEVELS = 32
# Smaller pictures and meshes are padded, so that they share one compiled program.
_LEAST_TEXELS = 1 << 16
_LEAST_TRIANGLES = 1 << 12
_ROWS = 256  # rows of a picture that are converted at a time, to bound the memory


@dataclass(frozen=True, eq=False)
class Texture:
    """An image pyramid with premultiplied alpha, 16 bits per channel.

    Level ``l`` holds averages over ``2^l x 2^l`` blocks of pixels. Premultiplication keeps the
    colours of transparent pixels from bleeding into visible ones.

    Attributes
    ----------
    width, height : int
        Size of the picture, pixels.
    texels : (n, 4) uint16 JAX array
        All levels one after the other, each row by row; padded with zeros.
    levels : (l, 3) int32 array
        First texel, width and height of every level.
    """

    width: int
    height: int
    texels: jax.Array = field(repr=False)
    levels: NDArray[np.int32] = field(repr=False)

    @classmethod
    def from_image(cls, image: ArrayLike | Texture) -> Texture:
        """Prepare a picture, as `as_rgba` takes it; a texture stays as it is."""
        if isinstance(image, Texture):
            return image
        pixels = as_rgba(image)
        height, width = pixels.shape[:2]
        sizes = [(width, height)]
        while max(sizes[-1]) > 1:
            sizes.append(((sizes[-1][0] + 1) // 2, (sizes[-1][1] + 1) // 2))
        ends = np.cumsum([w * h for w, h in sizes])
        texels = np.zeros((_bucket(int(ends[-1]), _LEAST_TEXELS), 4), np.uint16)
        pyramid = [
            part.reshape(h, w, 4)
            for part, (w, h) in zip(np.split(texels[: ends[-1]], ends[:-1]), sizes, strict=True)
        ]
        for top in range(0, height, _ROWS):
            pyramid[0][top : top + _ROWS] = _premultiplied(pixels[top : top + _ROWS])
        for finer, coarser in itertools.pairwise(pyramid):
            coarser[:] = _halved(finer)
        levels = np.column_stack([[0, *ends[:-1]], sizes]).astype(np.int32)
        levels.flags.writeable = False
        return cls(width, height, jax.device_put(texels), levels)


def _bucket(n: int, least: int) -> int:
    """``n`` rounded up to one of eight sizes per octave: similar inputs share a program."""
    grain = 1 << max(n.bit_length() - 4, 0)
    return max(-(-n // grain) * grain, least)


def _premultiplied(pixels: NDArray[Any]) -> NDArray[np.uint32]:
    """16-bit colours of 8 or 16-bit RGBA pixels."""
    wide = pixels.astype(np.uint32) * (257 if pixels.dtype == np.uint8 else 1)
    wide[..., :3] = (wide[..., :3] * wide[..., 3:] + 32767) // 65535
    return wide


def _halved(finer: NDArray[np.uint16]) -> NDArray[np.uint32]:
    """Averages over 2 x 2 blocks; an odd last row or column is repeated."""
    height, width = finer.shape[:2]
    if height % 2 or width % 2:
        finer = np.pad(finer, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    total = np.add(finer[::2, ::2], finer[1::2, 1::2], dtype=np.uint32)
    return (total + finer[::2, 1::2] + finer[1::2, ::2] + 2) // 4


def gradients(corners: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
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

    A disc of one output pixel maps to an ellipse in the texture. Up to 16 look-ups along its longer
    axis are averaged, each at the pyramid level of the shorter axis. Colours are interpolated
    between the two nearest levels and within a level by Catmull-Rom cubics, which reproduce an
    undeformed picture. Outside the picture they fade to transparent within one output pixel.

    Parameters
    ----------
    texture : Texture
    positions, texture_corners : (t, 3, 2) arrays
        Corners of the triangles in the output and in the picture, continuous pixels.
    """

    def __init__(
        self,
        texture: Texture,
        positions: NDArray[np.float64],
        texture_corners: NDArray[np.float64],
    ) -> None:
        jacobian = gradients(positions, texture_corners).clip(-1e6, 1e6)
        axes, radii, _ = np.linalg.svd(jacobian)
        longer, shorter = radii.T
        probes = np.ceil(longer / np.maximum(shorter, 1.0) - 0.25).clip(1, _MOST_PROBES)
        step = longer / probes
        # Detail 0 needs one pyramid level, any other two; a scale within 15 % of 1 counts as 1.
        detail = np.log2(np.maximum(step, 1.0))
        softened = np.maximum(detail - _SHARP, 0) / (1 - _SHARP)
        detail = np.where(detail < 1, softened, detail).clip(0, max(len(texture.levels) - 2, 0))
        # The anchor is rounded to single precision first, so that its own place stays exact.
        anchor = positions.mean(axis=1).astype(np.float32).astype(np.float64)
        at_anchor = texture_corners[:, 0] + np.einsum(
            "tka,ta->tk", jacobian, anchor - positions[:, 0]
        )
        maps = (anchor, at_anchor, jacobian.reshape(-1, 4), axes[:, :, 0] * step[:, None])
        table = np.zeros((_bucket(len(positions), _LEAST_TRIANGLES), 12), np.float32)
        table[: len(positions)] = np.column_stack([*maps, probes, detail])
        levels = np.ones((_MAX_LEVELS, 3), np.int32)
        levels[: len(texture.levels)] = texture.levels
        self._n_lookups = (probes * np.where(detail > 0, 2, 1)).astype(np.uint8)
        self._arrays = texture.texels, jnp.asarray(levels), jnp.asarray(table)

    def __call__(
        self, triangle: NDArray[np.integer], x: NDArray[Any], y: NDArray[Any]
    ) -> NDArray[np.float32]:
        """Filtered colours at points of the output.

        Parameters
        ----------
        triangle : (k,) int array
            The triangle each point is seen through.
        x, y : (k,) arrays
            The points, continuous output pixels.

        Returns
        -------
        (k, 4) float32 array, premultiplied RGBA in [0, 1].
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
            points[0, : len(part)], points[1, : len(part)] = x[part], y[part]
            colours = _colours(*self._arrays, index, points, int(n_lookups[part[-1]]))
            result[part] = np.asarray(colours)[: len(part)]
        return result


@jit
def _colours(
    texels: jax.Array,
    levels: jax.Array,
    table: jax.Array,
    triangle: jax.Array,
    points: jax.Array,
    n_lookups: int,
) -> jax.Array:
    """(c, 4) premultiplied colours in single precision, with any JAX configuration."""
    row = table[triangle]
    dx, dy = points[0] - row[:, 0], points[1] - row[:, 1]
    u = row[:, 2] + row[:, 4] * dx + row[:, 5] * dy
    v = row[:, 3] + row[:, 6] * dx + row[:, 7] * dy
    step_u, step_v, probes, detail = row[:, 8], row[:, 9], row[:, 10], row[:, 11]
    base = jnp.floor(detail)
    fraction = detail - base
    levels_used = jnp.where(detail > 0, 2.0, 1.0)

    def lookup(i: jax.Array, total: jax.Array) -> jax.Array:
        number = i.astype(jnp.float32)
        probe = jnp.floor(number / levels_used)
        coarser = number - probe * levels_used
        weight = jnp.where(coarser > 0, fraction, 1 - fraction) / probes
        weight = jnp.where(probe < probes, weight, 0.0)
        level = (base + coarser).astype(jnp.int32)
        offset = probe - (probes - 1) / 2
        scale = jnp.exp2(-(base + coarser))
        s, t = (u + offset * step_u) * scale - 0.5, (v + offset * step_v) * scale - 0.5
        return total + weight[:, None] * _bicubic(texels, levels[level], s, t)

    total = jnp.zeros((points.shape[1], 4), jnp.float32)
    total = lax.fori_loop(0, n_lookups, lookup, total) * np.float32(1 / 65535)
    # Distance from the picture, in output pixels.
    width, height = levels[0, 1].astype(jnp.float32), levels[0, 2].astype(jnp.float32)
    outside = jnp.maximum(jnp.maximum(-u, u - width), jnp.maximum(-v, v - height))
    outside = outside / jnp.maximum(probes * jnp.hypot(step_u, step_v), 1e-6)
    total = total * jnp.clip(1 - outside, 0, 1)[:, None]
    # Cubics overshoot: restore 0 <= colour <= alpha <= 1, keeping the hue where alpha exceeds 1.
    total = total / jnp.maximum(total[:, 3:], 1)
    alpha = jnp.maximum(total[:, 3:], 0)
    return jnp.concatenate([jnp.clip(total[:, :3], 0, alpha), alpha], axis=1)


def _bicubic(texels: jax.Array, level: jax.Array, s: jax.Array, t: jax.Array) -> jax.Array:
    """(c, 4) Catmull-Rom interpolation at (s, t), in texels from the first texel's centre."""
    first, width, height = level[:, :1], level[:, 1:2], level[:, 2:]
    column, across = _neighbours(s[:, None], width)
    row, down = _neighbours(t[:, None], height)
    index = (first + row * width)[:, :, None] + column[:, None, :]
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
