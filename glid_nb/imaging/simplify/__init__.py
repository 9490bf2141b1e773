"""Simplify the loops of an outline together, so that they stay disjoint.

The vertices are those that the algorithm of Ramer, Douglas and Peucker keeps. Libraries were tried
on the outlines of the samples and of scikit-image's pictures. shapely's topology-preserving
simplification lets loops come arbitrarily close and, with as many vertices, cuts off 0.2 to 0.3 %
of a gecko or a horse. Its `coverage_simplify` cuts off twice that and fails on one outline.
scikit-image's `approximate_polygon` works for one tolerance and one loop at a time. Each would save
fewer than 100 lines and change every cage.
"""

from glid_nb.imaging.simplify.choose import Simplified as Simplified
from glid_nb.imaging.simplify.choose import simplify as simplify
