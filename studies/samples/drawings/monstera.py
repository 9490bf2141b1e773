"""A monstera leaf on its stem, with a ladybird on it: eight holes between the veins."""

from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity

from studies.samples import bezier as form
from studies.samples import palette as hue
from studies.samples.faces import eye
from studies.samples.ink import Linear, Sheet

SIZE = (1350, 1350)
STEM = [(-1.9, -7.15, 0.48), (-1.4, -6.15, 0.45), (-0.65, -4.9, 0.42), (-0.15, -3.4, 0.42),
        (0.0, -1.5, 0.45)]  # fmt: skip
MIDRIB: form.Limb = [(-1.2, -5.8, 0.02), (-0.15, -3.4, 0.12), (0.0, -1.5, 0.2), (0.05, 1.0, 0.2),
                (0.2, 4.0, 0.17), (0.35, 6.0, 0.11), (0.7, 7.1, 0.03)]  # fmt: skip
HEART: form.Limb = [(0.0, -1.7, 0.9), (0.05, 1.0, 1.2), (0.15, 3.6, 1.2), (0.3, 5.4, 1.2),
               (0.65, 6.85, 0.42)]  # fmt: skip
# side veins of either half from the midrib to the end of the lobe, base first
HALVES: list[list[form.Points]] = [
    [
        [(-0.05, -2.2), (1.35, -3.1), (2.3, -4.4), (2.4, -5.6)],
        [(0.0, -1.7), (2.5, -1.75), (4.7, -2.5), (5.6, -2.6)],
        [(0.0, -0.5), (2.8, 0.15), (5.0, 0.05), (6.1, 0.4)],
        [(0.05, 1.0), (2.6, 2.2), (4.6, 2.55), (5.6, 3.2)],
        [(0.15, 2.6), (2.0, 4.2), (3.6, 4.95), (4.3, 5.8)],
    ],
    [
        [(-0.05, -2.2), (-1.7, -3.0), (-2.95, -4.1), (-3.35, -5.2)],
        [(0.0, -1.7), (-2.6, -1.5), (-4.9, -1.95), (-5.85, -1.9)],
        [(0.0, -0.5), (-2.8, 0.45), (-5.0, 0.65), (-6.0, 1.2)],
        [(0.05, 1.0), (-2.5, 2.5), (-4.4, 3.1), (-5.2, 3.9)],
        [(0.15, 2.6), (-1.7, 4.4), (-3.0, 5.35), (-3.5, 6.3)],
    ],
]
LADYBIRD = (0.28, 4.85, 76.0)  # x, y, heading in degrees


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    veins = [vein for half in HALVES for vein in half]
    heart = form.tube(HEART)
    blade = form.blend([heart, *(lobe(vein) for vein in veins)], 0.3)
    blade = shapely.Polygon(shapely.get_parts(blade)[0].exterior)
    for half in HALVES:
        for low, high in pairwise(half):
            blade = blade.difference(window(low, high))
    stem = form.tube(STEM)
    whole = form.blend([blade, stem], 0.15)

    sheet.fill(whole, Linear((-4, 6.5), (3.5, -6), (hue.LIME, hue.LEAF, hue.MOSS, hue.TEAL)))
    for vein in veins:
        fold(sheet, vein, blade)
    sheet.shade(whole, hue.PINE, depth=0.6, opacity=0.6)
    sheet.shade(whole, hue.PALE, depth=0.4, opacity=0.6, towards_light=True)
    for vein in veins:
        sheet.fill(
            form.moved(form.brush(vein, 0.16), 0.03, -0.05), hue.PINE, opacity=0.5, within=whole
        )
        sheet.fill(form.brush(vein, 0.14), hue.PALE, within=whole)
    rib = form.tube(MIDRIB)
    sheet.fill(form.moved(rib, 0.06, -0.04), hue.PINE, opacity=0.5, within=whole)
    sheet.fill(rib, hue.PALE, within=whole)
    sheet.outline(whole, hue.INK, 0.13)
    ladybird(sheet, whole)
    return sheet.image(hue.INK)


def lobe(vein: form.Points) -> form.Shape:
    """The part of the blade around a side vein, widest before its end."""
    places, _, _ = form.along(vein, [0.0, 0.25, 0.5, 0.75, 0.9, 0.98])
    return form.tube(np.column_stack([places, [0.5, 0.85, 0.95, 0.92, 0.72, 0.42]]))


def window(low: form.Points, high: form.Points) -> form.Shape:
    """A long hole half way between two veins, parallel to them."""
    at = [0.3, 0.4, 0.47]
    middle = (form.along(low, at)[0] + form.along(high, at)[0]) / 2
    return form.tube(np.column_stack([middle, [0.38, 0.47, 0.4]]))


def fold(sheet: Sheet, vein: form.Points, blade: form.Shape) -> None:
    """Shade the lower side of a vein and lighten the upper side."""
    widths = [0.1, 0.3, 0.3, 0.1]
    dark = [(x + 0.1, y - 0.34, r) for (x, y), r in zip(vein, widths, strict=True)]
    light = [(x - 0.1, y + 0.34, r) for (x, y), r in zip(vein, widths, strict=True)]
    sheet.fill(form.tube(dark), hue.PINE, opacity=0.38, blur=0.13, within=blade)
    sheet.fill(form.tube(light), hue.LIME, opacity=0.5, blur=0.14, within=blade)


def ladybird(sheet: Sheet, whole: form.Shape) -> None:
    """A ladybird on its way to the tip, drawn facing right and then turned."""
    x, y, heading = LADYBIRD

    def placed(shape: form.Shape) -> form.Shape:
        small = affinity.scale(shape, 0.88, 0.88, origin=(0, 0))
        return form.moved(form.turned(small, heading, (0, 0)), x, y)

    shell = placed(form.ellipse(0, 0, 0.88, 0.74))
    sheet.fill(form.moved(shell, 0.15, -0.3), hue.PINE, opacity=0.6, blur=0.12, within=whole)
    sheet.fill(placed(form.ellipse(0.78, 0, 0.42, 0.5)), hue.INK, within=whole)
    for s in (-1, 1):
        for u in (-0.42, 0.05, 0.5):
            leg = form.brush([(u, 0.4 * s), (u + 0.05, 0.85 * s), (1.2 * u, s)], 0.15, tip=0.6)
            sheet.fill(placed(leg), hue.INK, within=whole)
        feeler = form.brush([(1.05, 0.2 * s), (1.35, 0.3 * s), (1.5, 0.55 * s)], 0.1, tip=0.7)
        sheet.fill(placed(feeler), hue.INK, within=whole)

    red = Linear((x - 0.5, y + 0.7), (x + 0.4, y - 0.7), (hue.ROSE, hue.CORAL, hue.BRICK))
    sheet.fill(shell, red, within=whole)
    for u in (-0.35, 0.28):
        for v in (-0.37, 0.37):
            sheet.fill(placed(form.disc(u, v, 0.165)), hue.INK, within=shell)
    sheet.fill(placed(form.disc(0.62, 0, 0.14)), hue.INK, within=shell)
    sheet.fill(
        placed(form.brush([(-0.9, 0), (0, 0), (0.8, 0)], 0.09, tip=0.8)), hue.INK, within=shell
    )
    sheet.shade(shell, hue.BRICK, depth=0.4, opacity=0.6)
    gleam = placed(form.ellipse(-0.1, 0.5, 0.3, 0.09, 8))
    sheet.fill(gleam, hue.PAPER, opacity=0.7, blur=0.03, within=shell)
    sheet.outline(shell, hue.INK, 0.09)
    for s in (-1, 1):
        place = placed(shapely.Point(0.92, 0.26 * s)).centroid
        eye(sheet, place.x, place.y, 0.24, look=(0.4, 0.3), within=whole)
