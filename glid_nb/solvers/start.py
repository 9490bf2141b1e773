"""What a map must be for a method to go on from it."""

from __future__ import annotations

from glid_nb._errors import InputError
from glid_nb.certificate import certify
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap


class StartError(InputError):
    """The map to start from cannot be used."""


def check_belongs(map: HarmonicMap, domain: Domain) -> None:
    """Raise :class:`StartError` for a map of another domain; equal domains are the same."""
    if map.domain is not domain and map.domain.to_dict() != domain.to_dict():
        raise StartError(
            "the map to start from belongs to another domain; start from a map of this one"
        )


def check_proved(map: HarmonicMap) -> None:
    """Raise :class:`StartError` for a map that is not proved locally injective."""
    certificate = certify(map)
    if not certificate.certified:
        raise StartError(f"the map to start from is not certified: {certificate.reason}")
