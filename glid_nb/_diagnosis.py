"""The diagnosis of `glid-nb doctor`: versions, devices, fast paths, folders, the host, and extras.

Users run it when something does not work. So a part that cannot be determined must not raise an
error; it gives a text instead.
"""

import os
import platform
import re
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from glid_nb import _features
from glid_nb._errors import InputError
from glid_nb._jax import jax
from glid_nb._programs import can_keep_for
from glid_nb._runtime import (
    blas_libraries,
    cache_directory,
    data_directory,
    default_device,
    jax_option,
)

GIVES = {
    "lab": "JupyterLab and Notebook, for the editor and the course",
    "course": "all chapters of the course",
    "check": "glid-check, an independent program that verifies proofs",
    "video": "MP4 and WebM",
    "imaging": "displacement fields from NIfTI and NRRD files, for glid-nb audit",
    "compare": "other methods to compare with (SLIM, AQP, bounded distortion)",
    "cuda12": "JAX on an NVIDIA GPU, CUDA 12",
    "cuda13": "JAX on an NVIDIA GPU, CUDA 13",
}
"""A description of each extra that users install."""


def diagnosis() -> dict[str, Any]:
    """The whole diagnosis of `glid-nb doctor`, as values for JSON."""
    needed, extras = _requirements()
    programs = _folder(cache_directory() / "compiled", "GLID_NB_CACHE")
    return {
        "python": f"{platform.python_version()} ({sys.executable})",
        "system": f"{platform.platform()}, {os.cpu_count()} processors",
        "host": host(),
        "libraries": {one.name: _state_of(one) for one in needed},
        "jax": _jax_state(programs["writable"]),
        "blas": blas_libraries(),
        "folders": {
            "compiled programs": programs,
            "kept work": _folder(data_directory(), "GLID_NB_DATA"),
        },
        "extras": {
            name: {
                "gives": GIVES[name],
                "missing": [_told(one) for one in extras.get(name, []) if not _is_met(one)],
            }
            for name in GIVES
        },
    }


def problems(found: dict[str, Any]) -> list[str]:
    """One sentence for each problem in a diagnosis that keeps the package from working well."""
    sentences = [
        f"{name} {state['installed'] or 'is missing'}, but glid-nb needs {name}{state['needed']}"
        for name, state in found["libraries"].items()
        if not state["fits"]
    ]
    if "error" in found["jax"]:
        sentences.append(found["jax"]["error"])
    for name, folder in found["folders"].items():
        if not folder["writable"]:
            sentences.append(
                f"the folder for {name}, {folder['path']}, cannot be written to; "
                f"name another one in {folder['variable']}"
            )
    return sentences


def host() -> str:
    """The notebook host in which this process runs, or none."""
    if "google.colab" in sys.modules or "COLAB_RELEASE_TAG" in os.environ:
        return "Google Colab"
    if "marimo" in sys.modules:
        return "marimo"
    kernel = "ipykernel" in sys.modules or "JPY_PARENT_PID" in os.environ
    if kernel and any(name.startswith("VSCODE_") for name in os.environ):
        return "VS Code"
    if not kernel:
        return "none (no notebook)"
    return _server_of_kernel() or "Jupyter"


def _server_of_kernel() -> str | None:
    """The Jupyter program that started this kernel, according to its command line."""
    try:
        words = Path(f"/proc/{int(os.environ['JPY_PARENT_PID'])}/cmdline").read_text("utf-8")
    except (KeyError, ValueError, OSError):
        return None
    names = {
        "voila": "Voila",
        "jupyterhub": "JupyterHub",
        "lab": "JupyterLab",
        "notebook": "Notebook",
    }
    return next((told for name, told in names.items() if re.search(name, words)), None)


def _requirements() -> tuple[list[Requirement], dict[str, list[Requirement]]]:
    """The requirements of the package and of each extra, from its metadata."""
    try:
        texts = distribution("glid-nb").requires or []
    except PackageNotFoundError:  # a checkout that was not installed
        return [], {}
    needed, extras = [], dict[str, list[Requirement]]()
    for one in map(Requirement, texts):
        if one.marker is None or one.marker.evaluate({"extra": ""}):
            needed.append(one)
            continue
        for extra in GIVES:
            if one.marker.evaluate({"extra": extra}):
                extras.setdefault(extra, []).append(one)
    return needed, extras


def _installed(one: Requirement) -> str | None:
    try:
        return version(one.name)
    except PackageNotFoundError:
        return None


def _is_met(one: Requirement) -> bool:
    found = _installed(one)
    if canonicalize_name(one.name) == "glid-nb":  # an extra that consists of other extras
        own = [r for name in one.extras for r in _requirements()[1].get(name, [])]
        return all(map(_is_met, own))
    met = found is not None and one.specifier.contains(found, prereleases=True)
    return met and not (canonicalize_name(one.name) == "jax" and one.extras and not _has_cuda())


def _told(one: Requirement) -> str:
    return one.name + (f"[{','.join(sorted(one.extras))}]" if one.extras else "")


def _has_cuda() -> bool:
    names = ("jax-cuda12-plugin", "jax-cuda13-plugin")
    return any(_installed(Requirement(name)) for name in names)


def _state_of(one: Requirement) -> dict[str, Any]:
    return {"installed": _installed(one), "needed": str(one.specifier), "fits": _is_met(one)}


def _jax_state(writable: bool) -> dict[str, Any]:
    """Devices and fast paths; or ``error``, the reason why JAX does not work here."""
    try:
        devices = [f"{one.platform} {one.id}: {one.device_kind}" for one in jax.local_devices()]
        device = default_device()
        configured = jax_option("jax_compilation_cache_dir")
        return {
            "devices": devices,
            "LAPACK in place": device.platform == "cpu" and _features.lapack_in_place(),
            "programs kept": writable and can_keep_for(device) and bool(_features.executables()),
            "XLA options set": sorted(_features.compiler_options()),
            "XLA options left out": sorted(_features.unknown_options()),
            "JAX's cache": None if configured is None else str(configured),
            "64 bits by default": bool(jax_option("jax_enable_x64")),
        }
    except (InputError, RuntimeError) as error:  # JAX raises a RuntimeError for device problems
        return {"error": " ".join(str(error).split())}


def _folder(path: Path, variable: str) -> dict[str, Any]:
    count, size = 0, 0
    for root, _, names in os.walk(path):
        for name in names:
            try:
                size += (Path(root) / name).stat().st_size
            except OSError:  # removed meanwhile
                continue
            count += 1
    try:  # os.access() is not reliable everywhere; a folder closed to this user raises, too
        existing = next(part for part in (path, *path.parents) if part.exists())
        with tempfile.TemporaryFile(dir=existing):
            writable = True
    except OSError:
        writable = False
    kept = {"files": count, "bytes": size, "writable": writable, "variable": variable}
    return {"path": str(path), **kept}
