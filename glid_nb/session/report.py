"""The report of a solve, as plain JSON values."""

import dataclasses
import json
import os
import platform
import time
from importlib.metadata import version
from typing import Any

from glid_nb._arguments import check_type
from glid_nb._jax import jax
from glid_nb.certificate import global_injectivity
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Result
from glid_nb.solvers.result import Attempt, Refinement

_LIBRARIES = ("jax", "jaxlib", "numpy", "scipy")


def build_report(result: Result) -> dict[str, Any]:
    """The report of a solve, with its certificate and global injectivity, both timed.

    Its keys:

    - ``status`` and ``message``; ``certified`` and the ``proof`` in words.
    - The energies ``E``, ``E_iso`` and ``E_p2p``; ``E_start`` is that before the first iteration.
      ``E_p2p`` is ``lambda / 2`` times the sum of squared ``misses`` (h,), in world units.
    - The certified bounds ``sigma2_lower``, ``sigma1_upper`` and ``k_upper``.
    - ``windings`` of f_z per loop (exterior first) and their sum ``winding``.
    - ``globally_injective`` ("yes", "no" or "undecided"), and a ``crossing`` if not.
    - Counts: ``panels`` and ``panels_split`` of the solver, ``proof_panels`` of the final proof.
    - Times in seconds.
    - ``attempts``: what each attempt reached, the first included, if there were several.
    - ``refinements``: the same for bases (:func:`glid_nb.refine`).
    - ``history``: one object per iteration.

    Values that are not finite are null.
    """
    check_type("result", result, Result, "pass what glid_nb.solve returns")
    began = time.perf_counter()
    map_, certificate = result.map, result.certificate
    if certificate is None or not isinstance(map_, HarmonicMap):
        raise TypeError("a report needs a certified map, but this result has a map of a mesh")
    injectivity = global_injectivity(map_, certificate)
    certify_time = time.perf_counter() - began
    energy, options = result.energy_measure, result.options
    report = {
        "status": result.status.value,
        "message": result.message,
        "certified": certificate.certified,
        "proof": certificate.reason,
        "E": result.energy,
        "E_iso": result.energy_distortion,
        "E_p2p": result.energy_p2p,
        "E_start": result.start_energy,
        "energy": energy.name,
        "s": getattr(energy, "s", None),
        "p2p_weight": options.p2p_weight,
        "lambda": options.lambda_on(map_.domain.cage),
        "misses": result.misses,
        "sigma2_lower": certificate.sigma2_lower,
        "sigma1_upper": certificate.sigma1_upper,
        "k_upper": certificate.k_upper,
        "winding": certificate.winding,
        "windings": certificate.windings,
        "globally_injective": injectivity.verdict,
        "crossing": injectivity.crossing,
        "iterations": result.iterations,
        "n_unknowns": result.n_unknowns,
        "panels": result.n_panels,
        "panels_split": result.panels_split,
        "proof_panels": len(certificate.panels.depth),
        "compile_time": result.compile_time,
        "solve_time": result.solve_time,
        "certify_time": certify_time,
        "attempts": [_entry(one) for one in result.attempts],
        "refinements": [_entry(one) for one in result.refinements],
        "options": dataclasses.asdict(options),
        "history": [{**dataclasses.asdict(one), "energy": one.energy} for one in result.history],
        "versions": {
            "glid_nb": version("glid-nb"),
            "python": platform.python_version(),
            **{name: version(name) for name in _LIBRARIES},
        },
        "machine": {
            "system": platform.platform(),
            "architecture": platform.machine(),
            "cpus": os.cpu_count(),
            "devices": [f"{one.platform}: {one.device_kind}" for one in jax.local_devices()],
        },
    }
    text = json.dumps(report, default=lambda array: array.tolist())
    return json.loads(text, parse_constant=lambda _: None)


def _entry(one: Attempt | Refinement) -> dict[str, Any]:
    return {**dataclasses.asdict(one), "status": one.status.value}
