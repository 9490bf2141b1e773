"""The matrices of a solve: the basis at the panels' ends, midpoints and Hessian nodes.

A complex matrix ``D`` is stored as ``[Re D, -Im D]`` (the first row of Equation (15)). Then
``Re(D phi)`` is one real product, and so is ``Im(D phi) = Re(D (-i phi))``.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from glid_nb._jax import Array, Bool, Float, Int, jax
from glid_nb._runtime import double_precision, in_chunks, single_blas_thread, stage
from glid_nb.certificate import PROOFS, CertificateKind, PanelProof, rounding
from glid_nb.certificate.panels import split
from glid_nb.geometry import Domain, graded_panels, uniform_panels
from glid_nb.geometry.panels import Panels, paired
from glid_nb.harmonic import Basis, Singularities, basis_of, cauchy
from glid_nb.solvers.whitening import Whitening, whitened, whitening

Sampling = Literal["graded", "uniform"]

UNIFORM_SAMPLES = 10_000  # |G| of the paper (Section 10)
HESSIAN_STRIDE = 10  # |H| = |G| / 10 (Section 9.1)

# The Hessian's quadrature may be coarser than the energy's. Two panels share a node if together
# they are no longer than this many times their distance to the nearest singularity.
_PAIR_RATIO = 1.4
# Energies ignore rotation, so each node constrains one real component of f_z, not two. With few
# nodes per coordinate, functions that oscillate between the nodes would have no curvature.
_NODES_PER_COORDINATE = 2.25

# With more columns than this, one iteration takes as long as a tenth of its compilation.
_LARGE = 256
# Room for later splits: the factor by which the padded size exceeds the number of panels.
_GROWTH, _GROWTH_OF_LARGE = 1.25, 1.125
_MOST_PANELS = 20_000


class Matrices(NamedTuple):
    """The data that one Newton iteration reads (G.4): a JAX pytree, padded to buckets.

    Sizes: ``c`` padded columns, ``u`` padded coordinates, ``p`` padded panels, ``q`` midpoints
    (``p``, or 0 for the uniform sampling), ``h`` Hessian nodes. Padding panels have zero weight and
    never refuse a step. Basis matrices are stored transposed, because the products are then faster.
    """

    nodes: Float[Array, "2c p+q"]  # D at the panels' starts, then at their midpoints
    slopes: Float[Array, "2c p"]  # D' at the panels' starts
    hessian_index: Int[Array, " h"]  # the nodes of the Hessian's quadrature
    whitened: Float[Array, "2u h"]  # D T at these nodes; single precision is enough
    whitening: Float[Array, "2 c u"]  # T as (Re, Im)
    weights: Float[Array, " p+q"]  # quadrature at the nodes; they sum to 1 + `stiff`
    hessian_weights: Float[Array, " h"]
    proof: PanelProof  # the constants of the certificate on the panels
    rounding: Float[Array, " p"]  # error of carried values, divided by the largest coefficient
    chord: Float[Array, "2 p"]  # end - start as (Re, Im)
    next: Int[Array, " p"]
    real: Bool[Array, " p"]  # False for padding
    stiff: Float[Array, ""] | None = None
    """The sum that stiff areas add to the weights; None without stiff areas. Nodes inside stiff
    areas follow the panels' nodes."""


class _Rows(NamedTuple):
    """The values computed for each panel: one row per panel, no padding."""

    ends: np.ndarray
    slopes: np.ndarray
    middles: np.ndarray
    proof: PanelProof
    rounding: np.ndarray


@dataclass(frozen=True, eq=False)
class Discretisation:
    """A domain's boundary cut into panels, with the basis evaluated on them."""

    domain: Domain
    sampling: Sampling
    certificate: CertificateKind
    panels: Panels
    given: Matrices
    """The matrices as JAX arrays, or as NumPy arrays if they come from a pickle."""
    whitening: Whitening

    @functools.cached_property
    @double_precision
    def matrices(self) -> Matrices:
        """The matrices on the device."""
        return jax.device_put(self.given)

    def __getstate__(self) -> dict[str, Any]:
        """Pickle NumPy arrays: outside the package, JAX arrays would load in single precision."""
        known = {one.name: getattr(self, one.name) for one in fields(self)}
        return {**known, "given": jax.tree.map(np.asarray, self.given)}

    @property
    def basis(self) -> Basis:
        return basis_of(self.domain)

    @double_precision
    def full(self, m: Matrices) -> Matrices:
        """Use double precision for the Hessian; on graded panels, also all nodes of the energy."""
        if self.sampling == "graded":
            index = jax.device_put(np.arange(len(m.weights)))
            m = m._replace(hessian_index=index, hessian_weights=m.weights)
        whole = whitened(m.nodes, m.hessian_index, m.whitening, np.float64)
        return m._replace(whitened=jax.device_put(whole))

    @property
    def can_split(self) -> bool:
        """Whether panels may be split (the paper's uniform sampling is fixed)."""
        return self.sampling == "graded"

    def splittable(self, refused: np.ndarray) -> np.ndarray:
        """(p,) bool: the ``refused`` panels that can be halved; none beyond `_MOST_PANELS`."""
        chosen = refused[: len(self.panels)] & self.panels.divisible
        return chosen & (self.can_split and len(self.panels) + int(chosen.sum()) <= _MOST_PANELS)

    @double_precision
    def split(self, chosen: np.ndarray) -> Discretisation:
        """The discretisation with the panels of ``chosen`` (p,) bool cut in half."""
        basis, evaluated = self.basis, functools.partial(_evaluated, self.basis, self.certificate)
        panels, rows = split(self.panels, self._rows(), chosen, evaluated)
        size = len(self.matrices.real)
        if len(panels) > size:
            # A solve that splits panels usually splits more later. Room for them now saves one
            # compilation per size. On large problems the padding would cost more than compiling.
            # With few sizes, the restarts of a solve can share the compiled programs.
            small = basis.n_columns <= _LARGE
            size = _rung(len(panels)) if small else bucket(int(_GROWTH_OF_LARGE * len(panels)))
        kinds = self.sampling, self.certificate
        return _assembled(self.domain, *kinds, panels, rows, size, self.whitening)

    @double_precision
    def with_steep(self, chosen: np.ndarray) -> Discretisation:
        """Add coordinates for some of the steep columns left out so far, on the same panels."""
        m, w = self.matrices, self.whitening.with_steep(chosen, self.basis.n_hole_columns)
        weights, length = np.asarray(m.weights), self.panels.length / self.panels.length.sum()
        index, share = _hessian_nodes(self.panels, self.domain, length, weights, w.t)
        h = bucket(len(index))
        index = padded(index, h)
        on_host = {
            "hessian_index": index,
            "hessian_weights": padded(share, h, 0.0),
            "whitened": whitened(m.nodes, index, w.t, np.float32),
            "whitening": w.t,
        }
        return replace(self, given=m._replace(**jax.device_put(on_host)), whitening=w)

    def _rows(self) -> _Rows:
        """The rows from which the matrices were assembled; for the graded sampling only."""
        m, p, count = self.matrices, len(self.matrices.real), len(self.panels)

        def complex_rows(matrix: Any, first: int = 0) -> np.ndarray:
            re, minus_im = np.split(np.asarray(matrix)[:, first : first + count], 2)
            return (re - 1j * minus_im).T

        return _Rows(
            complex_rows(m.nodes),
            complex_rows(m.slopes),
            complex_rows(m.nodes, p),
            jax.tree.map(lambda a: np.asarray(a)[..., :count].T, m.proof),
            np.asarray(m.rounding)[:count],
        )


@functools.lru_cache(maxsize=8)
@double_precision
@single_blas_thread()
def discretise(
    domain: Domain, sampling: Sampling = "graded", certificate: CertificateKind = "hermite"
) -> Discretisation:
    """The discretisation with which a solve on ``domain`` starts (Algorithm 1, line 1).

    ``graded``: Simpson's rule on graded panels; the Hessian uses the midpoint rule on pairs of
    panels. ``uniform``: the plain mean over the paper's samples (31); the Hessian uses every tenth
    sample (33). The last few discretisations are cached."""
    stage("basis")
    basis, graded = basis_of(domain), sampling == "graded"
    panels = graded_panels(domain) if graded else uniform_panels(domain.cage, UNIFORM_SAMPLES)
    rows = _evaluated(basis, certificate, panels.start, panels.end, graded)
    return _assembled(domain, sampling, certificate, panels, rows, bucket(len(panels)))


def _evaluated(
    basis: Basis, certificate: CertificateKind, start: Any, end: Any, graded: bool = True
) -> _Rows:
    """Compute the rows of some panels. The uniform sampling has no midpoints."""

    def rows(start: Any, end: Any, singularities: Singularities) -> _Rows:
        middle = (start + end) / 2 if graded else start[:0]
        scale = rounding.panel_scale(start, end, singularities)
        return _Rows(
            cauchy.first_derivatives(start, singularities),
            cauchy.second_derivatives(start, singularities),
            cauchy.first_derivatives(middle, singularities),
            jax.tree.map(np.transpose, PROOFS[certificate].on(start, end, singularities)),
            rounding.carried_slack_factor(basis.n_columns) * scale,
        )

    return in_chunks(rows, basis.n_columns, (start, end), basis.singularities)


def _assembled(
    domain: Domain,
    sampling: Sampling,
    certificate: CertificateKind,
    panels: Panels,
    rows: _Rows,
    p: int,
    known: Whitening | None = None,
) -> Discretisation:
    """Assemble a discretisation with ``p`` padded panels.

    ``known`` is the whitening of the panels with which the solve began; None computes it.
    """
    count, length = len(panels), panels.length / panels.length.sum()
    if sampling == "graded":
        # In Simpson's rule, neighbours share their ends, which the certificate needs anyway.
        ends = length / 6
        np.add.at(ends, panels.next, length / 6)
        weights = np.concatenate([padded(ends, p, 0.0), padded(length * (4 / 6), p, 0.0)])
        nodes = np.concatenate([padded(rows.ends, p), padded(rows.middles, p)])
        along = rows.middles, length
    else:
        weights = padded(np.full(count, 1 / count), p, 0.0)
        nodes = padded(rows.ends, p)
        index = np.arange(0, count, HESSIAN_STRIDE)
        share = np.full(len(index), 1 / len(index))
        along = rows.ends[index], share
    # Each size is compiled separately.
    few_sizes = known is not None and basis_of(domain).n_columns <= _LARGE
    if known is None:
        stage("whitening")
        basis = basis_of(domain)
        (anchor,) = complex_basis(cauchy.cauchy_coordinates, panels.start[:1], basis)
        # The paper's settings use the whole subspace, as the paper does.
        known = whitening(*along, anchor, basis, whole=sampling == "uniform")
    t = known.t
    if sampling == "graded":
        index, share = _hessian_nodes(panels, domain, length, weights, t)
        h = p * (1 + (len(index) > p)) if few_sizes else bucket(len(index))
    else:
        h = -(-len(index) // 16) * 16
    index, chord, nodes = padded(index, h), panels.end - panels.start, real_columns(nodes)
    on_host = {
        "nodes": nodes,
        "slopes": real_columns(padded(rows.slopes, p)),
        "hessian_index": index,
        "whitened": whitened(nodes, index, t, np.float32),
        "whitening": t,
        "weights": weights,
        "hessian_weights": padded(share, h, 0.0),
        "proof": jax.tree.map(lambda part: np.ascontiguousarray(padded(part, p).T), rows.proof),
        "rounding": padded(rows.rounding, p),
        "chord": np.stack([padded(np.real(chord), p), padded(np.imag(chord), p)]),
        "next": padded(panels.next, p),
        "real": np.arange(p) < count,
    }
    # Unlike jnp.asarray, device_put compiles nothing.
    matrices = Matrices(**jax.device_put(on_host))
    return Discretisation(domain, sampling, certificate, panels, matrices, known)


def _hessian_nodes(
    panels: Panels, domain: Domain, length: np.ndarray, weights: np.ndarray, t: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The nodes of the Hessian's quadrature, as few as are enough, and their weights."""
    n_coordinates, n_unknown = np.count_nonzero(t.any(axis=(0, 1))), basis_of(domain).phi_free.sum()
    wanted = _NODES_PER_COORDINATE * n_coordinates
    p, count = len(weights) // 2, len(panels)
    middles = np.arange(p, p + count)
    first = np.flatnonzero(paired(panels, domain, _PAIR_RATIO))
    # If steep coordinates were left out, some of the others still oscillate from panel to panel.
    if n_coordinates == n_unknown and count - len(first) >= wanted:
        index, share = middles.copy(), length.copy()
        index[first] = first + 1
        share[first] += share[first + 1]
        kept = np.setdiff1d(np.arange(count), first + 1)
        return index[kept], share[kept]
    if count >= wanted:
        return middles, length
    every = np.concatenate([np.arange(count), middles])
    return every, weights[every]


def real_columns(rows: np.ndarray) -> np.ndarray:
    """``[Re D, -Im D]`` from the rows of ``D``, transposed: half of (15), (E.4) and (G.5)."""
    return np.ascontiguousarray(np.concatenate([np.real(rows), -np.imag(rows)], axis=1).T)


def bucket(count: int) -> int:
    """The padded size for ``count`` items: multiples of 128, above 512 16 sizes per octave."""
    wanted = count + count // 64
    step = 128 if wanted <= 512 else 1 << (wanted.bit_length() - 5)
    return max(-(-wanted // step) * step, 128)


def _rung(count: int) -> int:
    """The padded size after a split: one size per octave, with room for more panels."""
    return max(1 << int(_GROWTH * count).bit_length(), 128)


def padded(array: np.ndarray, size: int, fill: float | None = None) -> np.ndarray:
    """Extend the first axis of ``array`` to ``size`` with its first element or with ``fill``."""
    extra = size - len(array)
    value = array[:1] if fill is None else np.full_like(array[:1], fill)
    return np.concatenate([array, np.repeat(value, extra, axis=0)])


def complex_basis(kernel: Any, z: np.ndarray, basis: Basis) -> np.ndarray:
    return in_chunks(kernel, basis.n_columns, (z,), basis.singularities)
