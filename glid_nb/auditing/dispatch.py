"""`audit`: which kind of warp is given, and its audit."""

import math
from typing import Any

import numpy as np

from glid_nb._arguments import check_count
from glid_nb.auditing.boxes import (
    audit_boxes,
    checked_bounds,
    from_jacobian,
    from_second_derivatives,
    measured,
    values_at,
)
from glid_nb.auditing.field import Order, audit_field, checked_field, checked_spacing
from glid_nb.auditing.mesh import audit_mesh, checked_points, checked_triangles
from glid_nb.auditing.result import Audit, AuditError
from glid_nb.auditing.splines import closed_form
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import DisplacementField, HarmonicMap


def audit(
    warp: Any,
    *,
    order: Order = "xy",
    spacing: Any = (1.0, 1.0),
    source: Any = None,
    triangles: Any = None,
    bounds: Any = None,
    second_derivative: float | None = None,
    jacobian: Any = None,
    budget: int = 200_000,
) -> Audit:
    """Prove that a warp of any origin is free of folds, or find where it folds.

    ``warp`` is one of three:

    - A displacement field: an array (h, w, 2). The pixel in column x and row y goes to
      (x + dx, y + dy), and the map is bilinear on the cells between pixels. The components are
      (dx, dy); ``order="yx"`` is for (dy, dx). ``spacing`` are the steps (x, y) between pixels if
      the displacements have another unit. The signs are exact.
      A `DisplacementField` has its own spacing; cells are audited where it is known.
    - A mesh: the images (v, 2) of its vertices, with ``source``, the vertices (v, 2), and
      ``triangles`` (t, 3). A `MeshMap` has them all. The signs are exact.
    - A function from (k, 2) points to (k, 2) points, with ``bounds`` (xmin, ymin, xmax, ymax).
      Boxes are divided until the sign is decided, or ``budget`` boxes were tried. Thin-plate
      splines need nothing more: SciPy's ``RBFInterpolator`` with the kernel "thin_plate_spline",
      and scikit-image's ``ThinPlateSplineTransform``. Other functions need
      ``second_derivative``, a bound on the moduli of all second partial derivatives, or
      ``jacobian``: a function from boxes (b, 4) to the lower and the upper ends (b, 2, 2) of the
      derivatives on them. Without either, the result is undecided. With ``second_derivative``,
      values are trusted up to 1e-12 of the largest.

    Raises an InputError for a warp that cannot be read, and a TypeError for one of another kind.
    """
    of_mesh, of_map = (source, triangles), (bounds, second_derivative, jacobian)
    if isinstance(warp, HarmonicMap):
        raise AuditError("a HarmonicMap has a proof of its own; use glid.certify(map)")
    if isinstance(getattr(warp, "map", None), HarmonicMap):  # an inverse, a transform, a result
        what = f"this {type(warp).__name__} belongs to a HarmonicMap, which has a proof of its own"
        raise AuditError(f"{what}; use glid.certify(x.map)")
    if isinstance(warp, MeshMap):
        _refuse("a MeshMap", source=source, triangles=triangles, bounds=bounds)
        mesh = warp.triangulation
        return audit_mesh(mesh.vertices, mesh.triangles.astype(np.int64), warp.images)
    if isinstance(warp, DisplacementField):
        _refuse("a DisplacementField", source=source, triangles=triangles, bounds=bounds)
        return audit_field(checked_field(warp.values), warp.spacing, warp.known)
    if callable(warp):
        _refuse("a function", source=source, triangles=triangles)
        return _audit_function(warp, bounds, second_derivative, jacobian, budget)
    if any(one is not None for one in of_map):
        raise AuditError("bounds, second_derivative and jacobian are for functions")
    if any(one is not None for one in of_mesh):
        if source is None or triangles is None:
            missing = "source" if source is None else "triangles"
            raise AuditError(f"a mesh needs {missing}, too")
        images, vertices = checked_points("images", warp), checked_points("source", source)
        return audit_mesh(vertices, checked_triangles(triangles, len(vertices)), images)
    if not isinstance(warp, list | tuple) and not hasattr(warp, "__array__"):
        kinds = "a displacement field, images of a mesh's vertices, a MeshMap or a function"
        raise TypeError(f"warp must be {kinds}, not {type(warp).__name__}")
    return audit_field(checked_field(warp, order), checked_spacing(spacing))


def _audit_function(warp: Any, bounds: Any, most: Any, jacobian: Any, budget: int) -> Audit:
    if bounds is None:
        raise AuditError("a function needs bounds=(xmin, ymin, xmax, ymax)")
    box, budget = checked_bounds(bounds), check_count("budget", budget, 1, "boxes")
    if most is not None and jacobian is not None:
        raise AuditError("give second_derivative or jacobian, not both")
    if jacobian is not None:
        if not callable(jacobian):
            raise TypeError(f"jacobian must be a function, not {type(jacobian).__name__}")
        return audit_boxes(from_jacobian(jacobian), box, budget)
    if most is not None:
        if isinstance(most, bool) or not isinstance(most, int | float | np.number):
            kind = type(most).__name__
            raise TypeError(f"second_derivative must be a number, not {kind}")
        if not (math.isfinite(most) and most >= 0):
            raise AuditError(f"second_derivative must be finite and at least 0, not {most}")
        return audit_boxes(from_second_derivatives(warp, float(most)), box, budget)
    if (enclosure := closed_form(warp)) is not None:
        values_at(warp, np.array([box[:2]]))
        return audit_boxes(enclosure, box, budget)
    return measured(warp, box)


def _refuse(kind: str, **given: Any) -> None:
    for name, value in given.items():
        if value is not None:
            raise AuditError(f"{kind} needs no {name}")
