"""The random walker of Grady (2006) on a picture, prepared once and asked again and again."""

from __future__ import annotations

from dataclasses import dataclass

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


@dataclass(frozen=True, eq=False)
class Walker:
    """How readily a walker steps from a pixel to the next, on a picture scaled down.

    Attributes
    ----------
    across
        (h, w - 1) weights of the steps between neighbours in a row.
    down
        (h - 1, w) weights of those between neighbours in a column.
    """

    across: NDArray[np.float64]
    down: NDArray[np.float64]

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
        from scipy.sparse.linalg import splu  # noqa: PLC0415 - slow to import, and seldom needed

        result = (labels == FOREGROUND).astype(np.float64)
        free = labels == 0
        count = np.count_nonzero(free)
        if not count:
            return result
        number = np.full(labels.shape, -1, dtype=np.int32)
        number[free] = np.arange(count)
        total, met = np.zeros(labels.shape), np.zeros(labels.shape)
        pairs = []
        for weight, one, other in (
            (self.across, np.s_[:, :-1], np.s_[:, 1:]),
            (self.down, np.s_[:-1], np.s_[1:]),
        ):
            total[one] += weight
            total[other] += weight
            met[one] += weight * result[other]
            met[other] += weight * result[one]
            both = free[one] & free[other]
            pairs.append((number[one][both], number[other][both], -weight[both]))
        a, b, steps = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
        diagonal = np.arange(count, dtype=np.int32)
        matrix = coo_array(
            (
                np.concatenate([steps, steps, total[free]]),
                (np.concatenate([a, b, diagonal]), np.concatenate([b, a, diagonal])),
            ),
            shape=(count, count),
        ).tocsc()
        # Symmetric and diagonally dominant, so no pivots are looked for. Columns one by one: with
        # SuperLU's usual panels a grid's narrow supernodes take twice as long.
        factor = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            relax=4,
            panel_size=1,
            options={"SymmetricMode": True, "Equil": False},
        )
        result[free] = factor.solve(met[free])
        return np.clip(result, 0, 1, out=result)
