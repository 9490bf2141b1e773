"""A picture, a domain with a hole, and a map that bends it, without a solve."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose

SIZE = (300, 200)  # world: 20 x 13.33


def picture() -> NDArray[np.uint8]:
    """Smooth colours under a ring-shaped alpha channel, and a dark mark to tell left from right."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    red, green = 255 * x / SIZE[0], 255 * y / SIZE[1]
    blue = 128 + 100 * np.sin(x / 25) * np.cos(y / 20)
    image = np.stack([red, green, blue, np.full_like(x, 255)], axis=-1)
    image[(x < 110) & (y < 80)] = (30, 30, 30, 255)
    r = np.hypot((x - 150) / 1.3, y - 100)
    image[..., 3] = 255 * np.clip(88 - r, 0, 1) * np.clip(r - 30, 0, 1)
    return np.round(image).astype(np.uint8)


@functools.cache
def domain() -> Domain:
    t = 2 * np.pi * np.arange(28) / 28
    loop = np.stack([1.3 * np.cos(t), np.sin(t)], axis=-1)
    return Domain.from_cage(Cage(6.0 * loop, [1.9 * loop[::2]]), 0.2)


@functools.cache
def bent() -> HarmonicMap:
    """Almost z + 0.03 i z^2: conformal, and locally injective on the domain."""
    start = HarmonicMap.identity(domain())
    phi = np.where(start.phi != 0, start.phi + 0.03j * start.phi**2, 0)
    return HarmonicMap(domain(), phi, start.psi)


def pose() -> Pose:
    handles = np.array([[-5.0, 0.0], [5.0, 0.0]])
    return Pose(handles, bent()(handles))
