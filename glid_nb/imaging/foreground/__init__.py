"""Separation of a picture's foreground from its background."""

from glid_nb.imaging.foreground.find import find_foreground as find_foreground
from glid_nb.imaging.foreground.score import Foreground as Foreground
from glid_nb.imaging.foreground.score import smoothed as smoothed
from glid_nb.imaging.foreground.scribbles import scaled_picture as scaled_picture
