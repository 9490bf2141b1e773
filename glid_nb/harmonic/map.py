"""A harmonic map as a value."""

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arguments import check_count, check_type
from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs, real_array
from glid_nb._errors import InputError, about
from glid_nb._json import checked_version, read_json, write_json
from glid_nb._runtime import in_chunks
from glid_nb.geometry import Domain, as_points, loop_name, uniform_panels
from glid_nb.harmonic import cauchy
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import Singularities

R = TypeVar("R")

FORMAT = "glid_nb-map"
FORMAT_VERSION = 1
DOMAIN_KEYS = ("cage", "holes", "offset_cage", "offset_holes", "hole_points")

_LARGEST = 1e120  # squares of larger coefficients, times those of the basis, overflow


class MapError(InputError):
    """A harmonic map's coefficients, its file, or points to evaluate it at are not valid."""


@dataclass(frozen=True, eq=False, init=False)
class HarmonicMap(Rebuilt):
    """A planar harmonic map on a multiply-connected domain (paper Equation (8)).

    ``f(z) = sum_j C_j(z) phi_j + conj(sum_j C_j(z) psi_j)``, with the offset cage's vertices in
    the order of its loops first, then one logarithm per hole.
    """

    domain: Domain
    """Where the map lives."""
    phi: Array = field(repr=False)
    """(n,) complex coefficients up to 1e120, also those fixed to 0. For the holes ``phi_j =
    conj(psi_j)`` (Section 5) up to rounding, which is evened out; else a MapError says which."""
    psi: Array = field(repr=False)

    def __init__(self, domain: Domain, phi: ArrayLike, psi: ArrayLike) -> None:
        check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
        object.__setattr__(self, "domain", domain)
        n = domain.n_coefficients
        for name, given in (("phi", phi), ("psi", psi)):
            values = np.array(given, dtype=complex)
            if values.shape != (n,):
                wanted = f"pass {n} coefficients, for the offset cage's vertices and the holes"
                raise MapError(f"{name} has shape {values.shape}; {wanted}")
            largest = np.maximum(np.abs(np.real(values)), np.abs(np.imag(values)))
            bad = np.flatnonzero(~(largest <= _LARGEST))
            if bad.size:
                wanted = f"it must be finite and at most {_LARGEST:g}"
                raise MapError(f"{name}[{bad[0]}] is {values[bad[0]]}; {wanted}")
            object.__setattr__(self, name, values)
        holes = slice(n - domain.n_holes, n)
        gap = np.abs(self.phi[holes] - self.psi[holes].conj())
        scale = domain.cage.unit + np.abs(self.phi[holes])
        if (gap > 1e-9 * scale).any():
            worst = int(np.argmax(gap / scale))
            both = f"phi = {self.phi[holes][worst]}, psi = {self.psi[holes][worst]}"
            raise MapError(f"coefficients of hole {worst + 1} are not conjugate: {both}")
        # The map's values know only their sum, so the halves are made equal.
        uneven = np.flatnonzero(gap > 0) + holes.start
        self.phi[uneven] += (self.psi[uneven].conj() - self.phi[uneven]) / 2
        self.psi[uneven] = self.phi[uneven].conj()
        vars(self).update(phi=frozen(self.phi), psi=frozen(self.psi))

    @classmethod
    def identity(cls, domain: Domain) -> Self:
        """The identity map: ``phi`` = the exterior offset vertices, everything else 0."""
        check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
        exterior = domain.offset_cage.loops_complex[0]
        phi = np.zeros(domain.n_coefficients, dtype=complex)
        phi[: len(exterior)] = exterior
        return cls(domain, phi, np.zeros_like(phi))

    def __call__(self, points: ArrayLike) -> Array:
        """(k, 2) images of points, world coordinates; certified where ``domain.cage.contains``."""
        return as_points(run_on(self, _values, as_complex(points)))

    def wirtinger(self, points: ArrayLike) -> tuple[Array, Array]:
        """Wirtinger derivatives ``f_z`` and ``f_zbar``, each (k,) complex (Equation (9))."""
        fz, fzb_conj = run_on(self, _first, as_complex(points))
        return fz, fzb_conj.conj()

    def wirtinger_derivatives(self, points: ArrayLike, order: int) -> tuple[Array, Array]:
        """The ``order``-th complex derivatives of ``f_z`` and of ``conj(f_zbar)``, order >= 1."""
        check_count("order", order, 1, "derivatives")
        return run_on(self, functools.partial(_higher, order=order), as_complex(points))

    def sigma1(self, points: ArrayLike) -> Array:
        """Large singular value of the Jacobian, (k,) (Equation (2))."""
        fz, fzb = self.wirtinger(points)
        return np.abs(fz) + np.abs(fzb)

    def sigma2(self, points: ArrayLike) -> Array:
        """Signed small singular value ``|f_z| - |f_zbar|``, (k,); negative where it folds."""
        fz, fzb = self.wirtinger(points)
        return np.abs(fz) - np.abs(fzb)

    def k(self, points: ArrayLike) -> Array:
        """Little dilatation ``|f_zbar| / |f_z|``, (k,) (Section 3.2)."""
        fz, fzb = self.wirtinger(points)
        return np.abs(fzb) / np.abs(fz)

    def det(self, points: ArrayLike) -> Array:
        """Determinant of the Jacobian, ``|f_z|^2 - |f_zbar|^2``, (k,)."""
        fz, fzb = self.wirtinger(points)
        return np.abs(fz) ** 2 - np.abs(fzb) ** 2

    def distance(self, other: Self, n_points: int = 2000) -> float:
        """Largest distance between the images under two maps, at ``n_points`` boundary points.

        The components of the difference are harmonic, so their extremes lie on the boundary. The
        maps may have different offset cages.
        """
        check_type("other", other, HarmonicMap, "such as that of a result")
        points = as_points(uniform_panels(self.domain.cage, n_points).start)
        return float(np.linalg.norm(self(points) - other(points), axis=1).max())

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON values: format, version, the domain's loops, ``phi`` and ``psi``."""
        parts = {"phi": as_points(self.phi).tolist(), "psi": as_points(self.psi).tolist()}
        return {"format": FORMAT, "version": FORMAT_VERSION, **self.domain.to_dict(), **parts}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The map that :meth:`to_dict` wrote; raises MapError if the data is not valid."""
        checked_version(data, "map", FORMAT_VERSION, MapError)
        for key in (*DOMAIN_KEYS, "phi", "psi"):
            # A domain without one of its parts would choose it, and so have another basis.
            if key not in data or (data[key] is None and key not in ("phi", "psi")):
                raise MapError(f'the map lacks the key "{key}"')
        with about("the map's domain is not valid", MapError):
            domain = Domain.from_dict(data)
        given = [data["offset_cage"], *data["offset_holes"]]
        for i, (loop, kept) in enumerate(zip(given, domain.offset_cage.loops, strict=True)):
            # The coefficients follow the file's order of vertices.
            if not np.array_equal(real_array(loop), kept):
                wanted = "counter-clockwise" if i == 0 else "clockwise"
                raise MapError(f"the offset cage's {loop_name(i)} must run {wanted}")
        phi, psi = (complex_from_pairs(data[key], f'"{key}"') for key in ("phi", "psi"))
        return cls(domain, phi, psi)

    def save(self, path: str | Path) -> None:
        """Write the map as JSON, atomically."""
        write_json(path, self.to_dict())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a map written by :meth:`save`; MapError names the file and what is wrong there."""
        with about(path, MapError):
            return cls.from_dict(read_json(path))


def run_on(map: HarmonicMap, program: Callable[..., R], *points: Array) -> R:
    """``program(*points, rows, singularities)`` for a map's (2, c) rows, some points at a time."""
    basis = basis_of(map.domain)
    return in_chunks(program, basis.n_columns, points, rows_of(map), basis.singularities)


def rows_of(*maps: HarmonicMap) -> Array:
    """(k, c) padded phi and psi of maps of one domain, one after the other."""
    basis = basis_of(maps[0].domain)
    return np.stack([basis.pad(values) for map in maps for values in (map.phi, map.psi)])


def images_under(maps: Sequence[HarmonicMap], points: ArrayLike) -> Array:
    """(k, 2 m) images x, y of (k, 2) points under m maps of one domain, its basis computed once."""
    basis, columns = basis_of(maps[0].domain), np.ascontiguousarray(rows_of(*maps).T)

    def values(z: Any, columns: Any, singularities: Singularities) -> Array:
        parts = cauchy.cauchy_coordinates(z, singularities) @ columns
        return np.ascontiguousarray(parts[:, ::2] + np.conj(parts[:, 1::2])).view(float)

    return in_chunks(values, basis.n_columns, [as_complex(points)], columns, basis.singularities)


def as_complex(points: ArrayLike) -> Array:
    """(k, 2) real points, or an array of complex ones of any shape, as a (k,) complex array."""
    if hasattr(points, "dtype") and np.iscomplexobj(points):
        z = np.asarray(points, dtype=complex).ravel()
    else:
        array = number_pairs(points, "points must be (k, 2) coordinates", MapError)
        z = array[:, 0] + 1j * array[:, 1]
    bad = np.flatnonzero(~np.isfinite(z))
    if bad.size:
        raise MapError(f"point {bad[0]} is {z[bad[0]]}; coordinates must be finite")
    return z


def _values(z: Any, coefficients: Any, singularities: Singularities) -> Any:
    c = cauchy.cauchy_coordinates(z, singularities)
    return c @ coefficients[0] + np.conj(c @ coefficients[1])


def _first(z: Any, coefficients: Any, singularities: Singularities) -> tuple[Any, ...]:
    edges = cauchy.edge_coefficients(coefficients, singularities)
    return tuple((cauchy.first_by_edges(z, singularities) @ edges.T).T)


def _higher(z: Any, coefficients: Any, singularities: Singularities, order: int) -> Any:
    return tuple(cauchy.higher_derivative(z, c, singularities, order) for c in coefficients)


def complex_from_pairs(value: Any, name: str) -> Array:
    """[re, im] pairs as coefficients, bit for bit; the message of the MapError has the ``name``."""
    pairs = number_pairs(value, f"{name} must be a list of [re, im] pairs of numbers", MapError)
    return pairs.view(complex)[:, 0]  # keeps signed zeros and infinities
