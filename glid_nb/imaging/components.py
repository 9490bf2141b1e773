"""The connected components of a foreground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects
from scipy.ndimage import label as label_pixels

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.options import Point

_LISTED = 50  # components that are described


@dataclass(frozen=True)
class Component:
    """A connected part of the foreground.

    Attributes
    ----------
    rank
        By area, from 0 for the largest.
    area
        Number of pixels.
    bounds
        Bounding box (xmin, ymin, xmax, ymax) in pixel coordinates.
    pixel
        Centre (x, y) of one of its pixels.
    """

    rank: int
    area: int
    bounds: tuple[int, int, int, int]
    pixel: Point


@dataclass(frozen=True, eq=False)
class Components:
    """All components of a foreground, the largest first.

    Pixels that share a side or a corner are connected.
    """

    found: NDArray[np.int32]  # (h, w) labels, 0 in the background
    labels: NDArray[np.intp]  # (n,) the label of each component
    areas: NDArray[np.intp]  # (n,) in pixels, descending
    boxes: list[tuple[slice, slice]]  # (n,) rows and columns, by label

    @property
    def n_components(self) -> int:
        return len(self.areas)

    @cached_property
    def largest(self) -> tuple[Component, ...]:
        """At most fifty."""
        return tuple(map(self._described, range(min(self.n_components, _LISTED))))

    def component(self, rank: int) -> Component:
        """The component of a rank; a TraceError if there is none."""
        if not 0 <= rank < self.n_components:
            raise TraceError(
                f"component {rank} does not exist: the foreground has {self.n_components} "
                f"{'component' if self.n_components == 1 else 'components'}, counted from 0, the "
                "largest",
                f"The component that was chosen is gone, {self.n_components} "
                f"{'is' if self.n_components == 1 else 'are'} left; choose another",
            )
        return self.largest[rank] if rank < _LISTED else self._described(rank)

    def _described(self, rank: int) -> Component:
        rows, columns = self.boxes[self.labels[rank] - 1]
        left = columns.start + int(np.argmax(self.found[rows.start, columns] == self.labels[rank]))
        bounds = columns.start, rows.start, columns.stop, rows.stop
        return Component(rank, int(self.areas[rank]), bounds, (left + 0.5, rows.start + 0.5))

    def rank_at(self, point: Point) -> int:
        """Rank of the component at a point (x, y) in pixel coordinates; a TraceError if none."""
        height, width = self.found.shape
        row, column = PixelFrame(width=width, height=height).index_at(point, "component_at")
        label = self.found[row, column]
        if label == 0:
            raise TraceError(
                f"component_at: the pixel ({point[0]:g}, {point[1]:g}) is background; pick a pixel "
                "of the shape",
                "There is only background at the place that was picked; pick a place on the shape",
            )
        return int(np.flatnonzero(self.labels == label)[0])


def find_components(mask: NDArray[np.bool_]) -> Components:
    """Label the components of an (h, w) mask that is not empty."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)
    found = np.zeros(mask.shape, dtype=np.int32)
    count = label_pixels(mask[box], np.ones((3, 3)), output=found[box])
    areas = np.bincount(found[box].ravel())[1:]
    order = np.argsort(-areas, kind="stable")
    boxes = [box] if count == 1 else find_objects(found)
    return Components(found, order + 1, areas[order], boxes)
