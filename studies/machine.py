"""The machine that measurements were taken on."""

import os
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jax


def machine() -> dict[str, Any]:
    """Processor, system, devices and versions, to be stored beside the measurements."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
        "devices": [f"{d.platform}: {d.device_kind}" for d in jax.local_devices()],
        "versions": {name: version(name) for name in ("jax", "jaxlib", "numpy", "scipy")},
    }


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
