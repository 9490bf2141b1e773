"""Thin-plate splines of SciPy and scikit-image: closed derivatives, and enclosures on boxes.

    f(p) = offset + A p + sum of w_i phi(|p - c_i|^2),  phi(s) = kappa s (log(s + eps) + shift).

SciPy has kappa = 1/2 and eps = 0, scikit-image kappa = 1 and eps = 1e-8. With d = p - c_i,

    gradient = 2 phi'(s) d,  second derivatives = 2 phi'(s) I + 4 phi''(s) d d^T.

Without eps the second derivatives have a logarithmic singularity at the centre. On a box, centres
are divided: the far ones give their Jacobian and second derivatives at the box's middle, and bounds
on how these change; the near ones give a bound on |2 phi'(s) d|, which tends to 0 like r log r with
the box.
"""

import math
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Floats
from glid_nb.auditing.boxes import Enclosure, Jacobians

_NEAR = 0.25  # centres with a smaller squared distance, in squared half diagonals, are near
_UPWARD = 1 + 1e-12
_ROUNDOFFS = 40  # of a term: log, squares, products
_ROUNDING = 2.0**-50  # of a difference of coordinates
_TINY = 1e-290
_PAIRS = 200_000  # of boxes and centres at a time


@dataclass(frozen=True, eq=False)
class ThinPlate:
    """A planar thin-plate spline; see the module."""

    centres: Floats  # (n, 2)
    weights: Floats  # (n, 2)
    linear: Floats  # (2, 2); [i, j] is the derivative of component i by coordinate j
    kappa: float
    eps: float
    shift: float = 0.0

    def enclose(self, boxes: Floats) -> Jacobians:
        """The enclosure that `audit_boxes` takes."""
        chunk = max(1, _PAIRS // len(self.centres))
        parts = [self._enclose(boxes[k : k + chunk]) for k in range(0, len(boxes), chunk)]
        return Jacobians(*(np.concatenate(part) for part in zip(*parts, strict=True)))

    def _enclose(self, boxes: Floats) -> Jacobians:
        middle = boxes[:, :2] / 2 + boxes[:, 2:] / 2
        half = _UPWARD * np.maximum(boxes[:, 2:] - middle, middle - boxes[:, :2])
        d = middle[:, None] - self.centres  # (b, n, 2)
        reach = half[:, None] + _ROUNDING * np.abs(d)
        size, inner = np.abs(d) + reach, np.maximum(np.abs(d) - reach, 0.0)
        least, most = (inner**2).sum(axis=-1) / _UPWARD, (size**2).sum(axis=-1) * _UPWARD
        far = least > _NEAR * (half**2).sum(axis=-1)[:, None]
        gradients, gradient_errors = self._gradients(d)
        whole, whole_error = self._sum(gradients, gradient_errors)
        part, part_error = self._sum(gradients * far[..., None], gradient_errors * far[..., None])
        # Near centres: |2 phi'(s) d|.
        close = np.where(far, 0.0, self._near(np.sqrt(most)))
        radius = np.einsum("bn,nk->bk", close, np.abs(self.weights))[:, :, None] + part_error
        slope, variation = self._second_derivatives(d, half, reach, inner, least, most, far)
        return Jacobians(part, _UPWARD * (radius + variation), whole, whole_error, slope)

    def _gradients(self, d: Floats) -> tuple[Floats, Floats]:
        """(b, n, 2) gradients of the centres' functions, and bounds on their rounding."""
        s = (d**2).sum(axis=-1)
        away = s > 0
        safe = np.where(away, s, 1.0)
        log = np.log(safe + self.eps) + self.shift
        slope = np.where(away, 2 * self.kappa * (log + safe / (safe + self.eps)), 0.0)
        terms = 2 * self.kappa * (np.abs(log) + 2 * abs(self.shift) + 2)
        errors = _ROUNDOFFS * 2.0**-53 * terms[..., None] * np.abs(d)
        # Where s underflows, the gradient is far below this.
        return slope[..., None] * d, errors + np.where(s < 1e-280, 1e-130, 0.0)[..., None]

    def _sum(self, gradients: Floats, errors: Floats) -> tuple[Floats, Floats]:
        """Jacobians (b, 2, 2) from gradients (b, n, 2), and bounds on their rounding."""
        weights = np.abs(self.weights)
        total = self.linear + np.einsum("nk,bnj->bkj", self.weights, gradients)
        sizes = np.abs(self.linear) + np.einsum("nk,bnj->bkj", weights, np.abs(gradients))
        off = np.einsum("nk,bnj->bkj", weights, errors)
        rounding = (len(weights) + 4) * 2.0**-52 * (sizes + off)
        return total, _UPWARD * (off + rounding) + _TINY

    def _near(self, r: Floats) -> Floats:
        """Bounds on |2 phi'(s) d| within the distance r of the centre.

        |log(s + eps) + s / (s + eps)| <= 1 + 2 |log r| + eps, and r (1 - 2 log r) grows up to
        r = e^(-1/2), where it is 2 e^(-1/2) < 1.22.
        """
        safe = np.maximum(r, 1e-300)
        log = np.log(safe)
        bound = safe * (1 + 2 * np.abs(log))
        bound = np.where(log < -0.5, bound, np.maximum(bound, 1.22))
        return 2 * self.kappa * (1 + 1e-7) * (bound + (abs(self.shift) + 2 * self.eps) * safe)

    def _second_derivatives(
        self,
        d: Floats,
        half: Floats,
        reach: Floats,
        inner: Floats,
        least: Floats,
        most: Floats,
        far: NDArray[np.bool_],
    ) -> tuple[Floats, Floats]:
        """(b, 2, 2, 2) second derivatives of the far centres' part, about, and (b, 2, 2) bounds on
        what the Jacobian differs from its linear part with them."""
        low, high = np.where(far, least, 1.0), np.where(far, most, 1.0)
        scale = np.where(far, 2 * self.kappa, 0.0)
        # 2 phi' / (2 kappa) = log(s + eps) + shift + s / (s + eps), which grows with s.
        first = [np.log(s + self.eps) + self.shift + s / (s + self.eps) for s in (low, high)]
        # 4 phi'' / (2 kappa) = 2 (1 / (s + eps) + eps / (s + eps)^2), which falls.
        second = [2 * (1 / (s + self.eps) + self.eps / (s + self.eps) ** 2) for s in (high, low)]
        squares = [inner**2, (np.abs(d) + reach) ** 2]
        entries = []
        for k in (0, 1):
            lower = first[0] + second[0] * squares[0][..., k]
            upper = first[1] + second[1] * squares[1][..., k]
            entries.append((lower, upper))
        across = [d - reach, d + reach]
        products = np.stack([a[..., 0] * b[..., 1] for a in across for b in across])
        p0, p1 = products.min(axis=0), products.max(axis=0)
        lower = np.minimum(second[0] * p0, second[1] * p0)
        upper = np.maximum(second[0] * p1, second[1] * p1)
        entries.append((lower, upper))
        (xx, rxx), (yy, ryy), (xy, rxy) = (self._weighted(scale, *entry) for entry in entries)
        hx, hy = half[:, :1], half[:, 1:]
        slope = np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-1)
        return slope, _UPWARD * np.stack([rxx * hx + rxy * hy, rxy * hx + ryy * hy], axis=-1)

    def _weighted(self, scale: Floats, lower: Floats, upper: Floats) -> tuple[Floats, Floats]:
        """(b, 2) sums of scale times numbers in the intervals times the weights: middle and
        radius."""
        middle, radius = scale * (lower + upper) / 2, scale * (upper - lower) / 2
        sizes = scale * (np.abs(lower) + np.abs(upper) + abs(self.shift) + 100)
        radius = radius + (len(self.weights) + _ROUNDOFFS) * 2.0**-52 * sizes
        return middle @ self.weights, _UPWARD * (radius @ np.abs(self.weights))


def thin_plate(function: Any) -> ThinPlate | None:
    """The spline that ``function`` is; None for other functions."""
    return _of_scipy(function) or _of_skimage(function)


def closed_form(function: Any) -> Enclosure | None:
    spline = thin_plate(function)
    return None if spline is None else spline.enclose


def _of_scipy(function: Any) -> ThinPlate | None:
    module = sys.modules.get("scipy.interpolate")
    if module is None or not isinstance(function, module.RBFInterpolator):
        return None
    try:
        powers, coefficients = np.asarray(function.powers), np.asarray(function._coeffs)
        shift, scale = np.asarray(function._shift), np.asarray(function._scale)
        known = function.kernel == "thin_plate_spline" and function.neighbors is None
        centres, epsilon = np.asarray(function.y, dtype=np.float64), float(function.epsilon)
        real = function.d_dtype is float or np.dtype(function.d_dtype).kind == "f"
    except (AttributeError, TypeError):  # another version of SciPy
        return None
    if not (known and real and shift.size == 2 and function.d_shape == (2,)):
        return None
    if powers.sum(axis=1).max(initial=0) > 1:
        return None
    n = len(centres)
    linear = np.zeros((2, 2))
    for power, row in zip(powers, coefficients[n:], strict=True):
        if power.any():
            j = int(np.argmax(power))
            linear[:, j] = row / scale[j]
    kappa, weights = epsilon**2 / 2, np.asarray(coefficients[:n], dtype=np.float64)
    return ThinPlate(centres, weights, linear, kappa, 0.0, 2 * math.log(abs(epsilon)))


def _of_skimage(function: Any) -> ThinPlate | None:
    module = sys.modules.get("skimage.transform")
    kind = getattr(module, "ThinPlateSplineTransform", None) if module else None
    if kind is None or not isinstance(function, kind):
        return None
    table, centres = getattr(function, "_spline_mappings", None), getattr(function, "src", None)
    if table is None or centres is None or np.shape(table) != (len(centres) + 3, 2):
        return None
    table, n = np.asarray(table, dtype=np.float64), len(centres)
    return ThinPlate(np.asarray(centres, dtype=np.float64), table[:n], table[n + 1 :].T, 1.0, 1e-8)
