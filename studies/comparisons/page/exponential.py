"""Figure 6."""

from __future__ import annotations

from studies.comparisons.page.words import name_of, verdict
from studies.comparisons.store import Measurement


def section(cases: list[Measurement], figures: str) -> list[str]:
    """Low average against low maximum."""
    (data,) = cases
    iso, exp = data["runs"]["iso"], data["runs"]["exp"]
    lower, higher = exp["most"] < iso["most"], exp["mean"] > iso["mean"]
    return [
        "## E_iso against E_exp (Figure 6)",
        "",
        f"![exponential]({figures}/exponential.png)",
        "",
        "The paper shows a bar in an extreme pose and gives no number (ours begin with the rigid "
        "alignment); its claim is that the "
        "exponential lowers the maximal distortion and raises the average. On "
        f"{name_of(data['name'])} the maximum of E_iso goes from {iso['most']:.2f} to "
        f"{exp['most']:.2f} and its mean along the boundary from {iso['mean']:.3f} to "
        f"{exp['mean']:.3f}. {verdict(lower and higher, lower)}",
    ]
