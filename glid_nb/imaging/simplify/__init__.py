"""Simplifying the loops of an outline together, so that they stay the loops of a cage."""

from glid_nb.imaging.simplify.loops import Simplified as Simplified
from glid_nb.imaging.simplify.loops import simplify as simplify
