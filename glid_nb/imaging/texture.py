"""A picture prepared for filtered look-ups: premultiplied alpha, a pyramid of half sizes."""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._jax import jax, jnp
from glid_nb.imaging.read import as_rgba

# Look-ups are computed in pieces of this many samples: one compiled program, bounded memory.
_CHUNK = 1 << 15

# Points are grouped by the number of look-ups they need, so that few wait for the greediest.
_LOOKUP_CLASSES = (1, 2, 4, 8, 16, 32)

# Up to this level of detail the next coarser pyramid level is left out.
_SHARP = 0.2

_MAX_LEVELS = 32

# Smaller pictures and meshes are padded to this, so that all of them share one program.
_LEAST_TEXELS = 1 << 16
_LEAST_TRIANGLES = 1 << 12

# Rows of the picture that are converted at a time, which bounds the memory of the conversion.
_ROWS = 256


@dataclass(frozen=True, eq=False)
class Texture:
    """An image pyramid with premultiplied alpha, 16 bits per channel.

    Level ``l`` holds averages over ``2^l x 2^l`` blocks of pixels. Colours are multiplied by alpha
    before anything is averaged or interpolated, so the invisible colours of transparent pixels
    never bleed into visible ones.

    Attributes
    ----------
    width, height : int
        Size of the picture, pixels.
    texels : (n, 4) uint16 JAX array
        All levels one after the other, each row by row; the tail up to a round size is zero.
    levels : (l, 3) int32 array
        First texel, width and height of every level.
    """

    width: int
    height: int
    texels: jax.Array = field(repr=False)
    levels: NDArray[np.int32] = field(repr=False)

    @classmethod
    def from_image(cls, image: ArrayLike) -> Texture:
        """Prepare a picture.

        Parameters
        ----------
        image : (h, w, c) or (h, w) array
            Grey, RGB or RGBA with straight (not premultiplied) alpha, as `as_rgba` takes it.

        Raises
        ------
        TraceError
            When it is no picture; the message says why.
        """
        pixels = as_rgba(image)
        height, width = pixels.shape[:2]
        levels = _level_table(width, height)
        n_texels = int(levels[-1, 0] + levels[-1, 1] * levels[-1, 2])
        texels = _aligned_zeros(_bucket(n_texels, _LEAST_TEXELS))
        base = texels[: width * height].reshape(height, width, 4)
        for top in range(0, height, _ROWS):
            base[top : top + _ROWS] = _premultiplied(pixels[top : top + _ROWS])
        for finer, coarser in itertools.pairwise(levels):
            _halve(_level(texels, finer), _level(texels, coarser))
        levels.flags.writeable = False
        return cls(width, height, jax.device_put(texels, may_alias=True), levels)

    def level(self, index: int) -> NDArray[np.uint16]:
        """Level ``index`` of the pyramid, (h, w, 4), premultiplied."""
        return _level(np.asarray(self.texels), self.levels[index])


def _level_table(width: int, height: int) -> NDArray[np.int32]:
    rows, first = [], 0
    while True:
        rows.append((first, width, height))
        if width == height == 1:
            return np.array(rows, np.int32)
        first += width * height
        width, height = (width + 1) // 2, (height + 1) // 2


def _level(texels: NDArray[Any], row: NDArray[Any]) -> NDArray[Any]:
    first, width, height = (int(v) for v in row)
    return texels[first : first + width * height].reshape(height, width, 4)


def _aligned_zeros(n: int) -> NDArray[np.uint16]:
    """(n, 4) array that JAX can use as it stands: it copies what is not aligned to 64 bytes."""
    memory = np.zeros(8 * n + 64, np.uint8)
    start = -memory.ctypes.data % 64
    return memory[start : start + 8 * n].view(np.uint16).reshape(n, 4)


def _bucket(n: int, least: int) -> int:
    """The next of eight sizes per octave, so that inputs of similar size share a program."""
    grain = 1 << max(n.bit_length() - 4, 0)
    return max(-(-n // grain) * grain, least)


def _premultiplied(pixels: NDArray[Any]) -> NDArray[np.uint16]:
    """(r, w, 4) premultiplied 16-bit colours of a few rows of an 8 or 16-bit RGBA picture."""
    if pixels.dtype == np.uint8:
        result = _products()[pixels[:, :, 3:], pixels]
        result[:, :, 3] = pixels[:, :, 3].astype(np.uint16) * 257
        return result
    wide = pixels.astype(np.uint32)
    wide[:, :, :3] = (wide[:, :, :3] * wide[:, :, 3:] + 32767) // 65535
    return wide.astype(np.uint16)


@functools.cache
def _products() -> NDArray[np.uint16]:
    """(256, 256) 16-bit product of an 8-bit alpha and an 8-bit colour."""
    byte = np.arange(256) / 255
    return np.rint(np.multiply.outer(byte, byte) * 65535).astype(np.uint16)


def _halve(finer: NDArray[np.uint16], coarser: NDArray[np.uint16]) -> None:
    """Fill ``coarser`` with averages over 2 x 2 blocks; an odd last row or column is repeated."""
    height, width = finer.shape[:2]
    for top in range(0, height, 2 * _ROWS):
        rows = finer[top : top + 2 * _ROWS]
        if len(rows) % 2 or width % 2:
            rows = np.pad(rows, ((0, len(rows) % 2), (0, width % 2), (0, 0)), mode="edge")
        total = np.full((len(rows) // 2, rows.shape[1] // 2, 4), 2, np.uint32)
        for corner in (rows[::2, ::2], rows[::2, 1::2], rows[1::2, ::2], rows[1::2, 1::2]):
            total += corner
        coarser[top // 2 : top // 2 + len(total)] = total // 4


@dataclass(frozen=True, eq=False)
class Footprints:
    """Per triangle, the affine map from output pixels to texture pixels and how to filter it.

    A disc of one output pixel maps to an ellipse in the texture. Along its longer axis up to
    ``MAX_PROBES`` look-ups are averaged, so that a stretched part is neither blurred across the
    stretch nor left to flicker along it; each look-up takes the pyramid level of the shorter axis.

    Attributes
    ----------
    table : (t, 12) float32 array
        Anchor x, y in the output; its u, v in the texture; du/dx, du/dy, dv/dx, dv/dy; step
        (u, v) between probes; number of probes; level of detail.
    """

    table: NDArray[np.float32]

    MAX_PROBES = 16

    @classmethod
    def between(cls, positions: NDArray[np.float64], texture: NDArray[np.float64]) -> Footprints:
        """Footprints of triangles with corners (t, 3, 2) in the output and in the texture."""
        e, d = positions[:, 1:] - positions[:, :1], texture[:, 1:] - texture[:, :1]
        det = e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]
        # A triangle without area covers no sample, so its footprint is never looked up.
        inverse = np.divide(1.0, det, out=np.zeros_like(det), where=np.abs(det) > 1e-300)
        with np.errstate(over="ignore", invalid="ignore"):
            ux = (d[:, 0, 0] * e[:, 1, 1] - d[:, 1, 0] * e[:, 0, 1]) * inverse
            uy = (d[:, 1, 0] * e[:, 0, 0] - d[:, 0, 0] * e[:, 1, 0]) * inverse
            vx = (d[:, 0, 1] * e[:, 1, 1] - d[:, 1, 1] * e[:, 0, 1]) * inverse
            vy = (d[:, 1, 1] * e[:, 0, 0] - d[:, 0, 1] * e[:, 1, 0]) * inverse
            jacobian = np.stack([ux, uy, vx, vy], axis=1)
        jacobian = np.nan_to_num(jacobian, nan=0.0, posinf=0.0, neginf=0.0).clip(-1e6, 1e6)
        ux, uy, vx, vy = jacobian.T
        # Singular values and the longer axis of the ellipse, from J J^T.
        a, b, c = ux**2 + uy**2, vx**2 + vy**2, ux * vx + uy * vy
        radius = np.hypot((a - b) / 2, c)
        longer = np.sqrt((a + b) / 2 + radius)
        shorter = np.abs(ux * vy - uy * vx) / np.maximum(longer, 1e-30)
        angle = np.arctan2(c, (a - b) / 2) / 2
        probes = np.ceil(longer / np.maximum(shorter, 1.0) - 0.25).clip(1, cls.MAX_PROBES)
        level = np.log2(np.maximum(longer / probes, 1.0))
        step = longer / probes
        # The anchor is rounded first, so that single precision costs nothing at the anchor itself.
        anchor = positions.mean(axis=1).astype(np.float32).astype(np.float64)
        x, y = (anchor - positions[:, 0]).T
        at_anchor = texture[:, 0] + np.stack([ux * x + uy * y, vx * x + vy * y], axis=1)
        axis = (step * np.cos(angle), step * np.sin(angle))
        table = np.column_stack([anchor, at_anchor, jacobian, *axis, probes, level])
        return cls(table.astype(np.float32))


class Sampler:
    """Looks a texture up through the triangles of a mesh.

    Colours are interpolated with Catmull-Rom cubics, which reproduce the picture where it is
    neither turned nor scaled, within the two nearest pyramid levels. Outside of the picture they
    fade to transparent within one output pixel.

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
        footprints = Footprints.between(positions, texture_corners).table
        levels = np.ones((_MAX_LEVELS, 3), np.int32)
        levels[: len(texture.levels)] = texture.levels
        # Detail 0 needs one pyramid level, any other two; a scale within 15 % of 1 counts as 1.
        detail = footprints[:, 11]
        softened = np.maximum(detail - _SHARP, 0) / (1 - _SHARP)
        detail = np.where(detail < 1, softened, detail).clip(0, max(len(texture.levels) - 2, 0))
        footprints[:, 11] = detail
        self._n_lookups = (footprints[:, 10] * np.where(detail > 0, 2, 1)).astype(np.int32)
        self._footprints = footprints
        n_rows = _bucket(len(footprints), _LEAST_TRIANGLES)
        table = np.zeros((n_rows, footprints.shape[1]), np.float32)
        table[: len(footprints)] = footprints
        self._arrays = texture.texels, jnp.asarray(levels), jnp.asarray(table)

    def __call__(
        self, triangle: NDArray[np.int32], x: NDArray[np.float32], y: NDArray[np.float32]
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
        done = 0
        for most in _LOOKUP_CLASSES:
            chosen = np.flatnonzero((n_lookups > done) & (n_lookups <= most))
            for start in range(0, len(chosen), _CHUNK):
                part = chosen[start : start + _CHUNK]
                result[part] = self._chunk(triangle[part], x[part], y[part], most)
            done = most
        return result

    def footprint(
        self, triangle: NDArray[np.int32], points: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Where the triangles' maps take points (k, 2) of the output, and how far a pixel reaches.

        Returns
        -------
        (k, 2) array
            Places in the picture, pixels; also where the point lies outside of the triangle.
        (k, 1) array
            Longer semi-axis of the ellipse that a disc of one output pixel maps to, at least 0.5.
        """
        row = self._footprints[triangle]
        d = points - row[:, :2]
        u = row[:, 2] + row[:, 4] * d[:, 0] + row[:, 5] * d[:, 1]
        v = row[:, 3] + row[:, 6] * d[:, 0] + row[:, 7] * d[:, 1]
        reach = np.maximum(row[:, 10] * np.hypot(row[:, 8], row[:, 9]) / 2, np.float32(0.5))
        return np.stack([u, v], axis=1).astype(np.float32), reach[:, None].astype(np.float32)

    def _chunk(self, triangle: Any, x: Any, y: Any, n_lookups: int) -> NDArray[np.float32]:
        n = len(triangle)
        index = np.zeros(_CHUNK, np.int32)
        points = np.zeros((2, _CHUNK), np.float32)
        index[:n], points[0, :n], points[1, :n] = triangle, x, y
        return np.asarray(_compiled()(*self._arrays, index, points, n_lookups))[:n]


@functools.cache
def _compiled() -> Any:
    return jax.jit(_colours)


def _colours(
    texels: jax.Array,
    levels: jax.Array,
    table: jax.Array,
    triangle: jax.Array,
    points: jax.Array,
    n_lookups: int,
) -> jax.Array:
    """(c, 4) premultiplied colours; single precision whatever the caller's JAX configuration."""
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
    total = jax.lax.fori_loop(0, n_lookups, lookup, total) * np.float32(1 / 65535)
    # Distance by which the point lies outside of the picture, in output pixels.
    width, height = levels[0, 1].astype(jnp.float32), levels[0, 2].astype(jnp.float32)
    outside = jnp.maximum(jnp.maximum(-u, u - width), jnp.maximum(-v, v - height))
    outside = outside / jnp.maximum(probes * jnp.hypot(step_u, step_v), 1e-6)
    total = total * jnp.clip(1 - outside, 0, 1)[:, None]
    # Cubics overshoot: keep 0 <= colour <= alpha <= 1, and the hue where alpha exceeds 1.
    total = total / jnp.maximum(total[:, 3:], 1)
    alpha = jnp.maximum(total[:, 3:], 0)
    return jnp.concatenate([jnp.clip(total[:, :3], 0, alpha), alpha], axis=1)


def _bicubic(texels: jax.Array, level: jax.Array, s: jax.Array, t: jax.Array) -> jax.Array:
    """(c, 4) Catmull-Rom interpolation at (s, t), in texels from the first texel's centre."""
    first, width, height = level[:, 0], level[:, 1], level[:, 2]
    left, top = jnp.floor(s), jnp.floor(t)
    across, down = _catmull_rom(s - left), _catmull_rom(t - top)
    left, top = left.astype(jnp.int32), top.astype(jnp.int32)
    total = jnp.zeros((s.shape[0], 4), jnp.float32)
    for j, weight in enumerate(down):
        start = first + jnp.clip(top + (j - 1), 0, height - 1) * width
        line = jnp.zeros_like(total)
        for i, share in enumerate(across):
            texel = texels[start + jnp.clip(left + (i - 1), 0, width - 1)]
            line = line + share[:, None] * texel.astype(jnp.float32)
        total = total + weight[:, None] * line
    return total


def _catmull_rom(t: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array, jax.Array]:
    """Weights of the four texels around a point at the fraction ``t`` between the middle two."""
    t2, t3 = t * t, t * t * t
    return (
        -0.5 * t3 + t2 - 0.5 * t,
        1.5 * t3 - 2.5 * t2 + 1.0,
        -1.5 * t3 + 2.0 * t2 + 0.5 * t,
        0.5 * t3 - 0.5 * t2,
    )
