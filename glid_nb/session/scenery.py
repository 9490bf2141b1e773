"""The shapes around the edited one: what a canvas draws of them, and which one is pressed."""

from collections.abc import Sequence
from dataclasses import dataclass

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Order, Sheets, order_of


@dataclass(frozen=True, eq=False)
class Scenery:
    """A shape that is drawn but not edited."""

    key: str  # tells the shapes apart; a shape keeps it for its whole life
    picture: Array
    """(h, w, 4) uint8, of the same size as the edited shape's picture."""
    map: HarmonicMap
    order: Order | None = None  # of its parts among themselves; by default that without depths
    above: bool = False  # whether it lies in front of the edited shape
    name: str = ""

    @property
    def sheets(self) -> Sheets:
        """The deformed shape, for finding what is visible at a place."""
        order = order_of(self.map.domain.cage) if self.order is None else self.order
        return Sheets(self.map, order, self.picture)


def pressed(point: Array, edited: Sheets, scenery: Sequence[Scenery]) -> Scenery | None:
    """The visible shape at a point (2,); None if that is the edited one, or if there is none.

    ``scenery`` is in drawing order, the backmost first. Transparent pixels are not visible.
    """
    above = [shape for shape in scenery if shape.above]
    behind = [shape for shape in scenery if not shape.above]
    front = _topmost(point, above)
    if front is not None or edited.visible(point) is not None:
        return front
    return _topmost(point, behind)


def _topmost(point: Array, scenery: Sequence[Scenery]) -> Scenery | None:
    seen = (shape for shape in reversed(scenery) if shape.sheets.visible(point) is not None)
    return next(seen, None)
