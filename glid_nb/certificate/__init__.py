"""Proofs of local injectivity and certified distortion bounds (paper Section 8 and beyond)."""

from glid_nb.certificate import rounding as rounding
from glid_nb.certificate.bdhm import BDHM as BDHM
from glid_nb.certificate.certify import PROOFS as PROOFS
from glid_nb.certificate.certify import Certificate as Certificate
from glid_nb.certificate.certify import CertificateError as CertificateError
from glid_nb.certificate.certify import CertificateKind as CertificateKind
from glid_nb.certificate.certify import certificate_of as certificate_of
from glid_nb.certificate.certify import certify as certify
from glid_nb.certificate.certify import proved_by as proved_by
from glid_nb.certificate.hermite import Hermite as Hermite
from glid_nb.certificate.injectivity import GlobalInjectivity as GlobalInjectivity
from glid_nb.certificate.injectivity import global_injectivity as global_injectivity
from glid_nb.certificate.panels import EndValues as EndValues
from glid_nb.certificate.panels import PanelBounds as PanelBounds
from glid_nb.certificate.panels import PanelProof as PanelProof
from glid_nb.certificate.paper import Lipschitz as Lipschitz
from glid_nb.certificate.paper import fz_vanishes as fz_vanishes
