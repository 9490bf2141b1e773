"""The user's bounds on the distortion."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.certificate import Certificate
from glid_nb.solvers import MethodError

Array = NDArray[Any]


@dataclass(frozen=True)
class DistortionBounds:
    """``k(z) <= k``, ``sigma_1(z) <= sigma1`` and ``sigma_2(z) >= sigma2`` (Theorem 4.2).

    Raises
    ------
    MethodError
        When an isometry does not satisfy them with room to spare.
    """

    k: float = 0.8
    sigma1: float = 5.0
    sigma2: float = 0.3

    def __post_init__(self) -> None:
        ranges = {"k": (0, 1), "sigma1": (1, math.inf), "sigma2": (0, 1)}
        for name, (low, high) in ranges.items():
            value = getattr(self, name)
            if not isinstance(value, numbers.Real) or not low < float(value) < high:
                raise MethodError(
                    f"the bound {name} must lie between {low} and {high}, ends excluded, for the "
                    f"method starts at an isometry; got {value!r}"
                )

    def hold(self, certificate: Certificate) -> bool:
        """Whether they are proved on the whole domain."""
        return (
            certificate.certified
            and certificate.k_upper <= self.k
            and certificate.sigma1_upper <= self.sigma1
            and certificate.sigma2_lower >= self.sigma2
        )

    @property
    def narrowest(self) -> float:
        """The least of the bounds' ranges, each relative to its bound and no more than 1."""
        return min(1.0, (self.sigma1 - 1) / self.sigma1, (1 - self.sigma2) / self.sigma2)

    def used(self, k: Array, sigma1: Array, sigma2: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        return np.stack(
            [k / self.k, (sigma1 - 1) / (self.sigma1 - 1), (1 - sigma2) / (1 - self.sigma2)]
        )

    def at(self, used: Array) -> tuple[Array, Array, Array]:
        """k, sigma_1 and sigma_2 at (3, n) such shares."""
        k, sigma1, sigma2 = used
        return k * self.k, 1 + sigma1 * (self.sigma1 - 1), 1 - sigma2 * (1 - self.sigma2)
