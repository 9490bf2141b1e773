"""Motion between certified maps, proved at every instant."""

from glid_nb.motion.curve import Piece as Piece
from glid_nb.motion.motion import Motion as Motion
from glid_nb.motion.motion import MotionCertificate as MotionCertificate
from glid_nb.motion.settings import MotionError as MotionError
