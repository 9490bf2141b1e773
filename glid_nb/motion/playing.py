"""A motion as a page plays it, by the JavaScript module ``widgets/js/motion/motion.js``."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from glid_nb.harmonic import HarmonicMap, ShaderMap

if TYPE_CHECKING:
    from glid_nb.motion.motion import Motion


def playing(
    motion: Motion, wire: Callable[[HarmonicMap], bytes] | None = None
) -> tuple[dict[str, Any], bytes]:
    """What the page needs of a motion: plain JSON values, and float32 arrays, one after the other.

    The arrays are those of the maps at the knots, between which everything moves on straight
    lines: by default coefficients as `ShaderMap.wire` writes them. ``wire`` may write anything else
    that depends linearly on a map, such as images of vertices. The values:

    ``times``
        Of the knots, increasing, seconds; a ping-pong's way there only. Easing is in them.
    ``keyframes``
        Times of the keyframes, each of them also a knot's.
    ``repeat``, ``easing``
        As in the motion.
    ``sigma2``, ``sigma1``, ``k``
        Certified bounds on each piece between two knots; None where it is not proved.
    ``certified``, ``until``
        Whether all is proved, and the time before which it is.
    """
    pieces, certificate = motion.pieces_forth, motion.certificate
    wire = wire or ShaderMap(motion.domain).wire
    maps = [pieces[0].start_map, *(piece.end_map for piece in pieces)]
    proofs = certificate.pieces[: len(pieces)]
    values = {
        "times": [pieces[0].start, *(piece.end for piece in pieces)],
        "keyframes": list(motion.times[: len(motion.keyframes)]),
        "repeat": motion.repeat,
        "easing": list(motion.easing),
        "sigma2": [proof.sigma2_lower if proof.certified else None for proof in proofs],
        "sigma1": [proof.sigma1_upper if proof.certified else None for proof in proofs],
        "k": [proof.k_upper if proof.certified else None for proof in proofs],
        "certified": certificate.certified,
        "until": certificate.until,
    }
    return values, b"".join(map(wire, maps))
