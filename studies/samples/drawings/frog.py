"""A frog in a striped bathing suit, hands on hips: two holes."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import box

from studies.samples import bezier as form
from studies.samples import palette as hue
from studies.samples.faces import blush, eye
from studies.samples.ink import Linear, Sheet

SIZE = (1400, 1400)
SKIN = Linear((-3, 6), (2.5, -7), (hue.LIME, hue.LEAF, "#58a06a", hue.TEAL))
# the right arm and leg; the left ones are their mirror images
ARM = [(1.2, 0.75, 0.66), (2.9, 0.78, 0.6), (4.6, -0.4, 0.54), (3.7, -1.75, 0.46),
       (2.6, -2.2, 0.42)]  # fmt: skip
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
    arms = [form.tube(ARM), form.mirrored(form.tube(ARM))]
    legs = [form.tube(LEG), form.mirrored(form.tube(LEG))]
    neck = form.tube([(0, 3, 0.95), (0, 1, 1.0)])
    body = form.blend([form.symmetric(TORSO), neck, *arms, *legs], 0.3)
    head = nod(
        form.blend(
            [form.symmetric(SKULL), form.disc(1.6, 5.4, 1.15), form.disc(-1.6, 5.4, 1.15)], 0.4
        )
    )
    hands = [hand(), form.mirrored(hand())]
    whole = form.blend([body, head, foot(), form.mirrored(foot()), *hands], 0.15)

    sheet.fill(whole, SKIN)
    for x, y, r in SPOTS:
        sheet.fill(form.ellipse(x, y, r * 1.25, r, 20), hue.PINE, opacity=0.4, within=whole)
    round_off(sheet, whole, whole)
    suit(sheet, whole, body)
    sheet.fill(form.moved(head, 0.1, -0.4), hue.INK, opacity=0.45, blur=0.15, within=whole)
    for arm, palm in zip(arms, hands, strict=True):
        # forearm and hand lie over the suit; above the elbow nothing changes
        limb = form.blend([arm, palm], 0.15)
        front = limb.intersection(box(-5, -5, 5, -1))
        sheet.fill(form.moved(palm, 0.06, -0.18), hue.INK, opacity=0.45, blur=0.1, within=whole)
        sheet.fill(front, SKIN, within=whole)
        round_off(sheet, limb, front)
        sheet.outline(limb, hue.INK, 0.1, within=front)
    sheet.fill(head, SKIN, within=whole)
    face(sheet, head)
    sheet.outline(whole, hue.INK, 0.13)
    return sheet.image(hue.INK)


def hand() -> form.Shape:
    """The right hand on the hip: three fingers with round tips."""
    fingers = [
        form.tube([(2.7, -2.15, 0.42), (1.95, -1.72, 0.24), (1.4, -1.5, 0.34)]),
        form.tube([(2.7, -2.15, 0.42), (1.8, -2.3, 0.24), (1.15, -2.35, 0.34)]),
        form.tube([(2.7, -2.15, 0.42), (2.05, -2.8, 0.24), (1.6, -3.15, 0.34)]),
    ]
    return form.blend(fingers, 0.12)


def foot() -> form.Shape:
    """The right foot: three webbed toes."""
    toes = [
        form.tube([(1.8, -5.9, 0.45), (2.75, -6.2, 0.3), (3.8, -6.3, 0.42)]),
        form.tube([(1.8, -5.9, 0.45), (2.25, -6.55, 0.3), (2.8, -7.15, 0.42)]),
        form.tube([(1.8, -5.9, 0.45), (1.6, -6.55, 0.3), (1.4, -7.2, 0.42)]),
    ]
    return form.blend(toes, 0.22)


def nod(shape: form.Shape) -> form.Shape:
    """Move a part of the upright face to its place on the tilted head."""
    return form.turned(form.moved(shape, 0, LIFT), TILT, NECK)


def round_off(sheet: Sheet, part: form.Shape, within: form.Shape) -> None:
    """Shade skin on one side and light it on the other."""
    sheet.shade(part, hue.PINE, depth=0.62, opacity=0.65, within=within)
    sheet.shade(part, hue.CREAM, depth=0.36, opacity=0.5, towards_light=True, within=within)


def suit(sheet: Sheet, whole: form.Shape, body: form.Shape) -> None:
    """The bathing suit: straps, armholes, stripes that follow the belly."""
    neckline, armhole = form.ellipse(0, 2.0, 0.7, 1.4), form.ellipse(2.35, 0.95, 1.05, 1.05)
    hem = form.ellipse(0, -6.2, 5, 1.7)
    cut = box(-3, -4.9, 3, 2.6)
    for gap in (neckline, armhole, form.mirrored(armhole), hem):
        cut = cut.difference(gap)
    cloth = max(shapely.get_parts(body.intersection(cut)), key=lambda part: part.area)
    sheet.fill(form.moved(cloth, 0.05, -0.16), hue.INK, opacity=0.35, blur=0.08, within=whole)
    sheet.fill(cloth, hue.CREAM, within=whole)
    for y in np.arange(1.35, -5.2, -0.86):
        stripe = form.tube([(x, y + 0.035 * x * x, 0.21) for x in np.linspace(-3, 3, 7)])
        sheet.fill(stripe, hue.CORAL, within=cloth)
    sheet.shade(cloth, hue.BRICK, depth=0.8, opacity=0.5)
    sheet.outline(cloth, hue.INK, 0.1)


def face(sheet: Sheet, head: form.Shape) -> None:
    """Pale chin, freckles, cheeks, a laughing mouth and two knowing eyes."""
    chin = form.symmetric([(0, 3.75), (1.9, 3.85), (3.4, 3.5), (2.6, 2.0), (0, 1.3)])
    sheet.fill(nod(chin), hue.PALE, opacity=0.9, blur=0.1, within=head)
    for x, y, r in FRECKLES:
        sheet.fill(nod(form.ellipse(x, y, r * 1.25, r)), hue.MOSS, opacity=0.8, within=head)
    sheet.shade(head, hue.MOSS, depth=0.8, opacity=0.75)
    sheet.shade(head, hue.CREAM, depth=0.4, opacity=0.55, towards_light=True)

    lips = form.symmetric([(0, 3.36), (1.0, 3.42), (1.95, 3.6), (1.45, 2.85), (0, 2.42)])
    mouth = nod(lips)
    sheet.fill(mouth, hue.INK, within=head)
    throat = Linear((0, 3.8), (0, 2.4), (hue.INK, hue.WINE))
    sheet.fill(mouth.buffer(-0.1), throat, within=head)
    sheet.fill(nod(form.ellipse(0.1, 2.52, 0.95, 0.42)), hue.CORAL, within=mouth.buffer(-0.1))
    sheet.outline(head, hue.INK, 0.13)
    for s in (-1, 1):
        cheek = nod(shapely.Point(s * 2.5, 3.45)).centroid
        blush(sheet, cheek.x, cheek.y, 0.5, 0.34, head)
        sheet.fill(nod(form.ellipse(s * 0.3, 4.25, 0.1, 0.07, s * 30)), hue.INK, within=head)
        dimple = form.brush([(s * 1.78, 3.84), (s * 1.98, 3.66), (s * 2.0, 3.42)], 0.15)
        sheet.fill(nod(dimple), hue.INK, within=head)
        place = nod(shapely.Point(s * 1.6, 5.5)).centroid
        eye(
            sheet, place.x, place.y, 0.86, look=(0.35, -0.15), lid=hue.LEAF, droop=0.16, within=head
        )
