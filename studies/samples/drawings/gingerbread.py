"""A gingerbread man in a checked waistcoat: no holes, and squares that show the distortion."""

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon, box

from studies.samples import bezier as form
from studies.samples import palette as hue
from studies.samples.faces import blush, eye
from studies.samples.ink import Linear, Sheet

SIZE = (1400, 1400)
DOUGH = Linear((-4, 6), (4, -6), ("#dca15e", hue.COOKIE, "#b9773a"))
# right halves; the left ones are their mirror images
ARM = [(0.6, 0.9, 1.15), (2.6, 1.15, 1.0), (4.3, 1.55, 0.92), (5.5, 2.0, 0.98)]
LEG = [(0.75, -2.2, 1.35), (1.55, -4.2, 1.15), (2.1, -5.7, 1.08), (2.35, -6.5, 1.12)]
TORSO = [(0, 2.3), (1.5, 1.6), (1.95, 0.0), (2.05, -1.8), (1.6, -3.2), (0, -3.4)]
FRONT = [(0.0, -0.75), (0.8, 0.8), (1.15, 1.9), (1.6, 1.9), (1.55, 0.9), (2.0, 0.15),
         (3.0, 0.0), (3.0, -2.3), (1.1, -3.05), (0.0, -2.2)]  # fmt: skip
CHECK = 0.52
WAVES = [
    [(4.35, 2.7), (4.55, 2.25), (4.4, 1.85), (4.75, 1.45), (4.6, 1.05), (4.9, 0.65)],
    [(0.9, -5.55), (1.3, -5.2), (1.7, -5.55), (2.15, -5.25), (2.55, -5.6), (2.95, -5.35),
     (3.3, -5.6)],
]  # fmt: skip
PEARLS = [(3.3, 1.9), (3.35, 1.3), (3.3, 0.7), (5.55, 2.55), (5.75, 1.95), (5.5, 1.35),
          (1.65, -6.35), (2.35, -6.75), (3.0, -6.4), (0.8, -4.5), (1.35, -4.45),
          (1.9, -4.35)]  # fmt: skip


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    torso = form.symmetric(TORSO)
    limbs = [
        form.tube(ARM),
        form.mirrored(form.tube(ARM)),
        form.tube(LEG),
        form.mirrored(form.tube(LEG)),
    ]
    whole = form.blend([torso, form.ellipse(0, 4.3, 2.6, 2.4), *limbs], 0.45)

    sheet.fill(whole, DOUGH)
    crumbs(sheet, whole)
    sheet.shade(whole, hue.CRUST, depth=0.75, opacity=0.8)
    sheet.shade(whole, hue.HONEY, depth=0.45, opacity=0.7, towards_light=True)
    waistcoat(sheet, torso, whole)
    icing(sheet, whole)
    face(sheet, whole)
    sheet.outline(whole, hue.INK, 0.13)
    return sheet.image(hue.INK)


def crumbs(sheet: Sheet, whole: form.Shape) -> None:
    """Pores of the dough, spread by the golden angle."""
    for i in range(150):
        angle, r = 2.399963 * i, 0.62 * np.sqrt(i + 0.5)
        x, y = 1.05 * r * np.cos(angle), 1.2 * r * np.sin(angle) - 0.4
        pore = form.ellipse(x, y, 0.045 + 0.02 * (i % 3), 0.04, 40 * i)
        sheet.fill(pore, hue.CRUST, opacity=0.45, within=whole)


def lay(
    sheet: Sheet, piece: form.Shape, colour: str, dark: str, line: float, whole: form.Shape
) -> None:
    """Lay a piece on the dough: its shadow, its colour, its outline."""
    sheet.fill(form.moved(piece, 0.05, -0.13), hue.CRUST, opacity=0.7, blur=0.07, within=whole)
    sheet.fill(piece, colour, within=whole)
    sheet.shade(piece, dark, depth=0.3, opacity=0.65)
    sheet.outline(piece, hue.INK, line)


def waistcoat(sheet: Sheet, torso: form.Shape, whole: form.Shape) -> None:
    """Checked cloth, two buttons and a bow tie."""
    front = Polygon(FRONT)
    cloth = torso.buffer(-0.06).intersection(front.union(form.mirrored(front)))
    sheet.fill(form.moved(cloth, 0.06, -0.14), hue.CRUST, opacity=0.7, blur=0.08, within=torso)
    sheet.fill(cloth, hue.CREAM, within=torso)
    for i in range(-5, 5):
        for j in range(-6, 6):
            if (i + j) % 2:
                x, y = i * CHECK, j * CHECK
                sheet.fill(box(x, y, x + CHECK, y + CHECK), hue.TEAL, within=cloth)
    sheet.shade(cloth, hue.DEEP, depth=0.7, opacity=0.55)
    sheet.outline(cloth, hue.INK, 0.09)

    for y, colour in ((0.75, hue.MUSTARD), (0.05, hue.CORAL)):
        button = form.disc(0, y, 0.27)
        lay(sheet, button, colour, hue.BRICK, 0.07, whole)
        sheet.fill(
            form.ellipse(-0.08, y + 0.1, 0.08, 0.05, 35), hue.PAPER, opacity=0.9, within=button
        )
    wing = form.loop([(0, 1.78), (0.5, 2.2), (1.15, 2.25), (1.15, 1.35), (0.5, 1.4)])
    for piece in (wing, form.mirrored(wing), form.ellipse(0, 1.8, 0.3, 0.34)):
        lay(sheet, piece, hue.CORAL, hue.BRICK, 0.08, whole)


def icing(sheet: Sheet, whole: form.Shape) -> None:
    """Waves round wrists and ankles, pearls beside them."""
    waves = [form.tube([(x, y, 0.13) for x, y in wave]) for wave in WAVES]
    pearls = [form.disc(x, y, 0.13) for x, y in PEARLS]
    for right in (*waves, *pearls):
        for piece in (right, form.mirrored(right)):
            squeeze(sheet, piece, whole)


def squeeze(sheet: Sheet, piece: form.Shape, whole: form.Shape) -> None:
    """White icing with a shadow beside it."""
    sheet.fill(form.moved(piece, 0.05, -0.1), hue.CRUST, opacity=0.7, blur=0.05, within=whole)
    sheet.fill(piece, hue.PAPER, within=whole)
    sheet.shade(piece, hue.AMBER, depth=0.15, opacity=0.4, within=piece.intersection(whole))


def face(sheet: Sheet, whole: form.Shape) -> None:
    """Eyes, brows and a smile of icing."""
    for s in (-1, 1):
        eye(sheet, s * 0.95, 4.6, 0.62, look=(0.2, 0.1), iris=(hue.CRUST, hue.AMBER), within=whole)
        blush(sheet, s * 1.65, 3.7, 0.42, 0.3, whole)
        brow = form.brush([(s * 0.55, 5.5), (s * 0.95, 5.68), (s * 1.4, 5.5)], 0.2, tip=0.5)
        squeeze(sheet, brow, whole)
    smile = [(-1.15, 3.55), (-0.65, 3.05), (0.0, 2.88), (0.65, 3.05), (1.15, 3.55)]
    squeeze(sheet, form.brush(smile, 0.26, tip=0.6), whole)
