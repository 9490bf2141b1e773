"""Audits of warps from anywhere: displacement fields, triangle meshes, functions."""

from glid_nb.auditing.dispatch import audit
from glid_nb.auditing.files import Warp, read_warp
from glid_nb.auditing.result import Audit

__all__ = ["Audit", "Warp", "audit", "read_warp"]
