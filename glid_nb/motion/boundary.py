"""A domain's boundary as motion needs it: continuous logarithms, and a projection on the basis."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb._runtime import double_precision
from glid_nb.geometry import Domain, uniform_panels
from glid_nb.geometry.panels import point_distance
from glid_nb.harmonic import basis_of, cauchy
from glid_nb.solvers.discretisation import complex_basis, discretise

_POINTS = 200  # boundary points at which images are compared
_ON_LINK = 128
# Closing periods should rather turn than scale: scaling has this weight relative to turning.
_SCALING = 5.0
_SMOOTH, _SMOOTH_PER_HOLE = 16, 4  # functions that close periods
# Most Newton steps; the gap is of second order in the difference of the keyframes. No step is taken
# if the gap, a coefficient of the logarithm, is below the second number.
_CLOSINGS, _CLOSED = 3, 1e-9


@dataclass(frozen=True, eq=False)
class Branch:
    """A loop's nodes by index, in order, and a path through the domain from another loop's node."""

    indices: Array
    linked: int = 0
    link: Array | None = None  # (q, n) ``D`` along the way from that node to the first


@dataclass(frozen=True, eq=False)
class Boundary:
    """Nodes on the boundary, the ends and middles of panels, with the basis on them."""

    domain: Domain
    points: Array  # (k,) even points of the boundary
    values: Array  # (k, n) ``C`` there
    first: Array  # (s, n) ``D`` at the nodes: ``f_z`` of phi, ``conj(f_zbar)`` of psi
    mean: Array  # (s,) weights of the nodes, which add up to 1
    branches: tuple[Branch, ...]
    """The exterior loop, then the holes, each after the loop that it hangs on."""
    single_valued: Array
    """(n, s) coefficients of the best fit from values at the nodes, without logarithms."""
    logarithms: Array
    """(N, s) likewise, scaled coefficients of the logarithms of the best fits to two functions."""
    with_logarithms: Array  # (n, N) what these add to the coefficients
    holomorphic: Array
    """(s, m) smooth single-valued functions at the nodes, for real coefficients. The sum of squared
    coefficients is the function's mean square, in which the real part has more weight."""
    periods: Array
    """(N, s) the logarithms' coefficients in the best fit to a function by itself: its periods."""

    def images(self, phi: Array, psi: Array) -> Array:
        """(k,) images of the even points."""
        return self.values @ phi + np.conj(self.values @ psi)

    def translated(self, phi: Array, by: complex) -> Array:
        """``phi`` of the map whose images are moved ``by``."""
        moved = phi.copy()
        moved[: self.domain.offset_cage.exterior.shape[0]] += by
        return moved

    def worst(self, phi: Array, psi: Array) -> Array:
        """The least sigma_2 at the nodes, times -1, and the largest k."""
        f, g = np.abs(self.first @ phi), np.abs(self.first @ psi)
        return np.array([(g - f).max(), (g / f).max()])

    def fitted(self, fz: Array, fzb_conj: Array) -> tuple[Array, Array]:
        """Coefficients of the map whose derivatives are nearest, in the mean square, at the nodes.

        For the holes ``phi_h = conj(psi_h)``; the part orthogonal to all other columns gives both.
        """
        both = np.stack([fz, fzb_conj], axis=1)
        h, h_conj = (self.logarithms @ both).T
        h += h_conj.conj()
        tied = np.stack([h, h.conj()], axis=1)
        phi, psi = (self.single_valued @ both + self.with_logarithms @ tied).T
        return phi, psi

    def closed(self, log: Array, nu: Array) -> Array:
        """``f_z`` so changed that one map has the derivatives ``f_z`` and ``nu f_z``.

        Around a hole the map must come back to its value: the periods of ``f_z dz`` and of ``f_zbar
        d conj(z)`` must add up to 0. A holomorphic function, small in the mean square, is added to
        ``log f_z``. That changes no ``|nu|``, so no k.
        """
        fz = np.exp(log)
        gap, change = self.gap(fz, nu)
        for _ in range(_CLOSINGS):
            if np.abs(gap).max(initial=0.0) <= _CLOSED:
                break
            x = np.linalg.lstsq(change, -gap)[0]
            closer = fz * np.exp(self.holomorphic @ x)
            before = np.linalg.norm(gap)
            gap, change = self.gap(closer, nu)
            if not np.linalg.norm(gap) < before:
                break  # too far for Newton's method; the projection shares the gap out
            fz = closer
        return fz

    def gap(self, fz: Array, nu: Array) -> tuple[Array, Array]:
        """(2 N,) what periods lack, and (2 N, m) its derivative by `holomorphic` functions."""
        a, b = self.periods * fz, self.periods * (nu * fz)
        gap: Any
        change: Any
        gap = a.sum(axis=1) - np.conj(b.sum(axis=1))
        change = a @ self.holomorphic - np.conj(b @ self.holomorphic)
        return np.concatenate([gap.real, gap.imag]), np.concatenate([change.real, change.imag])

    def logarithm(self, phi: Array, fz: Array) -> Array:
        """(s,) ``log f_z`` at the nodes, of one branch: continuous along loops and their links."""
        result = np.log(np.abs(fz)).astype(complex)
        for branch in self.branches:
            phase = np.unwrap(np.angle(fz[branch.indices]))
            if branch.link is not None:
                ends = fz[[branch.linked]], fz[branch.indices[:1]]
                along = np.unwrap(np.angle(np.concatenate([ends[0], branch.link @ phi, ends[1]])))
                phase += result[branch.linked].imag + along[-1] - along[0] - phase[0]
            result[branch.indices] += 1j * phase
        return result


@functools.lru_cache(maxsize=8)
@double_precision
def boundary_of(domain: Domain) -> Boundary:
    """The boundary of a domain; the last few are kept."""
    disc, basis = discretise(domain), basis_of(domain)
    columns, c, count = basis.columns, basis.n_columns, len(disc.panels)
    rows = np.asarray(disc.matrices.nodes)
    p = rows.shape[1] // 2
    chosen = np.concatenate([np.arange(count), p + np.arange(count)])
    first = (rows[:c][columns] - 1j * rows[c:][columns])[:, chosen].T
    mean = np.asarray(disc.matrices.weights)[chosen]
    t = np.asarray(disc.matrices.whitening)
    branches = _branches(domain, disc.panels.start, disc.panels.end, disc.panels.loop)
    whitening = (t[0] + 1j * t[1])[columns]
    *fit, q = _fit(first, mean, whitening, basis.n_hole_columns, domain.n_holes)
    loops = [branch.indices for branch in branches]
    fit[-1:-1] = [_smooth(q / np.sqrt(mean)[:, None], mean, loops)]
    points = uniform_panels(domain.cage, _POINTS).start
    values = complex_basis(cauchy.cauchy_coordinates, points, basis)[:, columns]
    return Boundary(domain, points, values, first, mean, branches, *fit)


def _fit(first: Array, mean: Array, t: Array, n_padded: int, n_holes: int) -> tuple[Array, ...]:
    """The matrices of the best fit, in whitened coordinates ``t``, where it is well conditioned."""
    root = np.sqrt(mean)[:, None]
    end = t.shape[1] - n_padded
    t_single = t[:, 1:end][:, np.any(t[:, 1:end] != 0, axis=0)]
    t_log = t[:, end : end + n_holes]
    q, r = np.linalg.qr(root * (first @ t_single))
    t_single = np.linalg.solve(r.T, t_single.T).T
    log = root * (first @ t_log)
    along = q.conj().T @ log
    rest = log - q @ along
    gram = 2 * np.real(rest.conj().T @ rest)
    single = (t_single @ q.conj().T) * root.T
    across = rest.conj().T * root.T
    logarithms = np.linalg.solve(gram, across) if n_holes else across
    periods = np.linalg.solve(rest.conj().T @ rest, across) if n_holes else across
    return single, logarithms, t_log - t_single @ along, periods, q


def _smooth(functions: Array, mean: Array, loops: Sequence[Array]) -> Array:
    """Of the span of orthonormal functions the smoothest along the loops, as `holomorphic`."""
    rises = np.concatenate([np.diff(functions[loop], axis=0) for loop in loops])
    gaps = np.concatenate([mean[loop[1:]] + mean[loop[:-1]] for loop in loops])
    _, turn = np.linalg.eigh(rises.conj().T @ (rises / gaps[:, None]))
    chosen = functions @ turn[:, : _SMOOTH + _SMOOTH_PER_HOLE * (len(loops) - 1)]
    parts, root = np.hstack([chosen, 1j * chosen]), np.sqrt(mean)[:, None]
    weighted = np.vstack([_SCALING * root * parts.real, root * parts.imag])
    lower = np.linalg.cholesky(weighted.T @ weighted)
    return np.linalg.solve(lower, parts.T).T


def _branches(domain: Domain, start: Array, end: Array, loop: Array) -> tuple[Branch, ...]:
    """Loops hang on each other by the shortest segments between them, which cross no other."""
    count = len(start)
    own = [np.flatnonzero(loop == i) for i in range(1 + domain.n_holes)]
    nodes = [np.stack([panels, count + panels], axis=1).ravel() for panels in own]
    rings = [shapely.LinearRing(corners) for corners in domain.cage.loops]
    branches, inside = [Branch(nodes[0])], {0}

    def panel_at(i: int, z: complex) -> int:
        return int(own[i][np.argmin(point_distance(np.array(z), start[own[i]], end[own[i]]))])

    while len(inside) < len(rings):
        pairs = [(i, j) for i in inside for j in range(len(rings)) if j not in inside]
        i, j = min(pairs, key=lambda pair: shapely.distance(rings[pair[0]], rings[pair[1]]))
        line = shapely.get_coordinates(shapely.shortest_line(rings[i], rings[j])) @ [1, 1j]
        near, far = panel_at(i, line[0]), panel_at(j, line[1])
        stops = np.array([start[near], *line, start[far]])
        steps = np.arange(1, 3 * _ON_LINK) / _ON_LINK
        x, y = (np.interp(steps, range(4), part) for part in (np.real(stops), np.imag(stops)))
        basis = basis_of(domain)
        link = complex_basis(cauchy.first_derivatives, x + 1j * y, basis)[:, basis.columns]
        first = 2 * int(np.flatnonzero(own[j] == far)[0])
        branches.append(Branch(np.roll(nodes[j], -first), near, link))
        inside.add(j)
    return tuple(branches)
