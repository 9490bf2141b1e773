"""Simplify the loops of an outline together, so that they stay disjoint.

The vertices are those that the algorithm of Ramer, Douglas and Peucker keeps. Libraries were tried
and lost: shapely lets loops come close and cuts off more; scikit-image takes one loop at a time.
"""

from glid_nb.imaging.simplify.choose import Simplified as Simplified
from glid_nb.imaging.simplify.choose import simplify as simplify
