"""Figure 5."""

from __future__ import annotations

from studies.comparisons.page.words import name_of, verdict
from studies.comparisons.store import Measurement

_CONFORMAL = 1e-6
"""A proved dilatation below this is that of a conformal map, but for rounding."""


def section(cases: list[Measurement], figures: str) -> list[str]:
    """What a conformal map pays with."""
    (data,) = cases
    amips, conformal = data["runs"]["amips"], data["runs"]["conformal"]
    good = conformal["bounds"][0] < _CONFORMAL and conformal["mean"] > amips["mean"]
    return [
        "## Advanced MIPS against a conformal map (Figure 5)",
        "",
        f"![conformal]({figures}/conformal.png)",
        "",
        "The paper shows two maps of a domain with two holes and gives no number "
        "(ours begin with the rigid alignment); its claim is "
        "that leaving out psi gives a pure conformal map with least isometric distortion. On "
        f"{name_of(data['name'])}, with {data['holes']} holes, the dilatation k of that map is "
        f"proved to be at most {conformal['bounds'][0]:.0e}, against {amips['bounds'][0]:.2f} of "
        "the map that minimises Advanced MIPS. It pays with isometric distortion: the mean of "
        f"E_iso along the boundary is {conformal['mean']:.3f} against {amips['mean']:.3f}, its "
        f"maximum {conformal['most']:.2f} against {amips['most']:.2f}. {verdict(good)}",
    ]
