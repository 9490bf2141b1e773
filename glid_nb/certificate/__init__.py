"""Proofs of local injectivity and certified distortion bounds (paper Section 8 and beyond)."""

from glid_nb.certificate import rounding
from glid_nb.certificate.certify import PROOFS, Certificate, certificate_of, certify, proved_by
from glid_nb.certificate.certify import CertificateKind as CertificateKind
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.injectivity import GlobalInjectivity, global_injectivity
from glid_nb.certificate.panels import EndValues, PanelBounds, PanelProof
from glid_nb.certificate.paper import BDHMLipschitz, Lipschitz, fz_vanishes
from glid_nb.certificate.pieces import PieceCertificate as PieceCertificate
from glid_nb.certificate.pieces import certify_step as certify_step
from glid_nb.certificate.radius import safe_radius as safe_radius
