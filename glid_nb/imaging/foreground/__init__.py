"""Telling a picture's foreground from its background, one method a file."""

from glid_nb.imaging.foreground.find import find_foreground as find_foreground
from glid_nb.imaging.foreground.find import smoothed as smoothed
from glid_nb.imaging.foreground.score import Foreground as Foreground
from glid_nb.imaging.foreground.walker import Walker as Walker
