"""By which angles a map turns the lines between handles.

A line leads from a handle to its parent in the tree of handles
(:mod:`glid_nb.minima.handle_tree`). Its turn may exceed 180 degrees: following the argument of
``f_z`` along the path inside the shape counts full turns, too. Maps of one pose that turn all lines
alike mostly lead to the same minimum.
"""

from typing import NamedTuple

import numpy as np

from glid_nb._runtime import single_blas_thread
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import edge_coefficients
from glid_nb.minima.handle_tree import handle_tree
from glid_nb.pose import DeformationMap, Pose

# A line is squeezed if its targets are closer than this share of its handles' distance.
_SQUEEZED = 0.95
# The map keeps a path straight if arg f_z changes by less than this along it.
_STRAIGHT = np.deg2rad(10)
# An end is wound up if the shape turns there by this much more than the line to it. With ends that
# are wound up led the other way round, 9 of 323 poses ended lower.
_WOUND = np.deg2rad(110)
# A line that turns by less makes no arc. Nor does one that turns by nearly half a circle.
_BENT = np.deg2rad(40)


class Line(NamedTuple):
    """The line from a handle to its parent, and what a map does to it; angles in radians."""

    child: int
    parent: int
    turn: float
    """Against the parent's own line; at the root against the shape, or against the other of two."""
    stretch: float
    """Distance of its targets over that of its handles."""
    bend: float
    """Range of arg f_z along the path."""
    overturn: float
    """The turn of the shape at the child beyond that of the line."""
    is_end: bool
    """Whether the child is no other handle's parent."""

    @property
    def squeezed(self) -> bool:
        """Whether the line is shortened though it could bend instead: it stays straight."""
        return self.bend < _STRAIGHT and self.stretch < _SQUEEZED

    @property
    def wound(self) -> bool:
        """Whether the map winds the shape up at the child."""
        return abs(self.overturn) > _WOUND

    @property
    def curled(self) -> bool:
        """Whether it is a free end that turns, but not to an arc of a circle: there the end would
        turn twice as far as the line."""
        turns = _BENT < abs(self.turn) < np.pi - _BENT
        return self.is_end and turns and abs(self.overturn - self.turn) > np.pi


class HandleTurns(NamedTuple):
    """How a map turns the lines of a pose."""

    domain: Domain
    pose: Pose
    root: int
    whole: float
    """The turn of the shape; where two lines meet at the root, that of the first."""
    lines: list[Line]
    """Every line comes after that of its parent."""

    def angles(self, reversed: tuple[int, ...] = ()) -> dict[int, float]:
        """The turns of lines by child, in world coordinates; that of the root is :attr:`whole`.

        ``reversed`` names the children whose lines turn the other way round: by a full circle less
        in the direction in which they turn.
        """
        angles = {self.root: self.whole}
        for line in self.lines:
            i, j, turn = line.child, line.parent, line.turn
            angles[i] = angles[j] + turn - 2 * np.pi * np.sign(turn) * (i in reversed)
        return angles

    def key(self, reversed: tuple[int, ...] = ()) -> tuple[float, ...]:
        """The lines' turns against the first line; different for maps of one pose that turn lines
        differently."""
        turns = np.array([*self.angles(reversed).values()][1:])
        return tuple(np.round(turns - turns[:1], 3))


@single_blas_thread()
def handle_turns(map: DeformationMap, pose: Pose) -> HandleTurns:
    """Measure how a harmonic map turns the lines of a pose with at least one handle.

    One BLAS thread takes 0.3 ms on large trees, where several took 2 to 8 ms.
    """
    assert isinstance(map, HarmonicMap)
    tree = handle_tree(map.domain, pose.handles.tobytes())
    root = tree.root
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    basis = basis_of(map.domain)
    fz = tree.fz_rows @ edge_coefficients(basis.pad(map.phi), basis.singularities)
    at_handles = {root: float(np.angle(fz[0]))}  # arg f_z, followed along the paths
    angles = dict[int, float]()  # of the lines
    stretches, bends = list[float](), list[float]()
    for i, j, path in tree.edges:
        along = at_handles[j] + np.cumsum(np.angle([1, *(fz[path][1:] / fz[path][:-1])]))
        at_handles[i] = float(along[-1])
        # The line's turn is known up to full circles. Where the shape turns smoothly, the line
        # turns by about the mean along the path.
        ratio = (w[i] - w[j]) / (z[i] - z[j])
        principal, mean = float(np.angle(ratio)), float(along.mean())
        angles[i] = principal + 2 * np.pi * round((mean - principal) / (2 * np.pi))
        stretches.append(float(abs(ratio)))
        bends.append(float(np.ptp(along)))
    # Most lines turn as the shape does. Where only two meet at the root, one turns against the
    # other.
    at_root = [angles[edge.child] for edge in tree.edges if edge.parent == root]
    median = float(np.median([at_handles[root], *angles.values()]))
    whole = at_root[0] if len(at_root) == 2 else median
    angles[root] = whole
    parents = {edge.parent for edge in tree.edges}
    lines = [
        Line(
            child=edge.child,
            parent=edge.parent,
            turn=angles[edge.child] - angles[edge.parent],
            stretch=stretch,
            bend=bend,
            overturn=at_handles[edge.child] - angles[edge.child],
            is_end=edge.child not in parents,
        )
        for edge, stretch, bend in zip(tree.edges, stretches, bends, strict=True)
    ]
    return HandleTurns(map.domain, pose, root, whole, lines)
