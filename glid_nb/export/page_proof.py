"""What a page says of the proofs of its maps or motions, in words and as ranges of colours."""

import html
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from glid_nb.certificate import Certificate, global_injectivity
from glid_nb.certificate.rounding import rounded_down, rounded_up
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import Motion, MotionCertificate

# The texts for each verdict on global injectivity: of the only shape, and of one of several.
_OVERLAPS = {
    "yes": ("no part lies over another", "it does not overlap itself"),
    "no": ("parts of the shape lie over one another", "it overlaps itself"),
    "undecided": (
        "it is not known whether parts of the shape lie over one another",
        "it is not known whether it overlaps itself",
    ),
}


@dataclass(frozen=True, eq=False)
class Proved:
    """A shape of a page and its proof. A motion has its own."""

    shown: HarmonicMap | Motion
    certificate: Certificate | None = None
    name: str = ""  # of one of several

    @cached_property
    def proof(self) -> Certificate | MotionCertificate | None:
        """The proof, only if it is one."""
        found = self.shown.certificate if isinstance(self.shown, Motion) else self.certificate
        return found if found is not None and found.certified else None

    @cached_property
    def verdict(self) -> str | None:
        """The verdict on global injectivity; None for motions and without a proof."""
        if isinstance(self.shown, Motion) or self.proof is None:
            return None
        assert isinstance(self.proof, Certificate)
        return global_injectivity(self.shown, self.proof).verdict

    @property
    def missing(self) -> str:
        """Why a motion is not proved; "" if it is, and for maps."""
        return self.shown.certificate.reason if isinstance(self.shown, Motion) else ""


@dataclass(frozen=True)
class _Bounds:
    """The worst bounds of several proofs."""

    sigma2_lower: float
    sigma1_upper: float
    k_upper: float

    def __str__(self) -> str:
        low, high = rounded_down(self.sigma2_lower), rounded_up(self.sigma1_upper)
        return f"σ₂ ≥ {low}, σ₁ ≤ {high}, k ≤ {rounded_up(self.k_upper)}"


def _worst(shapes: Sequence[Proved]) -> _Bounds | None:
    """Bounds that hold for all shapes; None if one is not proved."""
    proofs = [shape.proof for shape in shapes if shape.proof is not None]
    if len(proofs) < len(shapes):
        return None
    return _Bounds(
        min(proof.sigma2_lower for proof in proofs),
        max(proof.sigma1_upper for proof in proofs),
        max(proof.k_upper for proof in proofs),
    )


def color_ranges(shapes: Sequence[Proved]) -> dict[int, list[float]]:
    """The colour map's ends for each overlay, by its number in ``picture.frag``: the value of an
    isometry, and the bound that is proved for all shapes, at least a tenth away."""
    worst = _worst(shapes)
    if worst is None:
        return {}
    ends = {
        2: [1, max(worst.sigma1_upper, 1.1)],
        3: [1, min(worst.sigma2_lower, 0.9)],
        4: [0, max(worst.k_upper, 0.1)],
    }
    return {overlay: range_ for overlay, range_ in ends.items() if np.isfinite(range_[1])}


def caption(shapes: Sequence[Proved]) -> str:
    """What is proved, or why a motion is not."""
    worst, (first, *others) = _worst(shapes), shapes
    if worst is None:
        if not others:
            return first.missing
        unproved = [shape for shape in shapes if shape.proof is None and shape.missing]
        return " ".join(f"{shape.name}: {shape.missing}" for shape in unproved)
    at = "point, at any time" if isinstance(first.shown, Motion) else "point"
    if others:
        what = f"Each of {len(shapes)} parts is proved not to fold over or tear at any {at}"
        return f"{what}. Bounds for all: {worst}"
    overlap = f"; {_OVERLAPS[first.verdict][0]}" if first.verdict else ""
    return f"Proved not to fold over or tear at any {at}{overlap}. Bounds: {worst}"


def list_of_parts(shapes: Sequence[Proved]) -> str:
    """HTML with what is proved for each of several shapes; "" for a single one."""
    if len(shapes) == 1:
        return ""
    rows = "".join(f"<li><b>{html.escape(one.name)}</b> {_of_one(one)}</li>" for one in shapes)
    return f"<details><summary>Each part</summary><ul>{rows}</ul></details>"


def _of_one(shape: Proved) -> str:
    bounds = _worst([shape])
    if bounds is None:
        return "not proved"
    return f"{bounds}; {_OVERLAPS[shape.verdict][1]}" if shape.verdict else str(bounds)
