"""Bounded distortion harmonic mappings (Chen & Weber 2015), also for domains with holes."""
