"""Motion between certified maps, proved at every instant."""

from glid_nb.motion.errors import MotionError
from glid_nb.motion.motion import Motion, MotionCertificate, Piece
from glid_nb.motion.settings import unlike_turns
