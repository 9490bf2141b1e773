"""A gecko seen from above: no holes, four legs and a tail that curls."""

import numpy as np
from numpy.typing import NDArray

from studies.samples import palette as hue
from studies.samples.bezier import Limb, Shape, along, blend, brush, disc, ellipse, tube
from studies.samples.faces import eye
from studies.samples.ink import Linear, Sheet

SIZE = (1400, 1400)
SPINE = [(1.78, 6.75, 0.82), (1.5, 6.0, 1.25), (1.02, 4.95, 1.5), (0.5, 3.7, 1.02),
         (0.1, 2.6, 1.14), (-0.05, 0.9, 1.42), (0.1, -0.8, 1.3), (0.45, -2.1, 1.04),
         (0.7, -3.3, 0.88), (0.4, -4.75, 0.77), (-0.6, -6.05, 0.67), (-2.4, -6.85, 0.59),
         (-4.35, -6.6, 0.52), (-5.35, -5.35, 0.47), (-4.8, -4.15, 0.43),
         (-3.6, -4.3, 0.4)]  # fmt: skip
# centre line and thickness of each leg, direction of its foot in degrees
LEGS = [
    ([(0.5, 2.5, 0.72), (2.45, 1.8, 0.66), (3.9, 1.95, 0.56), (4.95, 3.15, 0.46)], 58),
    ([(-0.3, 2.6, 0.72), (-2.2, 2.55, 0.66), (-3.75, 2.85, 0.56), (-4.8, 4.0, 0.46)], 130),
    ([(0.4, -1.6, 0.82), (2.3, -1.25, 0.72), (3.7, -1.9, 0.58), (4.4, -3.4, 0.46)], 298),
    ([(0.0, -1.5, 0.82), (-1.9, -1.0, 0.72), (-3.3, -0.45, 0.58), (-4.6, -0.95, 0.46)], 190),
]
TOES = (-58, 0, 58)
EYES = [(-0.2, 5.55, -0.25), (2.32, 4.85, 0.35)]  # x, y, sideways gaze


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    trunk = blend([tube(SPINE), *(tube(line) for line, _ in LEGS)], 0.45)
    feet = [foot(*line[-1][:2], way) for line, way in LEGS]
    whole = blend([trunk, *feet, *(disc(x, y, 0.82) for x, y, _ in EYES)], 0.14)

    sheet.fill(whole, Linear((-3, 6.5), (2.5, -6.5), (hue.LIME, hue.LEAF, hue.TEAL, hue.DEEP)))
    back = tube([(x, y, 0.62 * r) for x, y, r in SPINE])
    sheet.fill(whole.difference(back), hue.LIME, opacity=0.45, blur=0.3, within=whole)
    saddles(sheet, whole)
    for line, _ in LEGS:
        bands(sheet, line, whole)
    sheet.shade(whole, hue.PINE, depth=0.62, opacity=0.7)
    sheet.shade(whole, hue.CREAM, depth=0.36, opacity=0.5, towards_light=True)
    for line, way in LEGS:
        for spread in TOES:
            pad(sheet, *toe(*line[-1][:2], way + spread, 1.5), whole)
    face(sheet, whole)
    sheet.outline(whole, hue.INK, 0.13)
    for x, y, gaze in EYES:
        eye(sheet, x, y, 0.66, look=(gaze, 0.5), lid=hue.LEAF, droop=0.12, within=whole)
    return sheet.image(hue.INK)


def toe(x: float, y: float, degrees: float, reach: float) -> tuple[float, float]:
    """The point at distance `reach` from (x, y)."""
    a = np.radians(degrees)
    return float(x + reach * np.cos(a)), float(y + reach * np.sin(a))


def foot(x: float, y: float, degrees: float) -> Shape:
    """Three toes with round pads, fanned about a direction."""
    toes = []
    for spread in TOES:
        middle, end = (toe(x, y, degrees + spread, reach) for reach in (0.8, 1.5))
        toes.append(tube([(x, y, 0.44), (*middle, 0.37), (*end, 0.42)]))
    return blend(toes, 0.2)


def pad(sheet: Sheet, x: float, y: float, whole: Shape) -> None:
    """A shining adhesive pad at the end of a toe."""
    sheet.fill(disc(x, y, 0.34), hue.MUSTARD, blur=0.02, within=whole)
    sheet.fill(disc(x + 0.07, y - 0.09, 0.22), hue.AMBER, opacity=0.6, blur=0.06, within=whole)
    sheet.fill(disc(x - 0.08, y + 0.1, 0.09), hue.PAPER, opacity=0.85, blur=0.02, within=whole)


def bands(sheet: Sheet, line: Limb, whole: Shape) -> None:
    """Dark rings round a leg."""
    for p, u, n in zip(*along(line, [0.36, 0.52, 0.68, 0.84]), strict=True):
        ring = brush([p + 0.65 * n, p + 0.12 * u, p - 0.65 * n], 0.26, tip=0.5)
        sheet.fill(ring, hue.PINE, opacity=0.5, within=whole)


def saddles(sheet: Sheet, whole: Shape) -> None:
    """Coral saddles down the back with a cream bead on each."""
    at = np.concatenate([np.linspace(0.2, 0.46, 5), np.linspace(0.53, 0.955, 9)])
    radii = np.interp(at, np.linspace(0, 1, len(SPINE)), [r for *_, r in SPINE])
    for p, u, n, r in zip(*along(SPINE, at), radii, strict=True):
        ends = [p + 0.95 * r * n - 0.3 * r * u, p + 0.28 * r * u, p - 0.95 * r * n - 0.3 * r * u]
        sheet.fill(brush(ends, 0.68 * r + 0.04, tip=0.2), hue.BRICK, within=whole)
        sheet.fill(brush(ends, 0.47 * r + 0.02, tip=0.1), hue.CORAL, within=whole)
        bead = p + 0.16 * r * u
        sheet.fill(disc(bead[0], bead[1], 0.13 * r + 0.04), hue.CREAM, within=whole)


def face(sheet: Sheet, whole: Shape) -> None:
    """Nostrils and freckles."""
    for x, y in ((1.5, 7.0), (2.1, 6.85)):
        sheet.fill(ellipse(x, y, 0.1, 0.075, 60), hue.INK, within=whole)
    freckles = [(1.05, 5.75, 0.13), (1.35, 5.2, 0.15), (0.85, 5.15, 0.12), (1.1, 4.55, 0.14),
                (1.6, 4.6, 0.11), (1.62, 5.62, 0.1), (0.55, 4.6, 0.11)]  # fmt: skip
    for x, y, r in freckles:
        sheet.fill(ellipse(x, y, r * 1.2, r, 70), hue.PINE, opacity=0.5, within=whole)
