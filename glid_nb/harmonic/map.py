"""A harmonic map as a value."""

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arguments import check_count, check_type, unmet
from glid_nb._arrays import Array, Rebuilt, frozen, real_array
from glid_nb._errors import about
from glid_nb._features import is_traced
from glid_nb._jax import jax, jnp
from glid_nb._json import checked_version, read_json, write_json
from glid_nb._runtime import in_chunks
from glid_nb.geometry import Domain, as_points, loop_name, uniform_panels
from glid_nb.harmonic import cauchy, transport
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.harmonic.inverse import Inverse, residuals
from glid_nb.harmonic.points import MapError, as_complex, complex_from_pairs
from glid_nb.harmonic.transport import DisplacementField, Transported

R = TypeVar("R")

Outside = Literal["extend", "nan"]
"""At points outside its domain, a map evaluates its formula, or gives NaN."""

FORMAT = "glid_nb-map"
FORMAT_VERSION = 1
DOMAIN_KEYS = ("cage", "holes", "offset_cage", "offset_holes", "hole_points")

_LARGEST = 1e120  # squares of larger coefficients, times those of the basis, overflow


@dataclass(frozen=True, eq=False, init=False)
class HarmonicMap(Rebuilt):
    """A planar harmonic map on a multiply-connected domain (Theorem 4.1, (3), (8), (G.2)).

    ``f(z) = sum_j C_j(z) phi_j + conj(sum_j C_j(z) psi_j)``. The offset cage's vertices come
    first, in the order of its loops, then one logarithm per hole.

    Points are (k, 2) world coordinates, or complex numbers x + iy. Nothing is certified outside the
    cage, and values beyond the offset cage mean nothing. ``outside="extend"``, the default,
    evaluates the formula there; ``outside="nan"`` gives NaN.

    The map and its derivatives also take arrays of JAX and return arrays of JAX: they can be
    differentiated, compiled and mapped, and take points of the shape (..., 2). They compute in the
    array's precision, by default single. NumPy's arrays and lists are computed in double precision.
    ``outside="nan"`` needs known points, so it does not work within ``jax.jit``.
    """

    domain: Domain
    """Where the map lives."""
    phi: Array = field(repr=False)
    """(n,) complex coefficients up to 1e120, including those fixed to 0.

    For the holes ``phi_j = conj(psi_j)`` (Section 5). Rounding differences are evened out; larger
    ones raise a MapError that names the hole."""
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
        # The map's values depend only on their sum, so the halves are made equal.
        uneven = np.flatnonzero(gap > 0) + holes.start
        self.phi[uneven] += (self.psi[uneven].conj() - self.phi[uneven]) / 2
        self.psi[uneven] = self.phi[uneven].conj()
        vars(self).update(phi=frozen(self.phi), psi=frozen(self.psi), _kept={})

    @property
    def kept(self) -> dict[str, Any]:
        """What other layers have computed of this map and keep with it, such as its certificate.

        It is no part of the value: copies and pickles come without.
        """
        return vars(self)["_kept"]

    @classmethod
    def identity(cls, domain: Domain) -> Self:
        """The identity map: ``phi`` = the exterior offset vertices, everything else 0."""
        check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
        exterior = domain.offset_cage.loops_complex[0]
        phi = np.zeros(domain.n_coefficients, dtype=complex)
        phi[: len(exterior)] = exterior
        return cls(domain, phi, np.zeros_like(phi))

    def __call__(self, points: Any, *, outside: Outside = "extend") -> Any:
        """(k, 2) images of points, world coordinates; certified where ``domain.cage.contains``."""
        return self._evaluated(images, points, outside)

    def wirtinger(self, points: Any, *, outside: Outside = "extend") -> tuple[Any, Any]:
        """Wirtinger derivatives ``f_z`` and ``f_zbar``, each (k,) complex ((9), (G.1), (G.3))."""
        fz, fzb_conj = self._evaluated(first, points, outside)
        return fz, fzb_conj.conj()

    def wirtinger_derivatives(
        self, points: Any, order: int, *, outside: Outside = "extend"
    ) -> tuple[Any, Any]:
        """The ``order``-th complex derivatives of ``f_z`` and of ``conj(f_zbar)``, order >= 1."""
        check_count("order", order, 1, "derivatives")
        return self._evaluated(functools.partial(_higher, order=order), points, outside)

    def sigma1(self, points: Any, *, outside: Outside = "extend") -> Any:
        """Large singular value of the Jacobian, (k,) (Equation (2))."""
        fz, fzb = self.wirtinger(points, outside=outside)
        return abs(fz) + abs(fzb)

    def sigma2(self, points: Any, *, outside: Outside = "extend") -> Any:
        """Small singular value ``|f_z| - |f_zbar|``, (k,) (2); negative where the map folds."""
        fz, fzb = self.wirtinger(points, outside=outside)
        return abs(fz) - abs(fzb)

    def k(self, points: Any, *, outside: Outside = "extend") -> Any:
        """Little dilatation ``|f_zbar| / |f_z|``, (k,) (Section 3.2)."""
        fz, fzb = self.wirtinger(points, outside=outside)
        return abs(fzb) / abs(fz)

    def det(self, points: Any, *, outside: Outside = "extend") -> Any:
        """Determinant of the Jacobian, ``|f_z|^2 - |f_zbar|^2``, (k,) (Section 3.2)."""
        fz, fzb = self.wirtinger(points, outside=outside)
        return abs(fz) ** 2 - abs(fzb) ** 2

    def _evaluated(self, program: Callable[..., Any], points: Any, outside: Outside) -> Any:
        """``program(z, rows, singularities)`` at points; with "nan", NaN outside the domain."""
        if unmet(Outside, outside):
            raise MapError(f"outside must be 'extend' or 'nan', not {outside!r:.40}")
        of_jax = is_of_jax(points)
        if of_jax:
            values = on_jax(self.domain, rows_of(self), program, points)
        else:
            z = as_complex(points)
            values = run_on(self, program, z)
        if outside == "extend":
            return values
        inside = self.domain.cage.contains(_known(points) if of_jax else as_points(z))
        parts = values if isinstance(values, tuple) else (values,)
        left = tuple(_only(part, inside) for part in parts)
        return left if isinstance(values, tuple) else left[0]

    @property
    def inverse(self) -> Inverse:
        """The inverse as a function: ``map.inverse(points)`` are the preimages of points.

        Newton's method finds them; :meth:`Inverse.locate` returns them with a proved radius. The
        map needs no certificate.
        """
        return self.kept.setdefault("inverse", Inverse(self))

    def residuals(self, src: Any, dst: Any) -> Array:
        """(k,) distances of the images of ``src`` from ``dst``, both (k, 2), as scikit-image's
        transforms have them."""
        return residuals(self, src, dst)

    def transport(
        self, geometry: Any, *, tolerance: float | None = None, frame: Any = None
    ) -> Transported:
        """Carry geometries of the domain through the map; ``map.inverse.transport`` carries back.

        ``geometry`` is one of shapely or an array of them, GeoJSON, a list of polygons as (k, 2)
        arrays, all in the map's coordinates, or a label image: (h, w) whole numbers, with the
        ``frame`` of its pixels, such as a `PixelFrame`. Each pixel takes the label that its centre
        comes from, 0 from outside.

        Edges are divided until every chord is within the tolerance of the true curve, by default a
        thousandth of the cage's unit; rounding included. Parts outside the domain are cut off and
        counted. What is simple stays simple where the map is injective; `Transported` names the
        geometries that are not. Raises a TransportError, which names the geometry.
        """
        return transport.transport(self, geometry, tolerance=tolerance, frame=frame)

    def displacement_field(
        self, frame: Any, shape: Any = None, *, inverse: bool = False
    ) -> DisplacementField:
        """Sample the map as displacements, in pixels of a frame (a `PixelFrame`).

        ``shape`` is the grid's (rows, columns), by default one sample for each pixel. Programs that
        resample pictures, such as ITK, ask for the inverse. The field states the largest error of
        interpolation.
        """
        return transport.displacement_field(self, frame, shape, inverse=inverse)

    def distance(self, other: Self, n_points: int = 2000) -> float:
        """Largest distance between the images under two maps, at ``n_points`` boundary points.

        The components of the difference are harmonic, so they are extreme on the boundary. The maps
        may have different offset cages.
        """
        check_type("other", other, HarmonicMap, "for example result.map")
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
            # Without one of its parts a domain would choose it, and then has another basis.
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
    """(k, 2 m) images x, y of (k, 2) points under m maps of one domain (G.2); the basis is computed
    once."""
    basis, columns = basis_of(maps[0].domain), np.ascontiguousarray(rows_of(*maps).T)

    def values(z: Any, columns: Any, singularities: Singularities) -> Array:
        parts = cauchy.cauchy_coordinates(z, singularities) @ columns
        return np.ascontiguousarray(parts[:, ::2] + np.conj(parts[:, 1::2])).view(float)

    return in_chunks(values, basis.n_columns, [as_complex(points)], columns, basis.singularities)


def on_jax(domain: Domain, rows: Any, program: Callable[..., Any], points: Any) -> Any:
    """``program`` by JAX for (2, c) rows, at (..., 2) real or (...) complex points. All may be
    traced."""
    if points.dtype.kind == "c":
        z = points
    elif points.shape[-1:] == (2,) and points.dtype.kind in "fiu":
        z = points[..., 0] + 1j * points[..., 1]
    else:
        given = f"{points.dtype.name} of the shape {points.shape}"
        raise MapError(f"points must be (..., 2) coordinates or complex numbers, not {given}")
    known = basis_of(domain).singularities
    # As arrays of JAX: NumPy's would be compiled in, in the precision of the first call.
    rows, vertices, holes = (
        jnp.asarray(a.astype(z.dtype)) for a in (rows, known.vertices, known.hole_points)
    )
    after, before = (jnp.asarray(a.astype(np.int32)) for a in (known.next, known.previous))
    values = program(z.ravel(), rows, Singularities(vertices, after, before, holes))
    parts = values if isinstance(values, tuple) else (values,)
    shaped = tuple(part.reshape(z.shape + part.shape[1:]) for part in parts)
    return shaped if isinstance(values, tuple) else shaped[0]


def is_of_jax(points: Any) -> bool:
    """Whether points are an array of JAX, or are traced by it; without importing it."""
    return type(points).__module__.startswith("jax") and isinstance(points, jax.Array)


def _known(points: Any) -> Array:
    """(..., 2) NumPy points of an array of JAX; a MapError while it is traced."""
    if is_traced(points):
        what = "outside='nan' needs points that are known, but JAX traces these"
        raise MapError(f"{what}; ask domain.cage.contains before, and use jax.numpy.where")
    known = np.asarray(points)
    return as_points(known) if np.iscomplexobj(known) else known


def _only(values: Any, inside: Array) -> Any:
    """The values with NaN at the points that are not inside."""
    mask = inside.reshape(inside.shape + (1,) * (values.ndim - inside.ndim))
    nothing = complex(np.nan, np.nan) if values.dtype.kind == "c" else np.nan
    return values.__array_namespace__().where(mask, values, nothing)


def _values(z: Any, coefficients: Any, singularities: Singularities) -> Any:
    c = cauchy.cauchy_coordinates(z, singularities)
    return c @ coefficients[0] + (c @ coefficients[1]).conj()


def images(z: Any, coefficients: Any, singularities: Singularities) -> Any:
    """(k, 2) images."""
    w = _values(z, coefficients, singularities)
    if isinstance(w, np.ndarray):
        return as_points(w)
    xp = w.__array_namespace__()
    return xp.stack([xp.real(w), xp.imag(w)], axis=-1)


def first(z: Any, coefficients: Any, singularities: Singularities) -> tuple[Any, ...]:
    """``f_z`` and ``conj(f_zbar)``, each (k,)."""
    edges = cauchy.edge_coefficients(coefficients, singularities)
    return tuple((cauchy.first_by_edges(z, singularities) @ edges.T).T)


def _higher(z: Any, coefficients: Any, singularities: Singularities, order: int) -> Any:
    return tuple(cauchy.higher_derivative(z, c, singularities, order) for c in coefficients)
