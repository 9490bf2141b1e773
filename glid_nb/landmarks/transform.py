"""A transform as scikit-image has them, estimated from landmarks."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._arrays import Array, first_masked, number_pairs
from glid_nb._errors import InputError
from glid_nb.geometry import Domain, place
from glid_nb.harmonic import HarmonicMap, Inverse
from glid_nb.minima import solve
from glid_nb.pose import Pose

_ROOM = 0.25  # around landmarks without a domain, as a share of the longer side of their box


class LandmarkError(InputError):
    """Landmarks do not fit each other or their domain; the message names the landmark."""


@dataclass(frozen=True, eq=False)
class HarmonicTransform:
    """A certified harmonic map with the protocol of scikit-image's geometric transforms.

    Code written for `skimage.transform.ThinPlateSplineTransform` runs with this class: it has
    ``from_estimate``, is called with (k, 2) points, and has ``residuals``; it also has ``inverse``.
    """

    map: HarmonicMap
    """The map; on `glid_nb.Domain.rectangle` in pixels, (x, y) = (column, row)."""

    def __post_init__(self) -> None:
        check_type("map", self.map, HarmonicMap, "such as that of a result", LandmarkError)

    @classmethod
    def from_estimate(cls, src: Any, dst: Any, *, domain: Domain | None = None, **how: Any) -> Self:
        """The map of least distortion that takes the (k, 2) landmarks ``src`` to ``dst``.

        ``domain`` holds ``src``; by default it is their bounding box with room for a quarter of its
        longer side all around. ``how`` goes to `glid_nb.solve`: an energy, options, a callback.
        Landmarks are met closely, not exactly: see :meth:`residuals`. Raises a LandmarkError for
        landmarks that are not pairs, lie outside the domain, or are given as (row, column).
        """
        for name, value in (("src", src), ("dst", dst)):
            _check_unmasked(name, value)
        pairs = "{} must be (k, 2) landmarks"
        given = [
            number_pairs(value, pairs.format(name), LandmarkError)
            for name, value in (("src", src), ("dst", dst))
        ]
        if len(given[0]) != len(given[1]) or not len(given[0]):
            counts = f"{len(given[0])} landmarks src and {len(given[1])} dst"
            raise LandmarkError(f"there are {counts}; give as many of both, at least one")
        for name, points in zip(("src", "dst"), given, strict=True):
            bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
            if bad.size:
                raise LandmarkError(f"{name}[{bad[0]}] is {points[bad[0]]}; it must be finite")
        if domain is None:
            domain = _around(given[0])
        check_type("domain", domain, Domain, "such as Domain.rectangle(image)", LandmarkError)
        outside = np.flatnonzero(~domain.cage.contains(given[0]))
        if outside.size:
            first = given[0][outside[0]]
            message = f"src[{outside[0]}] at {place(first)} lies outside the domain"
            if domain.cage.contains(given[0][:, ::-1]).all():
                message += "; all landmarks lie inside as (column, row), so swap: src[:, ::-1]"
                message += " and dst[:, ::-1]"
            raise LandmarkError(message)
        result = solve(domain, Pose(given[0], given[1]), **how)
        if not isinstance(result.map, HarmonicMap):
            raise LandmarkError("landmarks need a method of harmonic maps, not one on meshes")
        return cls(result.map)

    def __call__(self, coords: Any) -> Array:
        """(k, 2) images; a point outside the domain goes to ``map.inverse.nowhere``, far away."""
        images = np.asarray(self.map(coords, outside="nan"))
        return np.where(np.isnan(images), self.map.inverse.nowhere, images)

    @property
    def inverse(self) -> Inverse:
        """The inverse; `skimage.transform.warp(image, transform.inverse)` applies the transform."""
        return self.map.inverse

    def residuals(self, src: Any, dst: Any) -> Array:
        """(k,) distances of the images of ``src`` from ``dst``."""
        return self.map.residuals(src, dst)


def _check_unmasked(name: str, points: Any) -> None:
    if (masked := first_masked(points)) is not None:
        what = f"{name}[{masked}] is masked, so it has no coordinates"
        raise LandmarkError(f"{what}; leave the landmark out, in src and dst")


def _around(points: Array) -> Domain:
    """A rectangle around points, with the basis of `Domain.rectangle`."""
    low, high = points.min(axis=0), points.max(axis=0)
    room = _ROOM * float((high - low).max()) or 1.0
    return Domain.box(low - room, high + room)
