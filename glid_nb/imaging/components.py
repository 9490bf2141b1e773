"""The connected components of a foreground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.options import Point

_LISTED = 50
_MOST = np.iinfo(np.uint16).max - 1  # beyond these, specks of a noisy image, all labelled alike


@dataclass(frozen=True)
class Component:
    """A connected part of the foreground.

    Attributes
    ----------
    rank
        Its place by area, from 0 for the largest.
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

    labels: NDArray[np.uint16]  # (h, w) read-only: 0 in the background, 1 + rank in a component
    areas: NDArray[np.intp]  # (n,) in pixels, descending

    @property
    def n_components(self) -> int:
        """Number of components."""
        return len(self.areas)

    @cached_property
    def largest(self) -> tuple[Component, ...]:
        """The fifty largest, or all if there are fewer."""
        return tuple(map(self._described, range(min(self.n_components, _LISTED))))

    def component(self, rank: int) -> Component:
        """The component of a rank.

        Raises
        ------
        TraceError
            There are not that many.
        """
        if not 0 <= rank < min(self.n_components, _MOST):
            raise TraceError(
                f"component {rank} does not exist: the foreground has {self.n_components} "
                f"{'component' if self.n_components == 1 else 'components'}, counted from 0, the "
                "largest",
                f"The component that was chosen is gone, {self.n_components} "
                f"{'is' if self.n_components == 1 else 'are'} left; choose another",
            )
        return self.largest[rank] if rank < _LISTED else self._described(rank)

    def _described(self, rank: int) -> Component:
        rows, columns = self._slices[rank]
        left = columns.start + int(np.argmax(self.labels[rows.start, columns] == rank + 1))
        bounds = columns.start, rows.start, columns.stop, rows.stop
        return Component(rank, int(self.areas[rank]), bounds, (left + 0.5, rows.start + 0.5))

    @cached_property
    def _slices(self) -> list[tuple[slice, slice]]:
        if self.n_components == 1:  # the usual picture, and faster than find_objects
            return [_bounding_slices(self.labels == 1)]
        return find_objects(self.labels)

    def rank_at(self, point: Point) -> int:
        """Rank of the component around a point (x, y) in pixel coordinates.

        Raises
        ------
        TraceError
            The point lies outside the image or on the background.
        """
        height, width = self.labels.shape
        row, column = PixelFrame(width=width, height=height).index_at(point, "component_at")
        rank = int(self.labels[row, column]) - 1
        if rank < 0:
            raise TraceError(
                f"component_at: the pixel ({point[0]:g}, {point[1]:g}) is background; pick a pixel "
                "of the shape",
                "There is only background at the place that was picked; pick a place on the shape",
            )
        return rank


def _bounding_slices(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    """The rows and columns that hold all of a mask that is not empty."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def find_components(mask: NDArray[np.bool_]) -> Components:
    """Label the components of an (h, w) mask that is not empty."""
    crop = _bounding_slices(mask)
    found, count = label(mask[crop], np.ones((3, 3)))
    areas = np.bincount(found.ravel())[1:]
    order = np.argsort(-areas, kind="stable")
    new = np.zeros(count + 1, dtype=np.uint16)
    new[1 + order] = np.minimum(np.arange(1, count + 1), _MOST + 1)
    labels = np.zeros(mask.shape, dtype=np.uint16)
    labels[crop] = new[found]
    labels.setflags(write=False)
    areas = areas[order]
    areas.setflags(write=False)
    return Components(labels, areas)
