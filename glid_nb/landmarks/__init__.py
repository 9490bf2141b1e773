"""Harmonic maps from landmarks, with the protocol of scikit-image's transforms."""

from glid_nb.landmarks.transform import HarmonicTransform, LandmarkError
