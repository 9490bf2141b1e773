"""The random walker of Grady (2006) on a picture, prepared once and asked again and again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.sparse import coo_array

from glid_nb.imaging.read import as_rgba8

FOREGROUND, BACKGROUND = 1, 2
"""Labels of the pixels at which a walk ends; 0 where it goes on."""

_PIXELS = 40_000  # solved directly in a tenth of a second; the outline is smooth in between
# How much an edge in the picture hinders the walker. scikit-image's default of 130 is for noisy
# pictures; with it the outline of a photograph runs midway between the strokes, off the edges.
_BETA = 1000.0
_LEAST_WEIGHT = 1e-10  # so that every pixel is reached
# A new factor takes as long as twenty steps with one that is known. Whether these will do shows
# early: what is off by more than this after so many of them is off for long.
_MOST_STEPS, _EARLY_STEPS, _FAR = 10, 3, 0.1
_TOLERANCE = 1e-4  # of a probability


@dataclass(frozen=True, eq=False)
class _Factor:
    """Of the equations of the pixels that are ``free``."""

    free: NDArray[np.bool_]
    lu: Any

    def solve(self, right: NDArray[np.float64], free: NDArray[np.bool_]) -> NDArray[np.float64]:
        """For another right side, which is 0 elsewhere; at fewer pixels."""
        result = np.zeros(right.shape)
        result[self.free] = self.lu.solve(right[self.free])
        result *= free
        return result


@dataclass(eq=False)
class Walker:
    """How readily a walker steps from a pixel to the next, on a picture scaled down.

    It remembers what it was asked last: strokes that are added are dealt with in a fraction of the
    time that the first ones take. Not for use by several threads at once.

    Attributes
    ----------
    across
        (h, w - 1) weights of the steps between neighbours in a row.
    down
        (h - 1, w) weights of those between neighbours in a column.
    """

    across: NDArray[np.float64]
    down: NDArray[np.float64]
    _factor: _Factor | None = field(default=None, init=False)
    _last: NDArray[np.float64] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._total = np.zeros(self.shape)
        for weight, one, other in self._steps():
            self._total[one] += weight
            self._total[other] += weight

    @classmethod
    def of(cls, image: NDArray[np.unsignedinteger]) -> Walker:
        """The walker on an (h, w, 4) picture, scaled down to 40,000 pixels."""
        height, width = image.shape[:2]
        scale = min(1.0, np.sqrt(_PIXELS / (height * width)))
        size = max(1, round(width * scale)), max(1, round(height * scale))
        small = Image.fromarray(as_rgba8(image))
        if scale < 1:
            small = small.resize(size, Image.Resampling.BOX)
        data = np.asarray(small, dtype=np.float64) / 255
        data[..., :3] *= data[..., 3:]
        if data[..., 3].min() == data[..., 3].max():  # it would only weaken the colours' weight
            data = data[..., :3]
        spread = max(10 * float(data.std()) * np.sqrt(data.shape[2]), 1e-300)

        def weights(axis: int) -> NDArray[np.float64]:
            squares = np.sum(np.diff(data, axis=axis) ** 2, axis=2)
            return np.exp(-_BETA / spread * squares) + _LEAST_WEIGHT

        return cls(weights(1), weights(0))

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) of the scaled picture."""
        return self.across.shape[0], self.down.shape[1]

    def probability(self, labels: NDArray[np.integer]) -> NDArray[np.float64]:
        """(h, w) probability that a walk from the pixel meets the foreground first."""
        fixed, free = (labels == FOREGROUND).astype(np.float64), labels == 0
        result = self._stepwise(fixed, free)
        if result is None:
            result = self._direct(fixed, free)
        self._last = result
        return np.clip(result, 0, 1)

    def _stepwise(
        self, fixed: NDArray[np.float64], free: NDArray[np.bool_]
    ) -> NDArray[np.float64] | None:
        """By conjugate gradients from the last result, with the known factor; None if it is far.

        Labels that are added take equations away. The factor is of all of them, so that after as
        many steps as labels were added the result is exact; mostly it is close after a few.
        """
        factor, last = self._factor, self._last
        if factor is None or last is None or (free & ~factor.free).any():
            return None
        result = np.where(free, last, fixed)
        residual = -self._laplacian(result) * free
        direction, slope = np.zeros(self.shape), 1.0
        for k in range(_MOST_STEPS):
            step = factor.solve(residual, free)
            error = np.abs(step).max()  # nearly
            if error <= _TOLERANCE:
                # A walk that may end at more pixels visits each one less: this bounds every error.
                error = factor.solve(np.abs(residual), free).max()
                if error <= _TOLERANCE:
                    return result
            if k >= _EARLY_STEPS and error > _FAR:
                return None
            before, slope = slope, float(np.vdot(residual, step))
            direction = step + slope / before * direction
            change = self._laplacian(direction) * free
            length = slope / float(np.vdot(direction, change))
            result += length * direction
            residual -= length * change
        return None

    def _direct(self, fixed: NDArray[np.float64], free: NDArray[np.bool_]) -> NDArray[np.float64]:
        """By a factor of its own, which is kept."""
        from scipy.sparse.linalg import splu  # noqa: PLC0415 - slow to import, and seldom needed

        result = fixed.copy()
        count = np.count_nonzero(free)
        if not count:
            return result
        number = np.full(free.shape, -1, dtype=np.int32)
        number[free] = np.arange(count)
        pairs = []
        for weight, one, other in self._steps():
            both = free[one] & free[other]
            pairs.append((number[one][both], number[other][both], -weight[both]))
        a, b, steps = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
        diagonal = np.arange(count, dtype=np.int32)
        matrix = coo_array(
            (
                np.concatenate([steps, steps, self._total[free]]),
                (np.concatenate([a, b, diagonal]), np.concatenate([b, a, diagonal])),
            ),
            shape=(count, count),
        ).tocsc()
        # Symmetric and diagonally dominant, so no pivots are looked for. Columns one by one: with
        # SuperLU's usual panels a grid's narrow supernodes take twice as long.
        lu = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            relax=4,
            panel_size=1,
            options={"SymmetricMode": True, "Equil": False},
        )
        self._factor = _Factor(free, lu)
        result[free] = lu.solve(-self._laplacian(fixed)[free])
        return result

    def _laplacian(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """What each pixel has more than its neighbours, weighted by the steps to them."""
        result = self._total * values
        for weight, one, other in self._steps():
            result[one] -= weight * values[other]
            result[other] -= weight * values[one]
        return result

    def _steps(self) -> Iterator[tuple[NDArray[np.float64], Any, Any]]:
        """The weights, and the pixels on either side."""
        yield self.across, np.s_[:, :-1], np.s_[:, 1:]
        yield self.down, np.s_[:-1], np.s_[1:]
