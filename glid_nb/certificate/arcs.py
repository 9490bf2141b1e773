"""Enclosures of the images of panels: bounds on how far an image is from its chord."""

from typing import Any, NamedTuple, Self

import numpy as np

from glid_nb._arrays import Array
from glid_nb.certificate import rounding
from glid_nb.certificate.panels import modulus
from glid_nb.certificate.paper import beside_by, derivative_bound_weights, jumps
from glid_nb.harmonic import HarmonicMap, Singularities, cauchy, run_on

# Roundings of the few operations made with the kernel's outputs, relative.
_FINAL_ROUNDING = 1 + 1e-12


class Jets(NamedTuple):
    """A map to second order at the starts of panels; every field is an array over the panels.

    Images are relative to the first coefficients, so a translation costs no accuracy. The errors
    hold for every unit direction and for starts beside their edge. ``third`` bounds the third
    derivative along the panel, times its length squared.
    """

    f: Array
    fz: Array
    fzb_conj: Array
    dfz: Array
    dfzb_conj: Array
    f_error: Array
    first_error: Array
    second_error: Array
    third: Array

    def at(self, index: Any) -> Self:
        return self._make(values[index] for values in self)

    def first(self, direction: Array) -> Array:
        return self.fz * direction + np.conj(self.fzb_conj * direction)

    def second(self, direction: Array) -> Array:
        square = direction**2
        return self.dfz * square + np.conj(self.dfzb_conj * square)


class Arcs(NamedTuple):
    """Images of panels, parametrised by the panel's arc length; every field is an array.

    ``error`` bounds the error of the images of the ends, ``tangent_error`` that of the tangents
    there. ``bend`` bounds the second derivative along the panel.
    """

    start: Array
    end: Array
    tangent_start: Array
    tangent_end: Array
    length: Array
    bend: Array
    error: Array
    tangent_error: Array

    @classmethod
    def between(cls, start: Array, end: Array, at_start: Jets, at_end: Jets) -> Self:
        """Images of the panels from ``start`` to ``end``, to which ``at_start.third`` applies."""
        length = np.abs(end - start)
        direction = (end - start) / np.where(length > 0, length, 1)
        # A function whose slope is at most K is at most (|start| + |end| + K l) / 2.
        slope = at_start.third / np.where(length > 0, length, np.inf)
        ends = (np.abs(jet.second(direction)) + jet.second_error for jet in (at_start, at_end))
        bend = (sum(ends) + slope) / 2
        return cls(
            at_start.f,
            at_end.f,
            at_start.first(direction),
            at_end.first(direction),
            length,
            bend * _FINAL_ROUNDING,
            np.maximum(at_start.f_error, at_end.f_error),
            np.maximum(at_start.first_error, at_end.first_error),
        )

    def at(self, index: Any) -> Self:
        return self._make(values[index] for values in self)

    @property
    def sagitta(self) -> Array:
        """``M l^2 / 8``: bounds the distance of exact image and chord at equal parameters."""
        return self.bend * self.length**2 / 8

    @property
    def radius(self) -> Array:
        return self.sagitta + self.error


def jets_of(map: HarmonicMap, start: Array, end: Array) -> Jets:
    """Jets at the complex points ``start``, with ``third`` for the panels to ``end``."""
    jets = run_on(map, _kernel, start.ravel(), end.ravel())
    return Jets(*(values.reshape(start.shape) for values in jets))


def _kernel(start: Any, end: Any, coefficients: Any, singularities: Singularities) -> Jets:
    edges = cauchy.edge_coefficients(coefficients, singularities)
    known: Any = rounding.derivatives(start, edges, singularities)
    first, second, first_off, second_off = known
    exterior = np.arange(coefficients.shape[1]) <= singularities.previous[0]
    local = coefficients - np.where(exterior, coefficients[:, :1], 0)
    values = cauchy.cauchy_coordinates(start, singularities) @ local.T
    slack: Any = rounding.slack_factor(coefficients.shape[1]) * modulus(local).max(axis=1).sum()
    third: Any = derivative_bound_weights(start, end, singularities, 2)
    third = third @ jumps(coefficients, singularities).sum(axis=0)
    # A start beside its edge changes these, by Taylor's theorem.
    off: Any = beside_by(singularities)
    bend, steep = (modulus(a).sum(axis=0) for a in (second, first))
    rest = third / (modulus(end - start) + 2 * off) ** 2 * off
    bend_off = off * (bend + rest)
    return Jets(
        values[:, 0] + np.conj(values[:, 1]),
        first[0],
        first[1],
        second[0],
        second[1],
        slack * _value_scale(start, singularities) + off * (steep + bend_off),
        first_off.sum(axis=0) + bend_off,
        second_off.sum(axis=0) + rest,
        third,
    )


def _value_scale(z: Any, singularities: Singularities) -> Any:
    """The sum of the moduli of all terms of ``C(z)``, as ``rounding.term_scale`` is for ``D(z)``.

    It uses ``|Log(B_{j+1} / B_j)| <= |ln |B_{j+1} / B_j|| + pi``, and adds 4 roundoffs.
    """
    vertices, following, _, rho = singularities
    b = modulus(vertices - z[:, None])
    edge = modulus(vertices[following] - vertices)
    logarithms = np.log(b)
    log = np.abs(logarithms[:, following] - logarithms) + np.pi + 4
    vertex_terms = (b[:, following] + b) * log / (2 * np.pi * edge)
    hole_terms = np.abs(np.log(modulus(z[:, None] - rho))) + 1
    return vertex_terms.sum(axis=1) + hole_terms.sum(axis=1)
