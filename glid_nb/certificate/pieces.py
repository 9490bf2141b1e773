"""Proving linear pieces of motion at every instant.

Let ``f_t = (1 - t) f_0 + t f_1``. On a panel and for a unit vector ``u`` the function
``g(t) = Re(conj(u) f_z) - |f_zbar|`` is concave in ``t``: affine minus convex. So the lesser of its
bounds at two times bounds it, and ``sigma_2 >= g``, at every time between them. ``kappa Re(conj(u)
f_z) - |f_zbar|`` is concave as well, which bounds k, and ``sigma_1`` is convex. The boundary times
[0, 1] is cut into boxes, panels times intervals of time, that are halved either way until a ``u``
serves on each. On the interpolants a panel's map at time ``t`` is the mean of those of its ends, as
are the bounds of their remainders, so time is halved without evaluating a map.

``f_z`` then has no zero on the boundary at any time. Its winding numbers do not change, and where
they add up to 0 at one time Theorem 4.2 holds at all times.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import in_chunks
from glid_nb.certificate import rounding
from glid_nb.certificate.certify import Known, end_values, to_split
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.panels import EndValues, PanelBounds, modulus
from glid_nb.certificate.paper import beside, jumps, turning
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.harmonic.cauchy import Singularities

_GROUP = 8  # pieces whose maps are evaluated together
_BOX = 64  # numbers of a box, so that chunks of boxes stay in the cache
_MAX_ROUNDS = 60
_MOST_AT_ONCE = 512  # boxes halved in a round, the earliest first
_LOOSE = 0.02
# For tight bounds no more boxes are made than this many for each panel.
_MOST_PER_PANEL = 4
_AHEAD = 4  # halvings
_SHORTEST = 2.0**-12  # time, of a piece
_DIRECTIONS = np.linspace(0, 1, 9)


@dataclass(frozen=True)
class PieceCertificate:
    """What is proved of ``(1 - t) f_0 + t f_1`` on the boundary for every ``t`` in [0, 1]."""

    certified: bool
    """Whether ``|f_z| > |f_zbar|`` is proved at every time."""
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    until: float
    """It is proved at all times before this one; 1 where certified."""
    place: complex
    """The middle of the panel where the proof fails first, or else where sigma_2 is least."""
    boxes: int
    """Panels times intervals of time."""


def certify_pieces(
    maps: Sequence[HarmonicMap], tightness: float = 0.05
) -> tuple[PieceCertificate, ...]:
    """Prove the linear motion from each map of one domain to the next, or say how far that goes.

    Boxes on which the proof fails are halved, and those whose bounds are further than the relative
    ``tightness`` from values that are attained.
    """
    count = len(maps) - 1
    return tuple(
        _prove(grid, piece, tightness)
        for first in range(0, count, _GROUP)
        for grid in [_Grid(maps[first : first + _GROUP + 1])]
        for piece in range(min(_GROUP, count - first))
    )


class _Values(NamedTuple):
    """Maps on panels: (p, ...) arrays."""

    ends: Array
    """(p, 4, k, 2): EndValues of ``f_z`` and ``conj(f_zbar)`` of each map."""
    errors: Array
    """(p, 2, k, 2): their remainders, and bounds on the errors at the ends."""


class _Boxes(NamedTuple):
    """Panels times intervals of time: (b,) arrays."""

    panel: Array
    begin: Array
    end: Array


class _Grid:
    """Panels and halves of panels, with the values of a group of maps."""

    def __init__(self, maps: Sequence[HarmonicMap]) -> None:
        basis, domain = basis_of(maps[0].domain), maps[0].domain
        rows = np.stack([basis.pad(c) for map in maps for c in (map.phi, map.psi)])
        panels = graded_panels(domain)
        self.start, self.end, self.roots = panels.start, panels.end, len(panels)
        self.first_half = np.full(len(panels), -1)
        self.depth = np.zeros(len(panels))
        self._fixed, self._columns = (rows, basis.singularities), basis.n_columns
        self.values: _Values = in_chunks(
            _values, self._columns, (self.start, self.end), *self._fixed
        )

    def _evaluated(self, start: Array, end: Array) -> _Values:
        return in_chunks(_values, self._columns, (start, end), *self._fixed)

    @property
    def middle(self) -> Array:
        return (self.start + self.end) / 2

    def halves(self, panel: Array) -> tuple[Array, Array]:
        """The indices of the halves of panels, which are added where they are new."""
        new = np.unique(panel[self.first_half[panel] < 0])
        if new.size:
            start, middle, end = self.start[new], self.middle[new], self.end[new]
            self.first_half[new] = len(self.start) + 2 * np.arange(len(new))
            starts = np.stack([start, middle], axis=1).ravel()
            ends = np.stack([middle, end], axis=1).ravel()
            self.start, self.end = np.append(self.start, starts), np.append(self.end, ends)
            self.first_half = np.append(self.first_half, np.full(len(starts), -1))
            self.depth = np.append(self.depth, np.repeat(self.depth[new] + 1, 2))
            pairs = zip(self.values, self._evaluated(starts, ends), strict=True)
            self.values = _Values(*(np.concatenate(pair) for pair in pairs))
        return self.first_half[panel], self.first_half[panel] + 1

    def bounds(self, boxes: _Boxes, piece: int) -> _KnownBoxes:
        """What is proved on each box of a piece."""
        own = slice(piece, piece + 2)
        ends, errors = (a[boxes.panel, :, own] for a in self.values)
        most = np.abs(ends).max(axis=(1, 2))
        errors[:, 0] += 2 * rounding.BERNSTEIN * most[:, None]  # of the means, and the slopes
        sides = [
            tuple(a[:, :, 0] + t[:, None, None] * (a[:, :, 1] - a[:, :, 0]) for a in (ends, errors))
            for t in (boxes.begin, boxes.end)
        ]
        return in_chunks(_bounds, _BOX, (*sides[0], *sides[1]))


class _KnownBoxes(NamedTuple):
    known: Known
    sigma2_begin: Array
    """The least seen at the box's ends when it begins."""
    sigma2_end: Array
    sigma2_along: Array
    """The same with ``Re(conj(u) f_z)`` for ``|f_z|``, at either time."""
    k_along: Array

    @property
    def rather_in_time(self) -> Array:
        """(b,) bool: a common ``u`` costs more than the panel's length, in what is worse."""
        known = self.known
        of_sigma2 = 2 * self.sigma2_along < known.sigma2_seen + known.bounds.sigma2_lower
        of_k = 2 * self.k_along > known.k_seen + known.bounds.k_upper
        k_is_loose = known.bounds.k_upper - known.k_seen > _LOOSE * known.k_seen
        sigma2_is_loose = known.sigma2_seen - known.bounds.sigma2_lower > _LOOSE * known.sigma2_seen
        chosen = np.where(k_is_loose & ~sigma2_is_loose, of_k, of_sigma2)
        return np.where(np.isfinite(known.bounds.sigma2_lower), chosen, self.sigma2_along <= 0)


def _prove(grid: _Grid, piece: int, tightness: float) -> PieceCertificate:
    panels = np.arange(grid.roots)
    boxes = _Boxes(panels, np.zeros(len(panels)), np.ones(len(panels)))
    state = grid.bounds(boxes, piece)
    for _ in range(_MAX_ROUNDS):
        in_time, in_space = _chosen(grid, boxes, state, tightness)
        if not (in_time | in_space).any():
            break
        new = _halved(grid, boxes, in_time, in_space)
        kept = ~(in_time | in_space)
        fresh = grid.bounds(new, piece)
        boxes = _Boxes(*(np.append(a[kept], b) for a, b in zip(boxes, new, strict=True)))
        state = _joined(state, kept, fresh)
    bounds = state.known.bounds
    unproved = ~np.asarray(bounds.injective)
    until = float(boxes.begin[unproved].min(initial=1))
    first = unproved & (boxes.begin == until) if unproved.any() else np.ones_like(unproved)
    least = np.where(first, np.minimum(state.sigma2_begin, bounds.sigma2_lower), np.inf)
    return PieceCertificate(
        not unproved.any(),
        float(bounds.sigma2_lower.min()),
        float(bounds.sigma1_upper.max()),
        float(bounds.k_upper.max()),
        until,
        complex(grid.middle[boxes.panel[int(np.argmin(least))]]),
        len(unproved),
    )


def _chosen(
    grid: _Grid, boxes: _Boxes, state: _KnownBoxes, tightness: float
) -> tuple[Array, Array]:
    """Which boxes to halve in time, and which in space."""
    known = state.known
    injective = np.asarray(known.bounds.injective)
    least = 4 * known.slack
    good_begin, good_end = state.sigma2_begin > least, state.sigma2_end > least
    failed = ~injective & good_begin
    wanted = failed
    if len(boxes.panel) < _MOST_PER_PANEL * grid.roots:
        wanted = wanted | (to_split(known, tightness) & injective)
    folded = [
        np.where(seen <= -2 * known.slack, time, np.inf)
        for seen, time in ((state.sigma2_begin, boxes.begin), (state.sigma2_end, boxes.end))
    ]
    fold = min(times.min() for times in folded)
    if np.isfinite(fold):
        wanted = failed & (boxes.begin < fold)
    if wanted.sum() > _MOST_AT_ONCE:
        latest = np.partition(boxes.begin[wanted], _MOST_AT_ONCE - 1)[_MOST_AT_ONCE - 1]
        wanted &= boxes.begin <= latest
        wanted &= np.cumsum(wanted) <= 2 * _MOST_AT_ONCE
    divisible = boxes.end - boxes.begin > _SHORTEST
    # A short panel is halved no further before the box is short in time too: a map that folds at
    # the end does so at any length.
    short = failed & (grid.depth[boxes.panel] > _AHEAD - np.log2(boxes.end - boxes.begin))
    in_time = wanted & divisible & (~good_end | short | state.rather_in_time)
    middle, start, end = (a[boxes.panel] for a in (grid.middle, grid.start, grid.end))
    in_space = wanted & ~in_time & good_end & (middle != start) & (middle != end)
    return in_time, in_space


def _halved(grid: _Grid, boxes: _Boxes, in_time: Array, in_space: Array) -> _Boxes:
    panel, begin, end = (a[in_time] for a in boxes)
    middle = (begin + end) / 2
    halves = grid.halves(boxes.panel[in_space])
    return _Boxes(
        np.concatenate([panel, panel, *halves]),
        np.concatenate([begin, middle, boxes.begin[in_space], boxes.begin[in_space]]),
        np.concatenate([middle, end, boxes.end[in_space], boxes.end[in_space]]),
    )


def _joined(state: Any, kept: Array, fresh: Any) -> Any:
    """The kept rows, then the new ones, of named tuples of arrays."""
    if isinstance(state, tuple):
        parts = zip(state, fresh, strict=True)
        return type(state)(*(_joined(a, kept, b) for a, b in parts))
    return np.concatenate([state[kept], fresh])


def _values(start: Any, end: Any, coefficients: Any, singularities: Singularities) -> _Values:
    ends, slack = end_values(start, end, coefficients, singularities)
    slack = slack + _coefficient_rounding(start, end, coefficients, singularities)
    remainder = Hermite.on(start, end, singularities).remainder(coefficients, singularities)
    shift = jumps(coefficients, singularities) @ beside(start, end, singularities).T
    shape = (-1, coefficients.shape[0] // 2, 2)

    def by_map(rows: Any) -> Any:
        return np.stack([row.T.reshape(shape) for row in rows], axis=1)

    return _Values(by_map(ends), by_map([remainder + slack, slack + shift]))


def _coefficient_rounding(
    start: Any, end: Any, coefficients: Any, singularities: Singularities
) -> Any:
    """What rounding the coefficients of a map between two others changes: (p,).

    ``a + t (b - a)`` is off by less than 8 roundoffs of the larger.
    """
    vertices, following, _, _ = singularities
    m, size = vertices.shape[0], modulus(coefficients).max(axis=0)
    edges = (size[:m] + size[following]) / modulus(vertices[following] - vertices)
    off = 8 * rounding.UPWARD * rounding.UNIT_ROUNDOFF * np.concatenate([edges, size[m:]])
    z = np.concatenate([start, end])
    first, second = (
        np.split(np.abs(by_edges(z, singularities)) @ off, 2)
        for by_edges in (cauchy.first_by_edges, cauchy.second_by_edges)
    )
    return np.maximum(*first) + modulus(end - start) * np.maximum(*second)


def _bounds(ends: Any, errors: Any, ends_after: Any, errors_after: Any) -> _KnownBoxes:
    sides = [
        (
            *(EndValues(*(values[:, i, k] for i in range(4))) for k in (0, 1)),
            error[:, 0].T,
            error[:, 1].sum(axis=1),
        )
        for values, error in ((ends, errors), (ends_after, errors_after))
    ]
    corners = [(f, g) for fz, fzb, *_ in sides for f, g in zip(fz[:2], fzb[:2], strict=True)]
    u = _common_direction(corners)
    proved = [Hermite.bounds(fz, fzb, remainder, u) for fz, fzb, remainder, _ in sides]
    known = proved[0].turning_known & proved[1].turning_known
    sigma2 = np.minimum(proved[0].sigma2_lower, proved[1].sigma2_lower)
    sigma2 = np.where(known & (sigma2 > -np.inf), sigma2, -np.inf)
    bounds = PanelBounds(
        sigma2,
        np.maximum(proved[0].sigma1_upper, proved[1].sigma1_upper),
        np.where(known, np.maximum(proved[0].k_upper, proved[1].k_upper), np.inf),
        known,
        turning(sides[0][0].start, sides[0][0].end),
    )
    f, g = (modulus(np.stack(values)) for values in zip(*corners, strict=True))
    seen = f - g
    all_seen = Known(
        bounds,
        seen.min(axis=0),
        (f + g).max(axis=0),
        (g / f).max(axis=0),
        f.min(axis=0),
        np.maximum(sides[0][3], sides[1][3]),
    )
    return _KnownBoxes(
        all_seen,
        seen[:2].min(axis=0),
        seen[2:].min(axis=0),
        _along(u, corners),
        (g / np.real(np.conj(u) * np.stack([f for f, _ in corners]))).max(axis=0),
    )


def _common_direction(corners: list[Any]) -> Any:
    """(b,) the unit vector between those of both times for which the least ``g`` is largest."""
    before, after = (
        sum(f / modulus(f) for f, _ in corners[own]) for own in (slice(0, 2), slice(2, 4))
    )
    before, after = before / modulus(before), after / modulus(after)
    blends = [before + float(s) * (after - before) for s in _DIRECTIONS]
    candidates = np.stack([blend / modulus(blend) for blend in blends])
    best = np.argmax(_along(candidates, corners), axis=0)
    return np.take_along_axis(candidates, best[None], axis=0)[0]


def _along(u: Any, corners: list[Any]) -> Any:
    """The least ``Re(conj(u) f_z) - |f_zbar|`` at the corners of each box."""
    values = [np.real(np.conj(u) * f) - modulus(g) for f, g in corners]
    return functools.reduce(np.minimum, values)
