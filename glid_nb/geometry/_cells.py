"""A grid over a polygon that tells for most points at once whether they lie inside."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage

_N_CELLS = 1 << 18


class CellGrid:
    """Square cells over a polygon's bounding box: outside, inside, or met by the boundary.

    Cells that the boundary does not meet lie on one side as a whole, and so do all cells that can
    be reached from one of them: one exact test each settles them. Only points in the remaining
    cells need an exact test of their own, a few percent of a million points.
    """

    OUTSIDE, INSIDE, UNDECIDED = 0, 1, 2

    def __init__(self, polygon: shapely.Polygon, margin: float) -> None:
        """`margin`: points this close to the boundary are left undecided as well."""
        xmin, ymin, xmax, ymax = polygon.bounds
        cell = float(np.sqrt((xmax - xmin) * (ymax - ymin) / _N_CELLS)) + 4.0 * margin
        self._cell = cell
        # One more cell all round, so that the outside is in the grid too.
        self._low = np.array([xmin, ymin]) - 1.5 * cell
        extent = np.array([xmax - xmin, ymax - ymin])
        self._shape = tuple((np.ceil(extent / cell) + 3).astype(int))

        state = np.full(self._shape, self.OUTSIDE, dtype=np.uint8)
        state[self._cells_on_boundary(polygon, margin)] = self.UNDECIDED
        labels = np.zeros(self._shape, dtype=np.int32)
        ndimage.label(state != self.UNDECIDED, output=labels)
        if labels.any():
            names, first = np.unique(labels, return_index=True)
            where = np.stack(np.unravel_index(first, self._shape), axis=1)
            centres = self._low + (where + 0.5) * cell
            inside = shapely.contains_xy(polygon, centres[:, 0], centres[:, 1])
            side = np.zeros(labels.max() + 1, dtype=np.uint8)
            side[names] = np.where(inside, self.INSIDE, self.OUTSIDE)
            state = np.where(state == self.UNDECIDED, state, side[labels])
        self._state = state

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.uint8]:
        """State of each of the (n, 2) points, which must lie in the polygon's bounding box."""
        index = self._index(points)
        return self._state[index[:, 0], index[:, 1]]

    def _index(self, points: NDArray[np.float64]) -> NDArray[np.intp]:
        index = ((points - self._low) / self._cell).astype(np.intp)  # truncates; all are positive
        return np.minimum(index, np.array(self._shape) - 1)

    def _cells_on_boundary(
        self, polygon: shapely.Polygon, margin: float
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Every cell within `margin` of the boundary, some of them named repeatedly."""
        xy, ring = shapely.get_coordinates(shapely.get_rings(polygon), return_index=True)
        same = ring[1:] == ring[:-1]
        a, b = xy[:-1][same], xy[1:][same]
        counts = np.ceil(2.0 * np.hypot(*(b - a).T) / self._cell).astype(np.intp) + 1
        edge = np.repeat(np.arange(len(a)), counts)
        step = np.arange(len(edge)) - (np.cumsum(counts) - counts)[edge]
        share = (step + 0.5) / counts[edge]
        samples = a[edge] + (b - a)[edge] * share[:, None]
        # The boundary lies within a quarter cell of the samples, in a box of at most a cell's side:
        # the cells of the box's corners cover it.
        reach = 0.26 * self._cell + margin
        corners = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]]) * reach
        index = self._index((samples[:, None] + corners).reshape(-1, 2))
        return index[:, 0], index[:, 1]
