"""The inverse of a harmonic map: preimages, each with a proved radius.

Newton's method starts from the triangles of a mesh whose images lie over a point. Around the
preimage that it finds, bounds on the map prove a disc that contains an exact one, and a disc that
contains no other (`docs/proof.md`, Lemma 29). Nothing rests on Newton's method.
"""

import functools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol, overload, runtime_checkable

import numpy as np
import scipy
import shapely

from glid_nb._arguments import check_type, unmet
from glid_nb._arrays import Array, read_only
from glid_nb.geometry import Domain, Overlay, Triangulation, as_points, triangulate
from glid_nb.harmonic import transport
from glid_nb.harmonic.expansions import Jets, cover_of, jets_at
from glid_nb.harmonic.fixed_points import FixedPoints
from glid_nb.harmonic.points import MapError, as_complex
from glid_nb.harmonic.rounding import UNDERFLOW, UNIT_ROUNDOFF, UPWARD

if TYPE_CHECKING:
    from glid_nb.harmonic.map import HarmonicMap

Nowhere = Literal["away", "nan"]
"""For points without a preimage: a point far from the domain, or NaN."""

_MESH_VERTICES = 4000
_OVERHANG = 0.5  # the image of a curved boundary leaves its triangle by less than this share
_LINEAR = 0.02  # the same within the shape, where triangles cover everything
_STEPS = 40  # of Newton's method, halved ones included
_LONGEST = 0.02  # a step's length, as a share of the cage's longer side
_LAST = 1e-8  # after a step of this share, one evaluation is left
_SAME = 1e-9  # preimages of a point that are closer than this share of the cage's size are one
_FAR = 1e3  # longer sides to the point that stands for no preimage


@runtime_checkable
class Bounds(Protocol):
    """What a certificate says of a map."""

    certified: bool
    sigma2_lower: float
    sigma1_upper: float

    def belongs_to(self, map: Any) -> bool: ...


@dataclass(frozen=True, eq=False)
class Preimages:
    """Preimages of (k, 2) points: m of them, in the order of the points.

    The bounds hold for the map in exact arithmetic: its coefficients and the points are the
    binary64 numbers that they are, and all rounding is allowed for.
    """

    points: Array
    """(m, 2) preimages, coordinates of the domain."""
    index: Array
    """(m,) which of the given points each belongs to, increasing."""
    radius: Array
    """(m,) an exact preimage lies within this distance; inf where that is not proved.

    The disc lies in the offset cage. The exact preimage of a point on the image of the boundary may
    lie outside the cage by as much."""
    alone: Array
    """(m,) within this distance the map is proved injective, so there is one preimage only; 0 where
    that is not proved."""
    count: int = field(repr=False)
    """The number k of the points."""

    def __len__(self) -> int:
        return len(self.points)

    @property
    def found(self) -> Array:
        """(k,) how many preimages each of the given points has."""
        return np.bincount(self.index, minlength=self.count)

    @property
    def proved(self) -> Array:
        """(m,) bool: which preimages have a proved radius."""
        return np.isfinite(self.radius)


@dataclass(frozen=True, eq=False)
class Inverse:
    """The inverse of a map, as a function of points; ``map.inverse`` is one.

    Its inverse is the map: ``map.inverse.inverse is map``. `skimage.transform.warp` takes it as it
    is where the map's coordinates are pixels, as on `glid_nb.Domain.rectangle`.
    """

    map: "HarmonicMap"

    @property
    def inverse(self) -> "HarmonicMap":
        """The map itself."""
        return self.map

    @property
    def nowhere(self) -> Array:
        """(2,) the point that stands for no preimage: far to the lower left of the domain."""
        cage = self.map.domain.cage
        return np.array(cage.bounds[:2]) - _FAR * cage.longer_side

    @overload
    def __call__(
        self, points: Any, *, all: Literal[False] = False, outside: Nowhere = "away"
    ) -> Array: ...
    @overload
    def __call__(
        self, points: Any, *, all: Literal[True], outside: Nowhere = "away"
    ) -> Preimages: ...

    def __call__(self, points: Any, *, all: bool = False, outside: Nowhere = "away") -> Any:
        """(k, 2) preimages of (k, 2) points.

        If the image overlaps itself, a point there has several: one of them is returned, or with
        ``all=True`` all of them, as `Preimages`. A point outside the image has none: its row is
        :attr:`nowhere`, far away, or NaN with ``outside="nan"``. Raises a MapError for points that
        are not pairs of finite numbers.
        """
        if unmet(Nowhere, outside):
            raise MapError(f"outside must be 'away' or 'nan', not {outside!r:.40}")
        found = self.locate(points, all=all)
        if all:
            return found
        fill = self.nowhere if outside == "away" else np.full(2, np.nan)
        result = np.tile(fill, (found.count, 1))
        result[found.index] = found.points
        return result

    def residuals(self, src: Any, dst: Any) -> Array:
        """(k,) distances of the preimages of ``src`` from ``dst``, both (k, 2)."""
        return np.abs(as_complex(self(src)) - _paired(src, dst))

    def locate(self, points: Any, *, all: bool = False, certificate: Bounds | None = None) -> Any:
        """The `Preimages` of (k, 2) points, with their proved radii: one for each point that has
        any, or all.

        The radii come from bounds on the map close to each preimage. A certificate may add others:
        where sigma_2 >= s and sigma_1 <= S, a disc of radius R in the domain contains at most one
        preimage within R / (1 + S / s) of its middle. Raises a MapError for a certificate that
        proves nothing or belongs to another map.
        """
        check_type("all", all, bool, "write True for all preimages of each point", MapError)
        if certificate is not None:
            check_type("certificate", certificate, Bounds, "such as result.certificate", MapError)
            if not (certificate.certified and certificate.belongs_to(self.map)):
                raise MapError("the certificate belongs to another map, or proves nothing")
        w = as_complex(points)
        index, z, jets = self._searched(w, all)
        radius, alone = _proved(w[index], jets)
        if certificate is not None and len(z):
            gap = _gap(w[index], jets)
            radius, alone = _certified(self.map.domain, z, gap, radius, alone, certificate)
        places, index, radius, alone = (
            read_only(np.array(value)) for value in (as_points(z), index, radius, alone)
        )
        return Preimages(places, index, radius, alone, len(w))

    def transport(self, geometry: Any, *, tolerance: float | None = None, frame: Any = None) -> Any:
        """Geometries or labels of the image, back in the domain: `Transported`, as
        :meth:`HarmonicMap.transport` returns it."""
        return transport.transport(self.map, geometry, tolerance=tolerance, frame=frame, back=True)

    def displacement_field(self, frame: Any, shape: Any = None) -> Any:
        """The displacements of the inverse, as :meth:`HarmonicMap.displacement_field`."""
        return self.map.displacement_field(frame, shape, inverse=True)

    def nearby(self, w: Array) -> tuple[Array, Array, Jets, Array]:
        """Indices of (k,) complex points, their preimages in the domain or just beside it, the jets
        there, and the proved radii."""
        index, z, jets = self._searched(w, False)
        lost = np.flatnonzero(np.bincount(index, minlength=len(w)) == 0)
        if lost.size:
            images, vertices, reach = self._vertices
            distance, nearest = images.query(as_points(w[lost]))
            near = distance <= reach
            lost = lost[near]
            more, own, found = _newton(self.map, w[lost], vertices[nearest[near]])
            index, z = np.concatenate([index, lost[found]]), np.concatenate([z, more[found]])
            pairs = zip(jets, own.at(found), strict=True)
            jets = Jets(*(np.concatenate(pair) for pair in pairs))
            order = np.argsort(index)
            index, z, jets = index[order], z[order], jets.at(order)
        return index, z, jets, _proved(w[index], jets)[0]

    def _searched(self, w: Array, every: bool) -> tuple[Array, Array, Jets]:
        """Indices of points, their preimages in the domain, and the jets there."""
        which, starts, least = self._overlay.sources(as_points(w), self._overhang)
        order = np.lexsort((-least, which))
        which, z = which[order], starts[order] @ np.array([1, 1j])
        # The rank of each start among those of its point, the best first.
        rank = np.arange(len(which)) - np.searchsorted(which, which)
        kept: list[tuple[Array, Array, Jets]] = []
        open_ = np.ones(len(w), dtype=bool)
        while len(which):
            now = np.ones(len(which), dtype=bool) if every else rank == rank.min()
            self._try(w, which[now], z[now], kept, open_)
            rest = ~now & open_[which]
            which, z, rank = which[rest], z[rest], rank[rest]
        lost = np.flatnonzero(open_)
        if lost.size:
            images, vertices, reach = self._vertices
            distance, nearest = images.query(as_points(w[lost]))
            near = distance <= reach
            self._try(w, lost[near], vertices[nearest[near]], kept, open_)
        if not kept:
            nothing = np.zeros(0, dtype=complex)
            return np.zeros(0, dtype=int), nothing, jets_at(self.map, nothing)
        index, z = (np.concatenate([part[i] for part in kept]) for i in (0, 1))
        jets = Jets(*map(np.concatenate, zip(*(part[2] for part in kept), strict=True)))
        order = np.lexsort((np.imag(z), np.real(z), index))
        order = order[self._distinct(index[order], z[order])]
        return index[order], z[order], jets.at(order)

    def _try(self, w: Array, which: Array, starts: Array, kept: list[Any], open_: Array) -> None:
        """Add what Newton's method finds from some starts; what it finds is no longer open."""
        z, jets, found = _newton(self.map, w[which], starts)
        found[found] = self._contains(z[found])
        kept.append((which[found], z[found], jets.at(found)))
        open_[which[found]] = False

    def _contains(self, z: Array) -> Array:
        if len(z) < 100:
            return self.map.domain.cage.contains(as_points(z))
        return cover_of(self.map.domain).contains(self.map.domain, z)

    def _distinct(self, index: Array, z: Array) -> Array:
        """Which of the sorted preimages to keep: the first of several copies."""
        keep = np.ones(len(z), dtype=bool)
        for back in range(1, int(np.bincount(index).max(initial=0))):
            same = index[back:] == index[:-back]
            same &= np.abs(z[back:] - z[:-back]) <= _SAME * self.map.domain.cage.longer_side
            keep[back:] &= ~same
        return keep

    @functools.cached_property
    def _images(self) -> Array:
        _, images_of, _ = mesh_of(self.map.domain)
        return images_of(self.map)[0].astype(float)

    @functools.cached_property
    def _overlay(self) -> Overlay:
        return Overlay(mesh_of(self.map.domain)[0], self._images)

    @property
    def _overhang(self) -> Array:
        return mesh_of(self.map.domain)[2]

    @functools.cached_property
    def _vertices(self) -> tuple[Any, Array, float]:
        """A tree of the vertices' images, the vertices, and how far to look for them."""
        mesh = mesh_of(self.map.domain)[0]
        ends = self._images[mesh.triangles]
        longest = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=-1).max()
        return scipy.spatial.KDTree(self._images), mesh.vertices @ np.array([1, 1j]), longest


@functools.lru_cache(maxsize=4)
def mesh_of(domain: Domain) -> tuple[Triangulation, FixedPoints, Array]:
    """The mesh from which preimages are searched, and the overhang of each triangle."""
    mesh = triangulate(domain.cage, _MESH_VERTICES)
    at_boundary = (mesh.triangles < mesh.n_boundary).sum(axis=1) >= 2
    return mesh, FixedPoints(domain, mesh.vertices), np.where(at_boundary, _OVERHANG, _LINEAR)


def _newton(map: Any, w: Array, start: Array) -> tuple[Array, Jets, Array]:
    """Solutions of ``f(z) = w`` from (k,) starts, the jets there, and where it converged.

    A step that does not reduce the residual is halved.
    """
    side = map.domain.cage.longer_side
    z, best = np.array(start, dtype=complex), jets_at(map, start)
    best = Jets(*(np.array(values) for values in best))
    found, active = np.zeros(len(z), dtype=bool), np.arange(len(z))
    share = np.ones(len(z))
    # Points within rounding cannot be improved.
    limit = 4 * UNIT_ROUNDOFF * (np.abs(w) + np.abs(best.f))
    for _ in range(_STEPS):
        jets, target = best.at(active), w[active]
        step = _step(jets, target - jets.f)
        length = np.abs(step)
        with np.errstate(all="ignore"):
            step = step * np.minimum(share[active], _LONGEST * side / length)
        usable = np.isfinite(step)
        active, step = active[usable & (length > 0)], step[usable & (length > 0)]
        still = np.zeros(len(z), dtype=bool)
        still[np.flatnonzero(np.abs(w - best.f) <= limit)] = True
        found |= still
        if not len(active):
            break
        tried = z[active] + step
        new = jets_at(map, tried)
        before, after = np.abs(w[active] - best.f[active]), np.abs(w[active] - new.f)
        last = np.abs(step) <= _LAST * side
        better = after < before
        moved = active[better]
        z[moved] = tried[better]
        for values, improved in zip(best, new, strict=True):
            values[moved] = improved[better]
        share[active] = np.where(better, np.minimum(1, 2 * share[active]), share[active] / 2)
        found[active[last]] = True
        active = active[~last & (share[active] > 0.03)]
    return z, best, found


def _step(jets: Jets, residual: Array) -> Array:
    """The complex dz with ``f_z dz + f_zbar conj(dz) = residual``."""
    with np.errstate(all="ignore"):
        determinant = np.abs(jets.fz) ** 2 - np.abs(jets.fzb_conj) ** 2
        return (jets.fz.conj() * residual - (jets.fzb_conj * residual).conj()) / determinant


def _gap(w: Array, jets: Jets) -> Array:
    """Bounds ``|w - f(z)|``."""
    return np.abs(w - jets.f) * (1 + 8 * UNIT_ROUNDOFF) + jets.f_error + UNDERFLOW


def _proved(w: Array, jets: Jets) -> tuple[Array, Array]:
    """Lemma 29: radii within which there is a preimage, and within which there is only one."""
    s = jets.sigma2_lower
    with np.errstate(all="ignore"):
        gap = _gap(w, jets)
        reach = 2 * UPWARD * gap / s
        radius = UPWARD**2 * gap / (s - reach * jets.second)
        alone = np.minimum(jets.radius, s / jets.second) / UPWARD**2
        proved = (s > 0) & (reach < jets.radius) & (2 * UPWARD * reach * jets.second <= s)
    return np.where(proved, radius, np.inf), np.where(s > 0, np.nan_to_num(alone), 0.0)


def _certified(
    domain: Domain, z: Array, gap: Array, radius: Array, alone: Array, bounds: Bounds
) -> tuple[Array, Array]:
    """The better of the given radii and those from bounds on the whole domain (F. John)."""
    boundary, points = shapely.boundary(domain.cage.polygon), shapely.points(as_points(z))
    largest = float(np.abs(domain.cage.bounds).max())
    clear = shapely.distance(boundary, points) / UPWARD - 64 * UNIT_ROUNDOFF * largest
    clear = np.where(shapely.contains_properly(domain.cage.polygon, points), clear, 0)
    s, most = bounds.sigma2_lower, bounds.sigma1_upper
    reach = UPWARD * gap / s
    single = clear / (1 + most / s) / UPWARD if np.isfinite(most) else np.zeros(len(z))
    return (
        np.where(reach < clear, np.minimum(radius, reach), radius),
        np.maximum(alone, np.maximum(single, 0)),
    )


def _paired(src: Any, dst: Any) -> Array:
    """(k,) complex targets; a MapError if they are not as many as the sources."""
    a, b = as_complex(src), as_complex(dst)
    if len(a) != len(b):
        raise MapError(f"there are {len(a)} points src and {len(b)} points dst; give as many")
    return b


def residuals(map: Any, src: Any, dst: Any) -> Array:
    """(k,) distances of the images of ``src`` from ``dst``, both (k, 2)."""
    return np.abs(as_complex(map(src)) - _paired(src, dst))
