"""Handles and where they should go."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arrays import Array, number_pairs, read_only, real_array
from glid_nb._errors import InputError
from glid_nb.geometry import Domain, place

# Farther away, the rounding of a coordinate would be felt in the proof.
_FARTHEST = 1e6
DEEPEST = 100.0
"""Largest depth of a handle."""


class PoseError(InputError):
    """The handles or their targets are not valid."""


@dataclass(frozen=True, eq=False, init=False)
class Pose:
    """Positional constraints (paper Section 6.1): handle ``i`` should map to target ``i``.

    Parameters
    ----------
    handles : (h, 2) array_like
        Points ``p_i`` of the domain, world coordinates.
    targets : (h, 2) array_like
        Desired images ``q_i``; anywhere within 10^6 units.
    depths : (h,) array_like, optional
        Where parts of the shape overlap, those near handles of greater depth are drawn in front;
        -100 to 100, by default 0. They change no map.

    Raises
    ------
    PoseError
        When shapes or counts differ, a coordinate is not finite or out of scale, or two handles
        coincide.
    """

    handles: Array
    targets: Array
    depths: Array

    def __init__(
        self, handles: ArrayLike, targets: ArrayLike, depths: ArrayLike | None = None
    ) -> None:
        object.__setattr__(self, "handles", _checked_points(handles, "handles"))
        object.__setattr__(self, "targets", _checked_points(targets, "targets"))
        n_handles, n_targets = len(self.handles), len(self.targets)
        if n_handles != n_targets:
            raise PoseError(
                f"there {_counted(n_handles, 'handle')} but {n_targets} "
                f"target{'' if n_targets == 1 else 's'}; give one target per handle"
            )
        given = np.zeros(n_handles) if depths is None else depths
        object.__setattr__(self, "depths", _checked_depths(given, n_handles))
        _, first, inverse = np.unique(self.handles, axis=0, return_index=True, return_inverse=True)
        repeated = np.flatnonzero(first[inverse.ravel()] != np.arange(n_handles))
        if repeated.size:
            j = int(repeated[0])
            i = int(first[inverse.ravel()[j]])
            raise PoseError(
                f"handles {i} and {j} are the same point {place(self.handles[j])}; remove one"
            )

    def __len__(self) -> int:
        return len(self.handles)

    def check_inside(self, domain: Domain) -> None:
        """Raise :class:`PoseError` naming the first handle that lies outside the domain."""
        i = _first_outside(domain, self.handles.tobytes())
        if i is not None:
            raise PoseError(
                f"handle {i} at {place(self.handles[i])} lies outside the domain; "
                "move it inside the cage and out of its holes, or remove it"
            )

    def with_targets(self, targets: ArrayLike) -> Pose:
        """The same handles with other targets."""
        return Pose(self.handles, targets, self.depths)

    def only(self, kept: Any) -> Pose:
        """Some of the handles, by their indices or a mask."""
        return Pose(self.handles[kept], self.targets[kept], self.depths[kept])

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON values: ``handles``, ``targets``, and ``depths`` where one is not 0."""
        depths = {"depths": self.depths.tolist()} if self.depths.any() else {}
        return {"handles": self.handles.tolist(), "targets": self.targets.tolist(), **depths}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Pose:
        """The pose with the keys that `to_dict` writes; other keys are ignored."""
        if not isinstance(data, Mapping):
            raise PoseError(f"a pose must be an object, got {type(data).__name__}")
        for key in ("handles", "targets"):
            if key not in data:
                raise PoseError(f'the pose lacks the key "{key}"')
        return cls(data["handles"], data["targets"], data.get("depths"))


def rigid_motion(z: Array, targets: Array) -> tuple[complex, complex, complex]:
    """``z -> aim + turn (z - middle)`` that brings (h,) complex points closest to their targets.

    Returns turn, middle and aim.
    """
    middle, aim = z.mean(), targets.mean()
    correlation = np.vdot(z - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    return turn, middle, aim


@functools.lru_cache(maxsize=32)
def _first_outside(domain: Domain, handles: bytes) -> int | None:
    """The first handle outside the domain; kept, for a drag asks again for the same handles."""
    inside = domain.cage.contains(np.frombuffer(handles).reshape(-1, 2))
    return None if inside.all() else int(np.argmin(inside))


def _checked_points(points: Any, name: str) -> Array:
    array = number_pairs(points, f"{name} must be a list of [x, y] pairs", PoseError)
    for bad, why in (
        (~np.isfinite(array), "coordinates must be finite numbers"),
        (
            np.abs(array) > _FARTHEST,
            f"coordinates beyond {_FARTHEST:g} are out of scale (a picture's longer side is 20 "
            "units)",
        ),
    ):
        rows = np.flatnonzero(bad.any(axis=1))
        if rows.size:
            raise PoseError(f"{name}[{rows[0]}] is {place(array[rows[0]])}; {why}")
    return read_only(array)


def _checked_depths(depths: ArrayLike, count: int) -> Array:
    wanted = f"depths must be {count} numbers from {-DEEPEST:g} to {DEEPEST:g}, one per handle"
    try:
        array = real_array(depths)
    except (TypeError, ValueError) as error:
        raise PoseError(f"{wanted} ({error})") from error
    if array.shape != (count,) or not (np.abs(array) <= DEEPEST).all():
        raise PoseError(f"{wanted}, not {depths!r:.60}")
    return read_only(array)


def _counted(count: int, noun: str) -> str:
    return f"is 1 {noun}" if count == 1 else f"are {count} {noun}s"
