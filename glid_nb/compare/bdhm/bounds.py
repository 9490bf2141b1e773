"""The user's bounds on the distortion."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass

from glid_nb.certificate import Certificate
from glid_nb.compare.method import MethodError


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

    def tightened(self, share: float) -> DistortionBounds:
        """Bounds that are stricter by a share, for what happens between samples."""
        return DistortionBounds(
            self.k * (1 - share),
            1 + (self.sigma1 - 1) * (1 - share),
            1 - (1 - self.sigma2) * (1 - share),
        )
