"""Uniforms and defines of the energies' shader."""

from glid_nb.energies import ENERGIES, Energy

UNIFORM_VECTORS = 1024
"""Vectors of uniforms that a vertex shader is assumed to hold until the page says otherwise."""


def energy_defines() -> str:
    """What stands before ``energy.glsl``: the density of every energy, chosen by its number."""
    known = [energy.shader for energy in ENERGIES.values()]
    choices = [f"energy.x < {i + 0.5} ? ({text}) : " for i, text in enumerate(known) if text]
    return f"#define ENERGY_DENSITY {''.join(choices)}0.0\n"


def energy_uniform(energy: Energy) -> list[float]:
    """The number of an energy and its parameter, as ``energy.glsl`` takes them."""
    number = list(ENERGIES).index(energy.name) if energy.shader else -1
    return [float(number), float(getattr(energy, "s", 1.0))]
