"""Motions as the page interpolates them: the same maps as in the kernel."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page

import glid_nb.page
from glid_nb import Motion
from glid_nb.export.page import playing
from glid_nb.page import ShaderMap

from ..support.domains import random_map

_MODULE = Path(glid_nb.page.__file__).parent / "js" / "motion" / "motion.js"
_MIX = """async ({code, values, floats, times}) => {
  const bytes = Uint8Array.from(atob(floats), (c) => c.charCodeAt(0));
  const {Motion} = await import(`data:text/javascript,${encodeURIComponent(code)}`);
  const motion = new Motion(values, new Float32Array(bytes.buffer));
  return times.map((t) => [motion.start, motion.end, motion.within(t), motion.place(t).piece,
    ...motion.at(t)]);
}"""


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("repeat", ["once", "loop", "ping-pong"])
def test_the_page_mixes_the_coefficients_of_the_motion(page: Page, repeat: Any) -> None:
    maps = [random_map("ring", 0.03, seed) for seed in range(3)]
    motion = Motion(maps, [1, 1.5, 3], repeat=repeat, easing="in-out")
    wire = ShaderMap(motion.domain).wire
    values, floats = playing(motion, wire)
    assert values["keyframes"] == [1, 1.5, 3]
    assert len(values["sigma2"]) == len(values["times"]) - 1
    inside = np.linspace(motion.start, motion.end, 13)
    times = inside if repeat == "once" else np.concatenate([inside - 5, inside, inside + 7])
    page.goto("about:blank")
    arguments = {
        "code": _MODULE.read_text(encoding="utf-8"),
        "values": json.loads(json.dumps(values)),
        "floats": base64.b64encode(floats).decode(),
        "times": times.tolist(),
    }
    seen = np.array(page.evaluate(_MIX, arguments))
    np.testing.assert_allclose(seen[:, :2], [[motion.start, motion.end]] * len(times))
    for time, (_, _, within, piece, *mixed) in zip(times, seen, strict=True):
        expected = np.frombuffer(wire(motion(time)), "<f4")
        np.testing.assert_allclose(mixed, expected, atol=2e-6, rtol=2e-7)
        there = min(within, 2 * motion.times[-1] - within)
        part = motion.pieces[int(piece)]
        assert part.start - 1e-9 <= there <= part.end + 1e-9
