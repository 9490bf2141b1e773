"""Proofs of local injectivity and certified distortion bounds (paper Section 8 and beyond)."""

from glid_nb.certificate import bdhm, hermite, lipschitz, rounding
from glid_nb.certificate.bounds import EndValues, PanelBounds, derivative_bound_weights
from glid_nb.certificate.certify import (
    METHODS,
    Certificate,
    Method,
    PanelCertificate,
    certify,
)
from glid_nb.certificate.injectivity import GlobalInjectivity, global_injectivity

__all__ = [
    "METHODS",
    "Certificate",
    "EndValues",
    "GlobalInjectivity",
    "Method",
    "PanelBounds",
    "PanelCertificate",
    "bdhm",
    "certify",
    "derivative_bound_weights",
    "global_injectivity",
    "hermite",
    "lipschitz",
    "rounding",
]
