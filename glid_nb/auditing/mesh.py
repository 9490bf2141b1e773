"""Maps of triangle meshes, linear on each triangle: exact orientations, and turns round vertices.

A triangle's determinant is the ratio of the areas of its image and its source. Positive ones do
not suffice: the images of the triangles round an interior vertex may wind twice round it.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats, first_masked
from glid_nb.auditing import exact
from glid_nb.auditing.result import Audit, AuditError, Verdict, at, share

_CLOSEST = 1000  # triangles whose determinants are compared as fractions


def checked_points(name: str, value: Any) -> Array:
    """(n, 2) finite points of their own type."""
    points = _rows_of(value, f"{name} must be (n, 2) coordinates", "iuf", 2)
    if points.dtype.kind == "f" and points.dtype.itemsize > 8:
        raise AuditError(f"{name} holds {points.dtype.name} numbers; convert it to float64")
    bad = np.argwhere(~np.isfinite(points))
    if len(bad):
        i, k = bad[0]
        raise AuditError(f"{name}[{i}, {k}] is {points[i, k]}; every coordinate must be finite")
    return points


def checked_triangles(value: Any, count: int) -> NDArray[np.int64]:
    """(t, 3) indices below ``count``."""
    triangles = _rows_of(value, "triangles must be (t, 3) whole numbers", "iu", 3)
    if not len(triangles):
        raise AuditError("the mesh has no triangles")
    bad = np.argwhere((triangles < 0) | (triangles >= count))
    if len(bad):
        t, k = bad[0]
        there = f"the mesh has the vertices 0 to {count - 1}"
        raise AuditError(f"triangles[{t}, {k}] is {triangles[t, k]}; {there}")
    return triangles.astype(np.int64)


def _rows_of(value: Any, wanted: str, kinds: str, columns: int) -> NDArray[Any]:
    """An array (n, columns) of one of NumPy's ``kinds`` of numbers; the error begins ``wanted``."""
    if (masked := first_masked(value)) is not None:
        raise AuditError(f"{wanted}, but row {masked} is masked")
    try:
        rows = np.asarray(value)
    except ValueError as error:
        raise AuditError(f"{wanted}: {error}") from None
    if rows.dtype.kind not in kinds or rows.ndim != 2 or rows.shape[1] != columns:
        raise AuditError(f"{wanted}, not {rows.dtype.name} values of shape {rows.shape}")
    return rows


def audit_mesh(source: Array, triangles: NDArray[np.int64], images: Array) -> Audit:
    """Audit checked vertices, triangles and images of the vertices."""
    if len(source) != len(images):
        raise AuditError(f"source has {len(source)} vertices, and there are {len(images)} images")
    found = [exact.determinants(_edges(points, triangles)) for points in (source, images)]
    before, after = (one.values for one in found)
    if (flat := np.flatnonzero(before == 0)).size:
        where = f"triangle {flat[0]} of the source, with the vertices {triangles[flat[0]].tolist()}"
        raise AuditError(f"{where}, has no area; remove it")
    with np.errstate(over="ignore", under="ignore"):
        values = after / before
    lost = (values == 0) & (after != 0)
    values[lost] = np.copysign(5e-324, after[lost] * np.sign(before[lost]))
    negative = values < 0
    folded, total = int(negative.sum()), len(triangles)
    which, smallest = _smallest(source, triangles, images, values)
    corners = source.astype(np.float64)[triangles]
    where = _middle(corners[which])
    area = float(np.abs(before[negative]).sum() / 2)
    verdict: Verdict = "folds" if folded else ("collapses" if smallest == 0 else "proved")
    place = f"triangle {which}, at {at(where)}"
    if verdict == "folds":
        text = f"It folds: the determinant is {smallest:.3g} on {place}; "
        text += f"{share(folded, total, 'triangle', 'triangles')}, an area of {area:.3g}."
        if folded == total > 1:
            text += " The mesh is mirrored; negate an axis of its images if that is meant."
    elif verdict == "collapses":
        text = f"It collapses: the determinant is exactly 0 on {place}, and nowhere negative."
    else:
        text = f"It is free of folds, proved on {total:,} triangle{'s' * (total > 1)}; "
        text += f"the smallest determinant is {smallest:.3g}, on {place}."
        oriented = np.where(before[:, None] > 0, triangles, triangles[:, ::-1])
        if (branch := _branch(source, oriented, images)) is not None:
            vertex, turns = branch
            verdict, where = "folds", (float(source[vertex, 0]), float(source[vertex, 1]))
            text = f"It folds: no triangle is turned over, but round vertex {vertex}, at "
            text += f"{at(where)}, the images of the triangles wind {turns} times."
    return Audit(
        verdict=verdict,
        kind="mesh",
        message=text,
        point=where if folded else None,
        determinant=smallest if folded else None,
        smallest=smallest,
        where=where,
        lower_bound=_lower_bound(*found) if verdict == "proved" else None,
        folded=folded,
        pieces=total,
        folded_area=area,
        undecided_area=0.0,
        determinants=values,
        signs=np.sign(values).astype(np.int8),
        outlines=corners,
    )


def _edges(points: Array, triangles: NDArray[np.int64]) -> exact.Edges:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return exact.Edges(a, b, a, c)


def _smallest(
    source: Array, triangles: NDArray[np.int64], images: Array, values: Floats
) -> tuple[int, float]:
    """The triangle with the smallest determinant, and the determinant. Rounded values choose those
    that are compared exactly."""
    count = min(_CLOSEST, len(values))
    few = np.sort(np.argpartition(values, count - 1)[:count])
    below, low = exact.exactly(_edges(source, triangles[few]), (0.0, 0.0))
    above, high = exact.exactly(_edges(images, triangles[few]), (0.0, 0.0))
    least = 0
    for k in range(1, count):  # a/b < c/d, where b d may be negative
        left, right = above[k] * below[least], above[least] * below[k]
        if (left < right) == (below[k] * below[least] > 0) and left != right:
            least = k
    spread = 200  # bits of the quotient
    sign = 1 if below[least] > 0 else -1
    quotient = (sign * above[least] << spread) // (sign * below[least])
    value = exact.as_float(quotient, high - low - spread)
    if not quotient and above[least]:
        value = 5e-324 if above[least] * sign > 0 else -5e-324
    return int(few[least]), value


def _lower_bound(before: exact.Determinants, after: exact.Determinants) -> float:
    with np.errstate(over="ignore", under="ignore"):
        least = (np.abs(after.values) - after.errors) / (np.abs(before.values) + before.errors)
    return max(float(least.min()) * (1 - 1e-14), 0.0)


def _middle(corners: Floats) -> tuple[float, float]:
    x, y = (corners / 3).sum(axis=0)
    return float(x), float(y)


def _branch(source: Array, triangles: NDArray[np.int64], images: Array) -> tuple[int, int] | None:
    """A vertex round which the images wind more often than the triangles, and how often.

    Only vertices inside count: all edges that leave them have a triangle on both sides. All
    determinants must be positive, and the triangles counter-clockwise. Then each triangle turns by
    less than pi, and each turn has one step from the lower half plane into the upper one.
    """
    vertex = triangles.ravel()
    start, end = (np.roll(triangles, -k, axis=1).ravel() for k in (1, 2))
    n = len(source)
    leaving, arriving = np.sort(vertex * n + start), np.sort(vertex * n + end)
    several = vertex[np.isin(vertex * n + start, leaving[1:][leaving[1:] == leaving[:-1]])]
    open_ones = np.setxor1d(leaving, arriving) // n
    outside = np.zeros(n, dtype=bool)
    outside[open_ones] = outside[several] = True
    turns = [_turns(points, vertex, start, end) for points in (source, images)]
    found = np.flatnonzero(~outside & (turns[0] != turns[1]))
    return (int(found[0]), int(turns[1][found[0]])) if len(found) else None


def _turns(points: Array, vertex: Array, start: Array, end: Array) -> NDArray[np.int64]:
    """How often the steps round each vertex go up through the half line to its right."""

    def is_up(other: Array) -> NDArray[np.bool_]:
        (x, y), (x0, y0) = points[other].T, points[vertex].T
        return (y > y0) | ((y == y0) & (x > x0))

    up = ~is_up(start) & is_up(end)
    return np.bincount(vertex[up], minlength=len(points))
