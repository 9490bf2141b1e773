"""What is drawn of a picture: all inside its cage, or the shape cut out, and what lies behind."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from glid_nb._arguments import plain, unmet
from glid_nb._errors import InputError
from glid_nb.geometry import Cage
from glid_nb.imaging import PixelFrame, Tracing, as_rgba8
from glid_nb.imaging.backdrop import RGB, Backdrop, filled
from glid_nb.imaging.matte import cut_out, filled_loops

FILLED = "filled"
Behind = RGB | Literal["filled"] | None


@dataclass(frozen=True)
class Look:
    """How an editor draws its picture. Raises an InputError for another background."""

    cut_out: bool = True
    """Whether the shape of an opaque picture is cut out, with soft edges, as in `glid_nb.cut_out`.
    Otherwise all inside the cage is drawn."""
    background: Behind = None
    """What lies behind the shape: a colour (red, green, blue), each 0 to 255, ``"filled"`` for the
    picture with the hole filled in, as in `glid_nb.filled_in`, or None for transparent."""

    def __post_init__(self) -> None:
        if unmet(bool, self.cut_out):
            raise InputError(f"cut_out must be True or False, not {self.cut_out!r:.60}")
        given = plain(self.background)
        form = 'three whole numbers from 0 to 255, "filled" or None'
        limits: Any = {"least": 0, "most": 255, "form": form}
        if given not in (None, FILLED) and unmet(RGB, given, limits):
            raise InputError(f"background must be {form}, not {self.background!r:.60}")
        object.__setattr__(self, "background", given)


WHOLE_CAGE = Look(cut_out=False)
"""How pictures were drawn before version 6 of the session files."""


@dataclass(frozen=True, eq=False)
class Layers:
    """What is drawn of a picture (h, w, 4) with a cage, and the picture or colour behind.

    The tracing is None for a cage that was drawn by hand. Then all inside the cage is the shape.
    """

    picture: NDArray[np.uint8]
    tracing: Tracing | None
    cage: Cage
    look: Look

    @property
    def opaque(self) -> bool:
        """Whether the picture has no transparency of its own."""
        return bool((self.picture[..., 3] == 255).all())

    @functools.cached_property
    def image(self) -> NDArray[np.uint8]:
        """The picture that the map deforms."""
        if not self.look.cut_out or self.tracing is None or not self.opaque:
            return self.picture
        return as_rgba8(cut_out(self.picture, self.tracing, self.cage))

    def seen_as(self, look: Look) -> "Layers":
        """The same picture drawn in another way."""
        other = replace(self, look=look)
        if look.cut_out == self.look.cut_out and "image" in vars(self):
            vars(other)["image"] = self.image
        return other

    @functools.cached_property
    def background(self) -> Backdrop:
        """What lies behind it."""
        behind = self.look.background
        if behind != FILLED:
            return behind
        if not self.opaque:
            return None  # nothing of the background is known
        return filled(self.picture, self.hole)

    @property
    def hole(self) -> NDArray[np.bool_]:
        """(h, w) where the shape is taken out of its picture."""
        if self.look.cut_out and self.tracing is not None:
            return self.image[..., 3] > 0
        return filled_loops(self.cage, PixelFrame(*self.picture.shape[1::-1]))


def background_behind(layers: Sequence[Layers]) -> Backdrop:
    """What lies behind several shapes of one look.

    The look "filled" fills their common picture in; without a common one, or if it is transparent,
    nothing is known of the background.
    """
    picture, behind = layers[0].picture, layers[0].look.background
    if behind != FILLED:
        return behind
    if not layers[0].opaque or any(one.picture is not picture for one in layers):
        return None
    return filled(picture, np.logical_or.reduce([one.hole for one in layers]))
