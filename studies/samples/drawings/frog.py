"""A frog in a striped bathing suit, hands on hips: two holes."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import box

from studies.samples.bezier import (
    Shape,
    blend,
    brush,
    disc,
    ellipse,
    mirrored,
    moved,
    symmetric,
    tube,
    turned,
)
from studies.samples.faces import blush, eye
from studies.samples.ink import Linear, Sheet
from studies.samples.palette import (
    BRICK,
    CORAL,
    CREAM,
    INK,
    LEAF,
    LIME,
    MOSS,
    PALE,
    PINE,
    TEAL,
    WINE,
)

SIZE = (1400, 1400)
SKIN = Linear((-3, 6), (2.5, -7), (LIME, LEAF, "#58a06a", TEAL))
# the right arm and leg; the left ones are their mirror images
ARM = [
    (1.2, 0.75, 0.66),
    (2.9, 0.78, 0.6),
    (4.6, -0.4, 0.54),
    (3.7, -1.75, 0.46),
    (2.6, -2.2, 0.42),
]
LEG = [(0.95, -2.7, 1.05), (2.0, -4.1, 0.86), (2.0, -5.15, 0.62), (1.8, -5.9, 0.45)]
TORSO = [(0, 1.6), (1.3, 1.15), (1.65, -0.2), (2.05, -1.8), (1.85, -3.2), (0, -3.9)]
# the face is drawn upright, then lifted and turned about the neck
SKULL = [(0, 5.4), (1.6, 5.25), (2.95, 4.35), (3.2, 3.2), (2.2, 2.2), (0, 1.85)]
TILT, LIFT, NECK = 7, 0.35, (0, 2.2)
# x, y and size
SPOTS = [(4.2, 0.2, 0.2), (3.4, 0.75, 0.15), (4.7, -0.65, 0.13), (2.35, -4.75, 0.18),
         (1.95, -5.3, 0.14), (-2.4, -4.7, 0.15), (-1.95, -5.2, 0.19), (-4.3, 0.15, 0.16),
         (-3.5, 0.7, 0.2), (-4.55, -0.6, 0.14), (2.85, -6.25, 0.13),
         (-2.4, -6.45, 0.13)]  # fmt: skip
FRECKLES = [(0.0, 5.0, 0.17), (0.5, 4.75, 0.12), (-0.45, 4.7, 0.13), (2.65, 4.3, 0.16),
            (-2.65, 4.2, 0.15), (2.3, 4.55, 0.1)]  # fmt: skip


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    arms = [tube(ARM), mirrored(tube(ARM))]
    legs = [tube(LEG), mirrored(tube(LEG))]
    neck = tube([(0, 3, 0.95), (0, 1, 1.0)])
    body = blend([symmetric(TORSO), neck, *arms, *legs], 0.3)
    head = nod(blend([symmetric(SKULL), disc(1.6, 5.4, 1.15), disc(-1.6, 5.4, 1.15)], 0.4))
    hands = [hand(), mirrored(hand())]
    whole = blend([body, head, foot(), mirrored(foot()), *hands], 0.15)

    sheet.fill(whole, SKIN)
    for x, y, r in SPOTS:
        sheet.fill(ellipse(x, y, r * 1.25, r, 20), PINE, opacity=0.4, within=whole)
    round_off(sheet, whole, whole)
    suit(sheet, whole, body)
    sheet.fill(moved(head, 0.1, -0.4), INK, opacity=0.45, blur=0.15, within=whole)
    for arm, palm in zip(arms, hands, strict=True):
        # forearm and hand lie over the suit; above the elbow nothing changes
        limb = blend([arm, palm], 0.15)
        front = limb.intersection(box(-5, -5, 5, -1))
        sheet.fill(moved(palm, 0.06, -0.18), INK, opacity=0.45, blur=0.1, within=whole)
        sheet.fill(front, SKIN, within=whole)
        round_off(sheet, limb, front)
        sheet.outline(limb, INK, 0.1, within=front)
    sheet.fill(head, SKIN, within=whole)
    face(sheet, head)
    sheet.outline(whole, INK, 0.13)
    return sheet.image(INK)


def hand() -> Shape:
    """The right hand on the hip: three fingers with round tips."""
    fingers = [
        tube([(2.7, -2.15, 0.42), (1.95, -1.72, 0.24), (1.4, -1.5, 0.34)]),
        tube([(2.7, -2.15, 0.42), (1.8, -2.3, 0.24), (1.15, -2.35, 0.34)]),
        tube([(2.7, -2.15, 0.42), (2.05, -2.8, 0.24), (1.6, -3.15, 0.34)]),
    ]
    return blend(fingers, 0.12)


def foot() -> Shape:
    """The right foot: three webbed toes."""
    toes = [
        tube([(1.8, -5.9, 0.45), (2.75, -6.2, 0.3), (3.8, -6.3, 0.42)]),
        tube([(1.8, -5.9, 0.45), (2.25, -6.55, 0.3), (2.8, -7.15, 0.42)]),
        tube([(1.8, -5.9, 0.45), (1.6, -6.55, 0.3), (1.4, -7.2, 0.42)]),
    ]
    return blend(toes, 0.22)


def nod(shape: Shape) -> Shape:
    """Bring a part of the upright face to its place on the tilted head."""
    return turned(moved(shape, 0, LIFT), TILT, NECK)


def round_off(sheet: Sheet, part: Shape, within: Shape) -> None:
    """Shade skin on one side and light it on the other."""
    sheet.shade(part, PINE, depth=0.62, opacity=0.65, within=within)
    sheet.shade(part, CREAM, depth=0.36, opacity=0.5, towards_light=True, within=within)


def suit(sheet: Sheet, whole: Shape, body: Shape) -> None:
    """The bathing suit: straps, armholes, stripes that follow the belly."""
    neckline, armhole = ellipse(0, 2.0, 0.7, 1.4), ellipse(2.35, 0.95, 1.05, 1.05)
    hem = ellipse(0, -6.2, 5, 1.7)
    cut = box(-3, -4.9, 3, 2.6)
    for gap in (neckline, armhole, mirrored(armhole), hem):
        cut = cut.difference(gap)
    cloth = max(shapely.get_parts(body.intersection(cut)), key=lambda part: part.area)
    sheet.fill(moved(cloth, 0.05, -0.16), INK, opacity=0.35, blur=0.08, within=whole)
    sheet.fill(cloth, CREAM, within=whole)
    for y in np.arange(1.35, -5.2, -0.86):
        stripe = tube([(x, y + 0.035 * x * x, 0.21) for x in np.linspace(-3, 3, 7)])
        sheet.fill(stripe, CORAL, within=cloth)
    sheet.shade(cloth, BRICK, depth=0.8, opacity=0.5)
    sheet.outline(cloth, INK, 0.1)


def face(sheet: Sheet, head: Shape) -> None:
    """Pale chin, freckles, cheeks, a laughing mouth and two knowing eyes."""
    chin = symmetric([(0, 3.75), (1.9, 3.85), (3.4, 3.5), (2.6, 2.0), (0, 1.3)])
    sheet.fill(nod(chin), PALE, opacity=0.9, blur=0.1, within=head)
    for x, y, r in FRECKLES:
        sheet.fill(nod(ellipse(x, y, r * 1.25, r)), MOSS, opacity=0.8, within=head)
    sheet.shade(head, MOSS, depth=0.8, opacity=0.75)
    sheet.shade(head, CREAM, depth=0.4, opacity=0.55, towards_light=True)

    lips = symmetric([(0, 3.36), (1.0, 3.42), (1.95, 3.6), (1.45, 2.85), (0, 2.42)])
    mouth = nod(lips)
    sheet.fill(mouth, INK, within=head)
    throat = Linear((0, 3.8), (0, 2.4), (INK, WINE))
    sheet.fill(mouth.buffer(-0.1), throat, within=head)
    sheet.fill(nod(ellipse(0.1, 2.52, 0.95, 0.42)), CORAL, within=mouth.buffer(-0.1))
    sheet.outline(head, INK, 0.13)
    for s in (-1, 1):
        cheek = nod(shapely.Point(s * 2.5, 3.45)).centroid
        blush(sheet, cheek.x, cheek.y, 0.5, 0.34, head)
        sheet.fill(nod(ellipse(s * 0.3, 4.25, 0.1, 0.07, s * 30)), INK, within=head)
        dimple = brush([(s * 1.78, 3.84), (s * 1.98, 3.66), (s * 2.0, 3.42)], 0.15)
        sheet.fill(nod(dimple), INK, within=head)
        place = nod(shapely.Point(s * 1.6, 5.5)).centroid
        eye(sheet, place.x, place.y, 0.86, look=(0.35, -0.15), lid=LEAF, droop=0.16, within=head)
