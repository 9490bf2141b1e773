"""Bounded distortion interpolation, projected on the harmonic subspace.

With ``a = f_z`` and ``nu = conj(f_zbar) / f_z`` of the keyframes, ``log a`` and ``nu`` are
holomorphic, and so are their weighted means. So k, which is ``|nu|``, stays below that of the worse
end (Chien, Chen & Weber 2016). The rigid motion is taken out of the maps first and interpolated by
itself. The projection on the basis loses something at the keyframes; it is added back, linearly in
time between them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from scipy.interpolate import CubicSpline

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion.boundary import Boundary, boundary_of
from glid_nb.pose import rigid_motion

# If a map is worse than the worse end by more than this share, tangents are shortened.
EXCESS = 0.01
_LEAST = np.array([1e-9, 0.01])  # least sigma_2 and k that the share refers to
_SHORTER = 0.8
_MOST_STEPS, _ALONE = 12, 3  # after ALONE steps both tangents of a keyframe are shortened
# Periods are closed only if this changes the logarithm of `|f_z|` halfway by less than CLOSES. A
# larger change would lower sigma_2 between keyframes, and maps solved on the way would not help.
CLOSES = 0.3
_PROBES = np.linspace(0, 1, 18)[1:-1]

Coefficients = tuple[Array, Array]  # phi and psi
Maps = Sequence[HarmonicMap]


@dataclass(frozen=True, eq=False)
class Bounded:
    """A smooth curve through keyframes; two keyframes are joined by the plain interpolation.

    Cubic Hermite pieces in ``log f_z``, ``nu`` and the rigid motion. Tangents are shortened where k
    or sigma_2 would be worse than at the worse keyframe.
    """

    boundary: Boundary
    maps: tuple[HarmonicMap, ...]
    times: tuple[float, ...]
    rows: Array
    """(k, 2 s + 2) of the keyframes: ``log f_z`` and ``nu`` at the nodes, then angle and mean of
    the rigid motion ``z -> exp(i angle) z + mean`` that is taken out of them."""
    lost: Array  # (k, 2, n) what the projection loses of phi and psi
    tangents: Array  # (k, 2 s + 2) slopes of the rows
    turns: tuple[int, ...]
    worse: Array  # (k - 1, 2) what maps of each piece are compared with, see `Boundary.worst`
    closes: tuple[bool, ...]  # on which pieces periods are closed, see `Boundary.closed`

    @classmethod
    def through(
        cls, maps: Maps, times: Sequence[float], turns: Sequence[int], closed: bool, worse: Any = ()
    ) -> Self:
        """Through maps of one domain whose ``f_z`` turn alike; ``turns`` are added to the pieces.

        If ``closed``, the last map is the first one again. Maps of a piece are compared with
        ``worse``, by default the worse of the piece's ends.
        """
        boundary = boundary_of(maps[0].domain)
        rows, lost = [], []
        for i, map in enumerate(maps):
            row, missed = _freed(boundary, map, rows[-1:], turns[i - 1] if i else 0)
            rows.append(row)
            lost.append(missed)
        rows = np.stack(rows)
        rough = _tangents(rows, np.asarray(times), closed)
        ends = np.array([boundary.worst(map.phi, map.psi) for map in maps])
        worse = worse if len(worse) else np.maximum(ends[:-1], ends[1:])
        known = tuple(maps), tuple(times), rows, np.stack(lost), rough, tuple(turns), worse
        closes = tuple(_closes(boundary, row) for row in (rows[:-1, :-2] + rows[1:, :-2]) / 2)
        curve = cls(boundary, *known, closes)
        return curve if len(maps) == 2 else curve._shortened(closed)

    def __call__(self, piece: int, s: float) -> Coefficients:
        """Coefficients at the time ``s`` from 0 to 1 between a keyframe and the next."""
        if s in (0, 1):
            at = self.maps[piece + int(s)]
            return at.phi, at.psi
        row = self._row(piece, s)
        first, last = self.lost[piece : piece + 2]
        phi, psi = _fitted(self.boundary, row[:-2], self.closes[piece]) + first + s * (last - first)
        turn = np.exp(1j * row[-2].real)
        return self.boundary.translated(turn * phi, row[-1]), psi / turn

    def laps(self, piece: int) -> int:
        """A bound, at least 1, on how often the whole turns round between two keyframes.

        It assumes the largest speed, that of the control polygon of the angle's cubic.
        """
        _, d, out, into = (float(row[-2].real) for row in self._hermite(piece))
        return 1 + int(max(abs(out), abs(3 * d - out - into), abs(into)) / (2 * np.pi))

    def excess(self, piece: int) -> Array:
        """(2, 2) by which share sigma_2 and k are worse than `worse`, the largest of each half."""
        worst, worse = self.boundary.worst, self.worse[piece]
        within = np.array([worst(*self(piece, s)) for s in _PROBES]).reshape(2, -1, 2)
        return (within.max(axis=1) - worse) / np.maximum(np.abs(worse), _LEAST)

    def _row(self, piece: int, s: float) -> Array:
        """The fields, the angle and the mean by cubic Hermite interpolation."""
        before, d, out, into = self._hermite(piece)
        return before + s * (out + s * (3 * d - 2 * out - into + s * (out + into - 2 * d)))

    def _hermite(self, piece: int) -> tuple[Array, Array, Array, Array]:
        """The first row, the difference to the next, and the slopes at both ends."""
        before, after = self.rows[piece : piece + 2]
        span = self.times[piece + 1] - self.times[piece]
        return before, after - before, span * self.tangents[piece], span * self.tangents[piece + 1]

    def _shortened(self, closed: bool) -> Self:
        """With tangents so short that k and sigma_2 of no piece are worse than at its ends."""
        share, curve = np.ones((len(self.maps), 2)), self
        wild = np.ones((len(self.turns), 2, 2), dtype=bool)  # of each piece, halves, sigma_2 and k
        stale = wild.any(axis=(1, 2))
        for step in range(1, _MOST_STEPS + 1):
            for i in np.flatnonzero(stale).tolist():
                wild[i] = curve.excess(i) > EXCESS
            if not wild.any():
                break
            out, into = wild[:, 0], wild[:, 1]
            at = np.vstack([out, out[:1] & closed]) | np.vstack([into[-1:] & closed, into])
            at |= at.any(axis=1, keepdims=True) & (step > _ALONE)
            stale = (at[1:] | at[:-1]).any(axis=1)
            share[at] *= _SHORTER if step < _MOST_STEPS else 0
            fields = np.repeat(share, len(self.boundary.mean), axis=1) * self.tangents[:, :-2]
            # The rigid motion stays, because it does not distort.
            curve = replace(self, tangents=np.hstack([fields, self.tangents[:, -2:]]))
        return curve


def _freed(
    boundary: Boundary, map: HarmonicMap, before: list[Array], turns: int
) -> tuple[Array, Array]:
    """A keyframe's row, with the angle and the logarithm's branch nearest to the row before."""
    turn, _, mean = rigid_motion(boundary.points, boundary.images(map.phi, map.psi))
    angle = float(np.angle(turn))
    if before:
        angle = _nearest(angle, before[0][-2].real) + 2 * np.pi * turns
    turn = np.exp(1j * angle)
    phi, psi = boundary.translated(map.phi, -mean) / turn, map.psi * turn
    fz, fzb_conj = boundary.first @ phi, boundary.first @ psi
    log = boundary.logarithm(phi, fz)
    middle = float(boundary.mean @ np.imag(log))
    wanted = float(boundary.mean @ np.imag(before[0][: len(log)])) if before else 0.0
    log += 1j * (_nearest(middle, wanted) - middle)
    fields = np.concatenate([log, fzb_conj / fz])
    lost = np.stack([phi, psi]) - _fitted(boundary, fields, closes=False)
    return np.concatenate([fields, [angle, mean]]), lost


def _closes(boundary: Boundary, fields: Array) -> bool:
    """Whether closing the periods scales the fields by little."""
    log, nu = np.split(fields, 2)
    change = np.log(np.abs(boundary.closed(log, nu))) - np.real(log)
    return bool(np.abs(change).max() < CLOSES)


def _fitted(boundary: Boundary, fields: Array, closes: bool) -> Array:
    """(2, n) phi and psi of the map nearest to given fields, with the mean image 0."""
    log, nu = np.split(fields, 2)
    fz = boundary.closed(log, nu) if closes else np.exp(log)
    phi, psi = boundary.fitted(fz, nu * fz)
    return np.stack([boundary.translated(phi, -boundary.images(phi, psi).mean()), psi])


def _nearest(angle: float, to: float) -> float:
    return angle - 2 * np.pi * round((angle - to) / (2 * np.pi))


def _tangents(rows: Array, times: Array, closed: bool) -> Array:
    """Slopes of the cubic spline with a continuous second derivative; of the chord at open ends.

    If one side is much slower, the motion would overshoot there. So slopes are at most three times
    those of either chord (de Boor & Swartz 1977). All holomorphic fields are limited by one factor.
    """

    def sizes(slopes: Array) -> Array:
        size = np.abs(slopes)
        size[:, :-2] = size[:, :-2].max(axis=1, keepdims=True)
        return size

    slopes = np.diff(rows, axis=0) / np.diff(times)[:, None]
    before = np.vstack([slopes[-1 if closed else 0], slopes])
    after = np.vstack([slopes, slopes[0 if closed else -1]])
    mean = (rows[-1] - rows[0]) / (times[-1] - times[0])
    flat = rows - np.outer(times - times[0], mean)
    flat[-1] = flat[0]  # up to rounding: a loop may end some turns later
    ends: Any = "periodic" if closed else ((1, before[0] - mean), (1, after[-1] - mean))
    tangents = mean + CubicSpline(times, flat, bc_type=ends)(times, 1)
    most = 3 * np.minimum(sizes(before), sizes(after)) / np.maximum(sizes(tangents), 1e-300)
    return np.minimum(1, most) * tangents
