"""Displacement fields with bilinear interpolation: every cell decided by its four corners.

On a cell, f = P + u a + v b + u v c with u and v in [0, 1], so det(f_u, f_v) = a x b + u a x c +
v c x b: it is affine, and its least value is at a corner. Four positive corners make f locally
injective on the whole grid: each cell is convex, and the four angles round a pixel are less than
pi each, so they add up to 2 pi.
"""

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.auditing import exact
from glid_nb.auditing.result import Audit, AuditError, Verdict, at, share

Order = Literal["xy", "yx"]
_CELLS = 100_000  # of one block of rows
_CLOSEST = 1000  # cells whose smallest determinants are compared exactly


def checked_field(value: Any, order: str = "xy") -> Array:
    """(h, w, 2) displacements (dx, dy) of their own type. Raises an AuditError for others."""
    if order not in ("xy", "yx"):
        raise AuditError(f'order must be "xy" for (dx, dy) or "yx" for (dy, dx), not {order!r:.40}')
    if isinstance(value, np.ma.MaskedArray) and np.ma.getmaskarray(value).any():
        raise AuditError("the field is masked; fill in the masked displacements, or cut them off")
    try:
        field = np.asarray(value)
    except ValueError as error:
        raise AuditError(f"the field is not an array of shape (h, w, 2): {error}") from None
    if field.dtype.kind not in "iuf":
        raise AuditError(f"the field holds {field.dtype.name} values; displacements are numbers")
    if field.dtype.kind == "f" and field.dtype.itemsize > 8:
        raise AuditError(f"the field holds {field.dtype.name} numbers; convert it to float64")
    field = _planar(field)
    if 1 in field.shape[:2]:
        rows = f"the field has {field.shape[0]} x {field.shape[1]} pixels (rows x columns)"
        raise AuditError(f"{rows}; a cell needs at least 2 x 2")
    bad = np.argwhere(~np.isfinite(field))
    if len(bad):
        i, j, k = bad[0]
        name = "dx" if k == (order == "yx") else "dy"
        place = f"{name} is {field[i, j, k]} at the pixel x = {j}, y = {i}"
        raise AuditError(f"{place}; every displacement must be finite")
    return field if order == "xy" else field[..., ::-1]


def checked_spacing(value: Any) -> tuple[float, float]:
    try:
        x, y = (float(one) for one in value)
    except (TypeError, ValueError, OverflowError):
        x = y = 0.0
    if not all(math.isfinite(one) and one for one in (x, y)):
        text = "spacing must be two finite numbers other than 0, the steps (x, y) between pixels"
        raise AuditError(f"{text}, not {value!r:.60}")
    return x, y


def _planar(field: Array) -> Array:
    shape = field.shape
    if field.ndim == 4 and shape[2:] == (1, 2):
        return field[:, :, 0]
    if field.ndim == 3 and shape[2] == 2 and min(shape) > 0:
        return field
    wanted = f"a field has the shape (h, w, 2), not {shape}"
    if field.ndim == 3 and shape[0] == 2:
        raise AuditError(f"{wanted}; np.moveaxis(field, 0, -1) puts its first axis last")
    if field.ndim > 3 or (field.ndim == 3 and shape[2] == 3):
        raise AuditError(f"{wanted}; only planar fields are audited, so take a slice of it")
    raise AuditError(wanted)


def audit_field(
    field: Array, spacing: tuple[float, float] = (1.0, 1.0), known: Array | None = None
) -> Audit:
    """Audit a checked field. The displacements are in the unit of ``spacing``, the steps between
    pixels. A negative step is that of an axis which runs against its displacements. Only cells are
    audited whose four pixels are ``known``, (h, w) bool; by default all are."""
    if min(spacing) < 0:  # mirroring both the source and the image changes no determinant
        field = field.astype(np.float64) * np.sign(spacing)
        spacing = (abs(spacing[0]), abs(spacing[1]))
    h, w = field.shape[0] - 1, field.shape[1] - 1
    cells = np.ones((h, w), dtype=bool) if known is None else _known_cells(known)
    least, area, folded, at_least = np.full((h, w), np.nan), 0.0, 0, math.inf
    rows = max(1, _CELLS // w)
    for first in range(0, h, rows):
        i, j = np.nonzero(cells[first : first + rows])
        if not len(i):
            continue
        i += first
        found = exact.determinants(_corners(field, i, j), spacing)
        corners = found.values.reshape(4, -1)
        least[i, j] = corners.min(axis=0)
        some = corners[:, (corners < 0).any(axis=0)]
        folded += some.shape[1]
        area += float(_negative_share(some).sum())
        with np.errstate(over="ignore"):
            at_least = min(at_least, float((found.values - found.errors).min()))
    total = int(cells.sum())
    value, where = _smallest(field, least, total, spacing)
    smallest = _per_area(value, spacing)
    verdict: Verdict = "folds" if folded else ("collapses" if value == 0 else "proved")
    if verdict == "folds":
        text = f"It folds: the determinant is {smallest:.3g} at the pixel {at(where)}; "
        text += f"{share(folded, total, 'cell', 'cells')}, {area:.3g} square pixels."
    elif verdict == "collapses":
        text = f"It collapses: the determinant is exactly 0 at the pixel {at(where)}, "
        text += "and nowhere negative."
    else:
        place = f"{w + 1} x {h + 1} pixels" if known is None else f"{total:,} cells"
        text = f"It is free of folds, proved on {place}; "
        text += f"the smallest determinant is {smallest:.3g}, at the pixel {at(where)}."
    bound = max(_per_area(at_least, spacing) * (1 - 1e-15), 0.0)
    signs = np.sign(np.where(cells, least, 0)).astype(np.int8)
    with np.errstate(over="ignore", under="ignore"):
        least = least / spacing[0] / spacing[1]
    return Audit(
        verdict=verdict,
        kind="field",
        message=text,
        point=where if folded else None,
        determinant=smallest if folded else None,
        smallest=smallest,
        where=where,
        lower_bound=bound if verdict == "proved" else None,
        folded=folded,
        pieces=total,
        folded_area=area,
        undecided_area=0.0,
        determinants=least,
        signs=signs,
    )


def _known_cells(known: Array) -> NDArray[np.bool_]:
    """(h - 1, w - 1) whether all four corners of a cell are known."""
    cells = known[1:, 1:] & known[:-1, 1:] & known[1:, :-1] & known[:-1, :-1]
    if not cells.any():
        raise AuditError("no cell of the field has four known corners; sample it more finely")
    return cells


def _corners(field: Array, i: Array, j: Array) -> exact.Edges:
    """The edges of the cells (i, j) that meet at their corners: at (u, v) = (0, 0) for all cells,
    then at (1, 0), (0, 1) and (1, 1)."""
    below = np.concatenate([i, i, i + 1, i + 1])  # the row of the edge along u
    right = np.concatenate([j, j + 1, j, j + 1])  # the column of the edge along v
    i, j = np.tile(i, 4), np.tile(j, 4)
    return exact.Edges(field[below, j], field[below, j + 1], field[i, right], field[i + 1, right])


def _smallest(
    field: Array, least: Floats, total: int, spacing: exact.Pair
) -> tuple[float, tuple[float, float]]:
    """The smallest determinant of edges, and its pixel. Rounded values choose the cells that are
    compared exactly, of the ``total`` whose value is not NaN."""
    count = min(_CLOSEST, total)
    few = np.sort(np.argpartition(least.ravel(), count - 1)[:count])
    i, j = np.unravel_index(few, least.shape)
    index, value = exact.smallest(_corners(field, i, j), spacing)
    corner, cell = divmod(index, count)
    return value, (float(j[cell] + corner % 2), float(i[cell] + corner // 2))


def _per_area(value: float, spacing: exact.Pair) -> float:
    """A determinant of edges as one of the map, with its sign."""
    with np.errstate(over="ignore", under="ignore"):
        scaled = float(np.float64(value) / spacing[0] / spacing[1])
    return scaled or math.copysign(5e-324, value) * (value != 0)


def _negative_share(corners: Floats) -> Floats:
    """The shares of unit cells on which the affine determinant is negative: (4, k) corners, (k,).

    Mirrored so that it grows along both axes, it is p u + q v - t, with p <= q and t = -(its least
    value).
    """
    d00, d10, d01, d11 = corners / np.abs(corners).max(axis=0, initial=5e-324)
    along = np.abs((d10 - d00 + d11 - d01) / 2)
    up = np.abs((d01 - d00 + d11 - d10) / 2)
    p, q = np.minimum(along, up), np.maximum(along, up)
    least: Floats = np.min(np.stack([d00, d10, d01, d11]), axis=0)
    t = -least
    # Where one of these is not finite, it is not the one that holds there.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        first = t / p * (t / q) / 2
        middle = (t - p / 2) / q
        rest = p + q - t
        last = 1 - rest / p * (rest / q) / 2
    return np.select([t <= 0, t >= p + q, t <= p, t <= q], [0.0, 1.0, first, middle], last)
