"""Functions of the plane: enclosures of the Jacobian on boxes that are divided until they decide.

An enclosure takes (b, 4) boxes (xmin, ymin, xmax, ymax) and returns the (b, 2, 2) middles and
radii of matrices: every Jacobian on a box is entrywise within the radius of the middle plus the
slope times the distance from the box's centre. [i, j] is the derivative of component i by
coordinate j, and [i, j, k] of the slope that of [i, j] by coordinate k.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.auditing.result import Audit, AuditError, Verdict, at

Bounds = tuple[float, float, float, float]
Function = Callable[[Floats], Any]

TRUSTED = 1e-12
"""The values of a function without closed form are trusted up to this share of the largest."""
_UPWARD = 1 + 1e-12
_TINY = 1e-290
_START = 8  # boxes along the longer side
_ENOUGH = 0.01  # share of the area that may stay undecided once a fold is proved
_MEASURING = 0.1  # share of the budget after which a proved fold's area is measured no further
_GRID = 65  # points per side where only values are known


class Jacobians(NamedTuple):
    """Jacobians on boxes, and at their centres if they are known there."""

    middle: Floats
    radius: Floats
    centre: Floats
    centre_radius: Floats
    slope: Floats | None = None


Enclosure = Callable[[Floats], Jacobians]


def audit_boxes(enclose: Enclosure, bounds: Bounds, budget: int) -> Audit:
    """Divide the bounds until every box is decided or ``budget`` boxes were enclosed."""
    boxes, spent = _first(bounds), 0
    done: list[tuple[Floats, NDArray[np.int8], Floats, Floats]] = []
    fold: tuple[float, Floats] | None = None  # the upper bound and its point
    least, lower, total = (np.inf, np.zeros(2)), np.inf, _area(boxes).sum()
    while len(boxes):
        room = budget - spent
        if room <= 0:
            done.append((boxes, np.zeros(len(boxes), np.int8), *_unknown(boxes)))
            break
        if len(boxes) > room:
            rest = boxes[room:]
            done.append((rest, np.zeros(len(rest), np.int8), *_unknown(rest)))
            boxes = boxes[:room]
        spent += len(boxes)
        low, high, at_centre, most = _bounded(boxes, enclose(boxes))
        centres = (boxes[:, :2] + boxes[:, 2:]) / 2
        i = int(np.argmin(at_centre))
        if at_centre[i] < least[0]:
            least = float(at_centre[i]), centres[i]
        i = int(np.argmin(most))
        if most[i] < 0 and (fold is None or most[i] < fold[0]):
            fold = float(most[i]), centres[i]
        signs = np.where(low > 0, 1, np.where(high < 0, -1, 0)).astype(np.int8)
        lower = min(lower, float(low[signs > 0].min(initial=np.inf)))
        halves = _halved(boxes)
        decided = (signs != 0) | (halves[0] == boxes).all(axis=1) | (halves[1] == boxes).all(axis=1)
        done.append((boxes[decided], signs[decided], at_centre[decided], low[decided]))
        open_ones = ~decided
        remaining = _area(boxes[open_ones]).sum()
        boxes = np.stack([halves[0][open_ones], halves[1][open_ones]], axis=1).reshape(-1, 4)
        if fold is not None and (remaining <= _ENOUGH * total or spent > _MEASURING * budget):
            values = np.repeat(at_centre[open_ones], 2)
            done.append((boxes, np.zeros(len(boxes), np.int8), values, values))
            break
    found = np.concatenate([one[0] for one in done])
    sign = np.concatenate([one[1] for one in done])
    values = np.concatenate([one[2] for one in done])
    return _result(found, sign, values, fold, least, lower, spent)


def _result(
    boxes: Floats,
    signs: NDArray[np.int8],
    values: Floats,
    fold: tuple[float, Floats] | None,
    least: tuple[float, Floats],
    lower: float,
    spent: int,
) -> Audit:
    areas = _area(boxes)
    folded_area, open_area = (float(areas[signs == sign].sum()) for sign in (-1, 0))
    where = _pair(least[1])
    verdict: Verdict = "proved" if (signs > 0).all() else "undecided"
    if fold is not None:
        verdict = "folds"
    share_open = open_area / float(areas.sum())
    if verdict == "proved":
        text = f"It is free of folds, proved on {spent:,} boxes; the determinant is at least "
        text += f"{lower:.3g}, and {least[0]:.3g} at {at(where)}."
    elif fold is not None:
        text = f"It folds: the determinant is at most {fold[0]:.3g} at {at(_pair(fold[1]))}; "
        text += f"an area from {folded_area:.3g} to {folded_area + open_area:.3g} folds."
    else:
        text = f"Undecided: after {spent:,} boxes, {share_open:.3g} of the area has no proved sign;"
        text += f" the smallest determinant met is {least[0]:.3g}, at {at(where)}. A larger budget"
        text += " may decide it."
    return Audit(
        verdict=verdict,
        kind="map",
        message=text,
        point=_pair(fold[1]) if fold else None,
        determinant=fold[0] if fold else None,
        smallest=least[0],
        where=where,
        lower_bound=lower if verdict == "proved" else None,
        folded=int((signs < 0).sum()),
        pieces=len(boxes),
        folded_area=folded_area,
        undecided_area=open_area,
        determinants=values,
        signs=signs,
        outlines=boxes[:, [[0, 1], [2, 1], [2, 3], [0, 3]]],
    )


def _bounded(boxes: Floats, found: Jacobians) -> tuple[Floats, Floats, Floats, Floats]:
    """Lower and upper bounds on the boxes' determinants, those at the centres, their upper
    bounds."""
    centre = boxes[:, :2] / 2 + boxes[:, 2:] / 2
    half = _UPWARD * np.maximum(boxes[:, 2:] - centre, centre - boxes[:, :2])
    slope = np.zeros((*found.middle.shape, 2)) if found.slope is None else found.slope
    value, error = _determinant(found.middle, found.radius, slope, half)
    at_centre, centre_error = _determinant(found.centre, found.centre_radius)
    high = value + error
    # Bounds on a whole box hold at its centre, too.
    most = np.nan_to_num(np.fmin(at_centre + centre_error, high), nan=np.inf)
    shown = np.where(np.isfinite(at_centre), at_centre, value)
    with np.errstate(invalid="ignore"):
        return value - error, high, np.where(np.isfinite(shown), shown, np.inf), most


def _determinant(
    middle: Floats, radius: Floats, slope: Floats | None = None, half: Floats | None = None
) -> tuple[Floats, Floats]:
    """Determinants of matrices, and bounds on how far those of all matrices within the radii are.

    With v = slope . delta + e, det(J + v) - det J = a vd + d va - b vc - c vb + va vd - vb vc. The
    linear terms in delta are added up with their signs. The terms of 2**-50 are for the rounding.
    """
    (a, b), (c, d) = np.moveaxis(middle, 0, -1)
    a_, b_, c_, d_ = np.abs(a), np.abs(b), np.abs(c), np.abs(d)
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        linear, every = np.zeros(len(middle)), radius
        if slope is not None and half is not None:
            (sa, sb), (sc, sd) = np.moveaxis(slope, 0, -1).swapaxes(-1, -2)  # (b, 2) each
            tilt = np.abs(a[:, None] * sd + d[:, None] * sa - b[:, None] * sc - c[:, None] * sb)
            sizes = a_[:, None] * np.abs(sd) + d_[:, None] * np.abs(sa)
            sizes += b_[:, None] * np.abs(sc) + c_[:, None] * np.abs(sb)
            linear = ((tilt + 2.0**-50 * sizes) * half).sum(axis=1)
            every = _UPWARD * (radius + np.einsum("bijk,bk->bij", np.abs(slope), half))
        (ra, rb), (rc, rd) = np.moveaxis(radius, 0, -1)
        (va, vb), (vc, vd) = np.moveaxis(every, 0, -1)
        error = linear + a_ * rd + d_ * ra + b_ * rc + c_ * rb + va * vd + vb * vc
        error = _UPWARD * error + 2.0**-50 * (a_ * d_ + b_ * c_) + _TINY * (1 + a_ + b_ + c_ + d_)
        return a * d - b * c, error * _UPWARD


def from_second_derivatives(function: Function, most: float) -> Enclosure:
    """Enclosures by values at the corners, and a bound on all second partial derivatives.

    The slope of an edge along x is the mean of f_x on that edge. A mean point of the edge is at
    most w / 2 away along x and the two edges h / 2 on average along y, so f_x on the box is
    within ``most`` (w + h) / 2 of the two slopes' mean. Along y likewise.
    """

    def enclose(boxes: Floats) -> Jacobians:
        corners = boxes[:, [[0, 1], [2, 1], [0, 3], [2, 3]]].reshape(-1, 2)
        values = values_at(function, corners).reshape(-1, 4, 2)
        sides = boxes[:, 2:] - boxes[:, :2]
        middle = np.stack(
            [
                (values[:, 1] - values[:, 0] + values[:, 3] - values[:, 2]) / 2,
                (values[:, 2] - values[:, 0] + values[:, 3] - values[:, 1]) / 2,
            ],
            axis=-1,
        )
        middle /= sides[:, None]
        off = 4 * TRUSTED * np.abs(values).max(axis=(1, 2))
        radius = most * sides.sum(axis=1) / 2
        radius = _UPWARD * (radius[:, None] + off[:, None] / sides)
        radius = np.broadcast_to(radius[:, None], middle.shape)
        return Jacobians(middle, radius, middle, np.full_like(radius, np.inf))

    return enclose


def from_jacobian(jacobian: Callable[[Floats], Any]) -> Enclosure:
    """Enclosures that the user's function computes: the lower and upper ends of the Jacobians."""

    def enclose(boxes: Floats) -> Jacobians:
        try:
            low, high = (np.asarray(one, dtype=np.float64) for one in jacobian(boxes.copy()))
        except (TypeError, ValueError) as error:
            raise AuditError(f"jacobian must return a pair (lower, upper): {error}") from None
        shape = (len(boxes), 2, 2)
        if low.shape != shape or high.shape != shape:
            shapes = f"{low.shape} and {high.shape}"
            raise AuditError(f"jacobian of {len(boxes)} boxes must be two {shape}, not {shapes}")
        if np.isnan(low).any() or np.isnan(high).any() or (low > high).any():
            raise AuditError("jacobian must return lower ends below upper ones, and no NaN")
        with np.errstate(invalid="ignore", over="ignore"):
            middle = np.where(np.isfinite(low) & np.isfinite(high), low / 2 + high / 2, 0.0)
            radius = np.maximum(high - middle, middle - low)
        radius = _UPWARD * radius + 2.0**-50 * np.abs(middle)
        return Jacobians(middle, radius, middle, np.full(shape, np.inf))

    return enclose


def measured(function: Function, bounds: Bounds) -> Audit:
    """What values alone show of a function: difference quotients, which prove nothing."""
    x, y = (np.linspace(bounds[k], bounds[k + 2], _GRID) for k in (0, 1))
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    step = 1e-5 * np.array([bounds[2] - bounds[0], bounds[3] - bounds[1]])
    inward = np.where(points > (np.array(bounds[:2]) + np.array(bounds[2:])) / 2, -step, step)
    stencil = [points, points + inward * [1, 0], points + inward * [0, 1]]
    value, along, up = np.split(values_at(function, np.concatenate(stencil)), 3)
    a, b = (along - value) / inward[:, :1], (up - value) / inward[:, 1:]
    quotients = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    i = int(np.argmin(quotients))
    where = _pair(points[i])
    seems = "so it seems to fold there" if quotients[i] < 0 else "so no fold was met"
    text = "Undecided, because values alone prove nothing: the smallest difference quotient of "
    text += f"the determinant is {quotients[i]:.3g}, at {at(where)}, {seems}. Give "
    text += "second_derivative= or jacobian= for a proof."
    half = np.array([(bounds[2] - bounds[0]), (bounds[3] - bounds[1])]) / (2 * (_GRID - 1))
    low, high = np.maximum(points - half, bounds[:2]), np.minimum(points + half, bounds[2:])
    boxes = np.concatenate([low, high], axis=1)
    return Audit(
        verdict="undecided",
        kind="map",
        message=text,
        point=None,
        determinant=None,
        smallest=float(quotients[i]),
        where=where,
        lower_bound=None,
        folded=0,
        pieces=len(boxes),
        folded_area=0.0,
        undecided_area=float(_area(boxes).sum()),
        determinants=quotients,
        signs=np.zeros(len(quotients), np.int8),
        outlines=boxes[:, [[0, 1], [2, 1], [2, 3], [0, 3]]],
    )


def values_at(function: Function, points: Floats) -> Floats:
    """The function's values, checked."""
    try:
        values = np.asarray(function(points), dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise AuditError(f"the function cannot take (k, 2) points: {error}") from error
    if values.shape != points.shape:
        shapes = f"{points.shape} points it returns the shape {values.shape}"
        raise AuditError(f"the function must return (k, 2) points; for {shapes}")
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        x, y = values[bad[0]]
        place = f"({x:g}, {y:g}) at {at(_pair(points[bad[0]]))}"
        raise AuditError(f"the function is {place}; it must be finite on the bounds")
    return values


def checked_bounds(value: Any) -> Bounds:
    try:
        xmin, ymin, xmax, ymax = (float(one) for one in value)
    except (TypeError, ValueError, OverflowError):
        text = "bounds must be four numbers (xmin, ymin, xmax, ymax)"
        raise AuditError(f"{text}, not {value!r:.60}") from None
    if not (np.isfinite([xmin, ymin, xmax, ymax]).all() and xmin < xmax and ymin < ymax):
        text = "bounds must be finite (xmin, ymin, xmax, ymax) with xmin < xmax and ymin < ymax"
        raise AuditError(f"{text}, not {(xmin, ymin, xmax, ymax)}")
    return xmin, ymin, xmax, ymax


def _first(bounds: Bounds) -> Floats:
    xmin, ymin, xmax, ymax = bounds
    sides = np.array([xmax - xmin, ymax - ymin])
    nx, ny = np.maximum(np.ceil(_START * sides / sides.max()), 1).astype(int)
    x, y = np.linspace(xmin, xmax, nx + 1), np.linspace(ymin, ymax, ny + 1)
    x[-1], y[-1] = xmax, ymax
    i, j = (one.ravel() for one in np.mgrid[:ny, :nx])
    return np.stack([x[j], y[i], x[j + 1], y[i + 1]], axis=1)


def _halved(boxes: Floats) -> tuple[Floats, Floats]:
    """Both halves of boxes, across the longer side. Halves share their middle exactly."""
    wide = (boxes[:, 2] - boxes[:, 0]) >= (boxes[:, 3] - boxes[:, 1])
    x, y = boxes[:, 0] / 2 + boxes[:, 2] / 2, boxes[:, 1] / 2 + boxes[:, 3] / 2
    first, second = boxes.copy(), boxes.copy()
    first[wide, 2] = second[wide, 0] = x[wide]
    first[~wide, 3] = second[~wide, 1] = y[~wide]
    return first, second


def _unknown(boxes: Floats) -> tuple[Floats, Floats]:
    return np.full(len(boxes), np.nan), np.full(len(boxes), np.nan)


def _area(boxes: Array) -> Floats:
    return (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])


def _pair(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
