"""Bounded distortion harmonic mappings (Chen & Weber 2015), for multiply-connected domains too."""
