"""Eyes and cheeks, the same on every character."""

from studies.samples import palette as hue
from studies.samples.bezier import Shape, disc, ellipse
from studies.samples.ink import Colour, Linear, Sheet


def eye(
    sheet: Sheet,
    x: float,
    y: float,
    radius: float,
    *,
    look: tuple[float, float] = (0.0, 0.0),
    lid: Colour | None = None,
    droop: float = 0.3,
    iris: tuple[str, str] = (hue.AMBER, hue.MUSTARD),
    within: Shape,
) -> None:
    """Draw a round eye: eyeball, iris, pupil, two catch lights and, with `lid`, an upper lid.

    `look` is the direction of the gaze; a vector of length 1 moves the iris to the rim. `droop` is
    the share of the eyeball under the lid.
    """
    rim, ball = disc(x, y, radius), disc(x, y, radius * 0.88)
    sheet.fill(rim, hue.INK, within=within)
    sheet.fill(ball, hue.PAPER, within=within)
    sheet.fill(ball.difference(disc(x, y - radius * 0.22, radius * 0.86)), hue.PLUM, opacity=0.35,
               blur=radius * 0.08, within=ball)  # fmt: skip
    ix, iy = x + look[0] * radius * 0.24, y + look[1] * radius * 0.24
    ring, pupil = disc(ix, iy, radius * 0.68), disc(ix, iy, radius * 0.43)
    sheet.fill(ring, hue.INK, within=ball)
    glow = Linear((ix, iy + radius * 0.5), (ix, iy - radius * 0.6), iris)
    sheet.fill(disc(ix, iy, radius * 0.61), glow, within=ball)
    sheet.fill(pupil, hue.INK, within=ball)
    if lid is not None:
        open_ = ellipse(x, y - 2 * radius * droop - radius * 0.1, radius * 1.25, radius * 1.1)
        sheet.fill(ball.difference(open_.buffer(-radius * 0.09)), hue.INK, within=within)
        sheet.fill(ball.difference(open_), lid, within=within)
        sheet.fill(rim.difference(disc(x, y, radius * 0.87)), hue.INK, within=within)
    catch = disc(ix - radius * 0.24, iy + radius * 0.2, radius * 0.21)
    sheet.fill(catch, hue.PAPER, within=ball)
    sheet.fill(disc(ix + radius * 0.26, iy - radius * 0.24, radius * 0.1), hue.PAPER, within=ball)


def blush(sheet: Sheet, x: float, y: float, rx: float, ry: float, within: Shape) -> None:
    """Tint a cheek."""
    sheet.fill(ellipse(x, y, rx, ry), hue.CORAL, opacity=0.6, blur=rx * 0.3, within=within)
