"""A teapot with a face: its handle makes one hole."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from shapely import box
from shapely.geometry import Polygon

from studies.samples import bezier as form
from studies.samples import palette as hue
from studies.samples.faces import blush, eye
from studies.samples.ink import Linear, Sheet

SIZE = (1600, 1400)
SPOUT = [(-2.4, -2.0, 1.25), (-4.0, -1.5, 0.98), (-4.95, -0.2, 0.74), (-5.35, 1.2, 0.6),
         (-6.15, 2.2, 0.52), (-6.7, 2.5, 0.54)]  # fmt: skip
HANDLE = [(2.6, 1.15, 0.55), (4.6, 1.75, 0.54), (6.15, 0.95, 0.52), (6.45, -0.9, 0.5),
          (5.4, -2.5, 0.5), (2.3, -2.85, 0.54)]  # fmt: skip
GLAZE = Linear((-3.5, 3), (3, -5), (hue.MINT, hue.SEA, hue.TEAL, hue.DEEP))


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    belly = form.symmetric([(0, 2.35), (2.2, 1.95), (3.7, 0.35), (3.85, -1.5), (2.95, -3.3),
                       (1.5, -4.25), (0, -4.4)])  # fmt: skip
    base = form.rounded(box(-1.9, -5.0, 1.9, -4.0), 0.3)
    dome = form.symmetric([(0, 3.75), (1.2, 3.45), (2.1, 2.65), (2.3, 2.1), (1.4, 1.9), (0, 1.82)])
    knob = form.disc(0, 4.35, 0.66)
    lid = form.blend([dome, form.tube([(0, 3.2, 0.46), (0, 4.2, 0.46)]), knob], 0.15)
    handle = form.tube(HANDLE)
    pot = form.blend([belly, form.tube(SPOUT)], 0.5)
    whole = form.blend([pot, base, handle, lid], 0.12)

    sheet.fill(whole, GLAZE)
    rattan(sheet, handle, whole)
    sheet.fill(base, Linear((0, -4.2), (0, -5), (hue.CORAL, hue.BRICK)), within=whole)
    sheet.shade(base, hue.INK, depth=0.4, opacity=0.35)
    sheet.outline(base, hue.INK, 0.12)

    sheet.fill(pot, GLAZE, within=whole)
    ribbon(sheet, pot)
    blossoms(sheet, pot)
    sheet.shade(pot, hue.DEEP, depth=1.3, opacity=0.75)
    sheet.shade(pot, hue.PAPER, depth=0.6, opacity=0.6, towards_light=True)
    lip = form.disc(-7.1, 2.7, 0.78).intersection(pot)
    sheet.fill(lip, hue.CREAM, within=pot)
    sheet.shade(lip, hue.AMBER, depth=0.3, opacity=0.5)
    sheet.outline(lip, hue.INK, 0.08)
    sheet.fill(form.moved(lid, 0.1, -0.32), hue.INK, opacity=0.45, blur=0.15, within=pot)
    sheet.outline(pot, hue.INK, 0.13)
    gloss(sheet, pot)

    cover(sheet, lid, knob, whole)
    sheet.outline(whole, hue.INK, 0.13)
    for x in (-1.3, 1.3):
        eye(sheet, x, 0.0, 0.74, look=(-0.35, 0.1), within=pot)
        blush(sheet, x * 1.8, -0.88, 0.48, 0.3, pot)
    smile = [(-0.55, -0.72), (-0.3, -0.98), (0, -1.07), (0.3, -0.98), (0.55, -0.72)]
    sheet.fill(form.brush(smile, 0.17, tip=0.45), hue.INK, within=pot)
    return sheet.image(hue.INK)


def rattan(sheet: Sheet, handle: form.Shape, whole: form.Shape) -> None:
    """The handle, wound with cane."""
    sheet.fill(handle, Linear((3, 2), (6, -3), (hue.MUSTARD, hue.AMBER)), within=whole)
    for p, u, n in zip(*form.along(HANDLE, np.linspace(0.16, 0.88, 14)), strict=True):
        turn = form.brush([p + 0.7 * n, p + 0.1 * u, p - 0.7 * n], 0.17, tip=0.8)
        sheet.fill(turn, hue.CRUST, opacity=0.75, within=handle)
    sheet.shade(handle, hue.CRUST, depth=0.45, opacity=0.65)
    sheet.shade(handle, hue.PAPER, depth=0.25, opacity=0.6, towards_light=True)
    sheet.outline(handle, hue.INK, 0.12)


def cover(sheet: Sheet, lid: form.Shape, knob: form.Shape, whole: form.Shape) -> None:
    """The lid, dotted, with its brass knob."""
    sheet.fill(lid, Linear((-1.5, 4.5), (1.5, 1.8), (hue.ROSE, hue.CORAL, hue.BRICK)), within=whole)
    for y, spread, count, r in ((2.36, 1.75, 5, 0.15), (3.02, 1.1, 3, 0.14)):
        for x in spread * np.sin(np.linspace(-1.35, 1.35, count)):
            sheet.fill(form.ellipse(x, y + 0.05 * x * x, r, r * 0.9), hue.CREAM, within=lid)
    sheet.shade(lid, hue.BRICK, depth=0.6, opacity=0.8)
    sheet.shade(lid, hue.PAPER, depth=0.35, opacity=0.55, towards_light=True)
    sheet.fill(knob, hue.MUSTARD, within=whole)
    sheet.shade(knob, hue.CRUST, depth=0.4, opacity=0.6)
    sheet.outline(knob, hue.INK, 0.1)
    sheet.fill(form.ellipse(-0.2, 4.56, 0.18, 0.12, 35), hue.PAPER, opacity=0.9, within=knob)
    sheet.outline(lid, hue.INK, 0.13)


def ribbon(sheet: Sheet, pot: form.Shape) -> None:
    """A checked ribbon round the belly, its squares narrower towards the sides."""
    tops, half = (-1.75, -2.3, -2.85), 5.4
    x = np.linspace(-half, half, 80)
    band = strip(x, tops[0] + 0.1, tops[-1] - 0.1).intersection(pot)
    sheet.fill(band, hue.CREAM, within=pot)
    edges = half * np.sin(np.linspace(-np.pi / 2, np.pi / 2, 25))
    for row in range(2):
        for left, right in list(pairwise(edges))[row::2]:
            square = strip(np.linspace(left, right, 8), tops[row], tops[row + 1])
            sheet.fill(square, hue.CORAL, within=band)
    sheet.outline(band, hue.INK, 0.07, opacity=0.8)


def strip(x: form.Floats, top: float, foot: float) -> Polygon:
    """The part between two levels that sag like hoops round the pot."""
    sag = 0.5 * (1 - (x / 4.2) ** 2)
    upper, lower = np.column_stack([x, top - sag]), np.column_stack([x, foot - sag])
    return Polygon(np.concatenate([upper, lower[::-1]]))


def blossoms(sheet: Sheet, pot: form.Shape) -> None:
    """Small painted flowers and dots on the glaze."""
    flowers = [(2.35, 1.3, 0.2), (-3.75, -0.75, 0.19), (3.25, -0.3, 0.17), (-4.75, 0.0, 0.16),
               (-2.2, -3.55, 0.17), (0.0, -3.95, 0.19), (2.2, -3.55, 0.17)]  # fmt: skip
    for x, y, r in flowers:
        for a in np.radians(np.arange(90, 450, 72)):
            petal = form.ellipse(
                x + r * np.cos(a), y + r * np.sin(a), 0.75 * r, 0.6 * r, np.degrees(a)
            )
            sheet.fill(petal, hue.CREAM, within=pot)
        sheet.fill(form.disc(x, y, 0.5 * r), hue.CORAL, within=pot)
    for x, y in ((-1.0, 1.3), (0.0, 1.1), (1.0, 1.3), (3.2, 0.55), (-2.75, -0.1), (2.6, -0.05),
                 (-1.1, -3.8), (1.1, -3.8), (-4.45, -0.85), (-5.45, 1.2)):  # fmt: skip
        sheet.fill(form.disc(x, y, 0.09), hue.CREAM, within=pot)


def gloss(sheet: Sheet, pot: form.Shape) -> None:
    """Reflections of the window on the glaze."""
    for stroke, width in (
        ([(-3.2, -0.35), (-2.95, 0.5), (-2.25, 1.3)], 0.36),
        ([(-5.1, 0.3), (-5.4, 1.05), (-5.85, 1.65)], 0.2),
    ):
        sheet.fill(form.brush(stroke, width), hue.PAPER, opacity=0.85, blur=0.03, within=pot)
    sheet.fill(form.disc(-3.28, -0.88, 0.14), hue.PAPER, opacity=0.85, blur=0.03, within=pot)
