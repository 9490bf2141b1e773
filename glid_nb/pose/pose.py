"""Handles and where they should go."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs, real_array
from glid_nb._errors import InputError
from glid_nb.geometry import Domain, place
from glid_nb.pose.naming import in_both
from glid_nb.pose.placement import beside, misplaced
from glid_nb.pose.stiffness import FARTHEST, Stiffness

DEEPEST, SCALES = 100.0, (0.01, 100.0)  # the largest depth of a handle; its least and largest scale
# Optional numbers of a handle: the least value, the largest value and the default.
_MORE = {
    "depths": (-DEEPEST, DEEPEST, 0.0),
    "angles": (-1e3, 1e3, np.nan),
    "scales": (*SCALES, np.nan),
    "weights": (1e-6, 1e6, 1.0),
}
PER_HANDLE = ("handles", "targets", *_MORE, "names")


class PoseError(InputError):
    """The handles or their targets are not valid."""


@dataclass(frozen=True, eq=False, init=False)
class Pose(Rebuilt):
    """Positional constraints (paper Section 6.1): handle ``i`` should map to target ``i``.

    Lists or arrays are accepted. Raises a PoseError when shapes or counts differ, a coordinate is
    not finite or out of scale, or two handles coincide. Raises a StiffnessError when a stroke is
    not valid.
    """

    handles: Array
    """(h, 2) points ``p_i`` of the domain, world coordinates."""
    targets: Array
    """(h, 2) desired images ``q_i``; anywhere within 10^10 units."""
    depths: Array
    """(h,) drawing order, -100 to 100, by default 0. Where parts of the shape overlap, the parts
    near handles of greater depth are drawn in front. Depths do not change the map."""
    angles: Array
    """(h,) rotation of the shape at each handle, in radians: ``f_z`` there should be ``scale
    exp(i angle)``. None or NaN, the default, leaves the angle free. Angles, scales and weights are
    for methods in the harmonic subspace."""
    scales: Array
    """(h,) scale of the shape at each handle. None or NaN, the default, leaves it free."""
    weights: Array
    """(h,) how firmly each handle is held, relative to ``Options.p2p_weight``; by default 1."""
    names: Array
    """(h,) texts, by default empty."""
    stiffness: Stiffness
    """Strokes over areas that should keep their shape. Each is a dict of ``points`` (n, 2) of the
    undeformed shape, the ``radius`` of the brush and the ``strength`` from 0 (erases) to 1. Where
    strokes overlap, the last one counts. The stiffness is part of the pose, so it is saved with it.
    For descents in the harmonic subspace."""

    def __init__(
        self,
        handles: ArrayLike,
        targets: ArrayLike,
        depths: ArrayLike | None = None,
        *,
        angles: ArrayLike | None = None,
        scales: ArrayLike | None = None,
        weights: ArrayLike | None = None,
        names: Sequence[str] | None = None,
        stiffness: Stiffness | Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        points = {"handles": handles, "targets": targets}
        vars(self).update({name: _checked_points(xy, name) for name, xy in points.items()})
        n_handles, n_targets = len(self.handles), len(self.targets)
        if n_handles != n_targets:
            raise PoseError(*in_both(lambda named: _miscounted(n_handles, n_targets, named.word)))
        more = {"depths": depths, "angles": angles, "scales": scales, "weights": weights}
        vars(self).update({name: _checked_numbers(name, v, n_handles) for name, v in more.items()})
        vars(self)["names"] = _checked_names(names, n_handles)
        vars(self)["stiffness"] = Stiffness.of(stiffness)
        known: dict[tuple[float, ...], int] = {}
        for j, handle in enumerate(map(tuple, self.handles.tolist())):
            if (i := known.setdefault(handle, j)) != j:
                raise _coincident(i, j, handle)

    def __len__(self) -> int:
        return len(self.handles)

    def check_inside(self, domain: Domain) -> None:
        """Raise :class:`PoseError` naming the first handle that lies outside the domain."""
        i = _first_outside(domain, self.handles.tobytes())
        if i is not None:
            where, apart = beside(domain.cage, self.handles[i])
            what = f"at {where} lies outside the domain, by {apart:.2g} units"
            remedy = "move it inside and out of its holes, or remove it"
            message, plain = in_both(lambda named: f"{named(i)} {what}; {remedy}")
            why = misplaced(domain.cage, self.handles)  # converts arrays, which an editor has not
            raise PoseError(f"{message}{'. ' * bool(why)}{why}", plain)

    def with_targets(self, targets: ArrayLike) -> Pose:
        """The same handles with other targets."""
        return replace(self, targets=targets)

    def only(self, kept: Any) -> Pose:
        """The pose with some of the handles only, chosen by indices or by a mask."""
        return replace(self, **{name: getattr(self, name)[kept] for name in PER_HANDLE})

    @property
    def oriented(self) -> Array:
        """(h,) bool: the handles with a wanted angle or scale."""
        return ~(np.isnan(self.angles) & np.isnan(self.scales))

    def same_constraints(self, other: Pose) -> bool:
        """Whether the other pose is the same, except for targets, depths and names."""
        return self.stiffness == other.stiffness and all(
            np.array_equal(getattr(self, name), getattr(other, name), equal_nan=True)
            for name in ("handles", "angles", "scales", "weights")
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON values: ``handles``, ``targets``, and all values that are not the default."""
        more = {}
        for name, (*_, default) in _MORE.items():
            values = getattr(self, name)
            if not np.array_equal(values, np.full(len(self), default), equal_nan=True):
                more[name] = [None if np.isnan(value) else value for value in values.tolist()]
        if any(self.names):
            more["names"] = self.names.tolist()
        if self.stiffness:
            more["stiffness"] = self.stiffness.to_list()
        return {"handles": self.handles.tolist(), "targets": self.targets.tolist(), **more}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Pose:
        """The pose with the keys that `to_dict` writes; other keys are ignored."""
        if not isinstance(data, Mapping):
            raise PoseError(f"a pose must be an object, got {type(data).__name__}")
        for key in ("handles", "targets"):
            if key not in data:
                raise PoseError(f'the pose lacks the key "{key}"')
        more = {name: data.get(name) for name in (*_MORE, "names", "stiffness")}
        return cls(data["handles"], data["targets"], **more)


def _miscounted(n_handles: int, n_targets: int, word: str) -> str:
    are = f"is 1 {word}" if n_handles == 1 else f"are {n_handles} {word}s"
    targets = f"{n_targets} target{'' if n_targets == 1 else 's'}"
    return f"there {are} but {targets}; give one target per {word}"


def _coincident(i: int, j: int, at: Any) -> PoseError:
    same = f"are the same point {place(at)}; remove one"
    return PoseError(*in_both(lambda named: f"{named(i, j)} {same}"))


@functools.lru_cache(maxsize=32)
def _first_outside(domain: Domain, handles: bytes) -> int | None:
    inside = domain.cage.contains(np.frombuffer(handles).reshape(-1, 2))
    return None if inside.all() else int(np.argmin(inside))


def _checked_points(points: Any, name: str) -> Array:
    array = number_pairs(points, f"{name} must be a list of [x, y] pairs", PoseError)
    wrong = np.flatnonzero(~(np.abs(array) <= FARTHEST).all(axis=1))
    if wrong.size:
        point = array[wrong[0]]
        why = "coordinates must be finite numbers"
        if np.isfinite(point).all():
            side = "a picture's longer side is 20 units"
            why = f"coordinates beyond {FARTHEST:g} are out of scale ({side})"
        raise PoseError(f"{name}[{wrong[0]}] is {place(point)}; {why}")
    return frozen(array)


def _checked_names(names: Sequence[str] | None, count: int) -> Array:
    texts = [""] * count if names is None else names
    listed = isinstance(texts, list | tuple | np.ndarray) and len(texts) == count
    if not listed or not all(isinstance(text, str) for text in texts):
        raise PoseError(f"names must be {count} texts, one per handle, not {names!r:.60}")
    return frozen(np.array(texts, dtype=str))


def _checked_numbers(name: str, values: ArrayLike | None, count: int) -> Array:
    least, most, default = _MORE[name]
    if values is None:
        return frozen(np.full(count, default))
    wanted = f"{name} must be {count} numbers from {least:g} to {most:g}, one per handle"
    wanted += ", or null where free" if np.isnan(default) else ""
    try:
        array = real_array(values)
    except (TypeError, ValueError) as error:
        raise PoseError(f"{wanted} ({error})") from error
    within = (least <= array) & (array <= most) | (np.isnan(array) & np.isnan(default))
    if array.shape != (count,):
        raise PoseError(f"{wanted}, not {values!r:.60}")
    if wrong := np.flatnonzero(~within).tolist():
        raise PoseError(f"{name}[{wrong[0]}] is {array[wrong[0]]:g}; {wanted}")
    return frozen(array)
