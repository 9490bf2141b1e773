"""A checkered bar with draughtsmen on it: no holes, the simplest shape to bend."""

import numpy as np
from numpy.typing import NDArray
from shapely import box

from studies.samples import palette as hue
from studies.samples.bezier import Shape, disc, moved, rounded
from studies.samples.ink import Linear, Sheet

SIZE = (1600, 1200)
CELL = 0.6
COLUMNS, ROWS = 22, 4
PIECES = np.linspace(-4.8, 4.8, 5)
RED, GOLD = (hue.ROSE, hue.CORAL, hue.BRICK), ("#ffd98a", hue.MUSTARD, hue.AMBER)


def draw() -> NDArray[np.uint8]:
    """The picture as RGBA (h, w, 4)."""
    sheet = Sheet(*SIZE)
    length, height = COLUMNS * CELL / 2, ROWS * CELL / 2
    rail = 0.34
    whole = rounded(box(-length - rail, -height - rail, length + rail, height + rail), 0.5)
    board = rounded(box(-length, -height, length, height), 0.2)

    sheet.fill(whole, Linear((-7, 2), (7, -2), (hue.MUSTARD, hue.AMBER)))
    sheet.shade(whole, hue.CRUST, depth=0.3, opacity=0.8)
    sheet.shade(whole, hue.PAPER, depth=0.22, opacity=0.75, towards_light=True)
    sheet.outline(whole, hue.INK, 0.13)

    sheet.fill(board, hue.CREAM, within=whole)
    cloth = Linear((-length, height), (length, -height), ("#45aca3", hue.TEAL, hue.DEEP))
    for i in range(COLUMNS):
        for j in range(ROWS):
            if (i + j) % 2:
                x, y = i * CELL - length, j * CELL - height
                sheet.fill(box(x, y, x + CELL, y + CELL), cloth, within=board)
    for k, x in enumerate(PIECES):
        draught(sheet, float(x), RED if k % 2 == 0 else GOLD, board)
    sheet.shade(board, hue.DEEP, depth=0.55, opacity=0.45, towards_light=True)
    sheet.outline(board, hue.INK, 0.08)
    return sheet.image(hue.INK)


def draught(sheet: Sheet, x: float, colours: tuple[str, str, str], board: Shape) -> None:
    """A draughtsman: its circles turn into ellipses with axes sigma_1 and sigma_2."""
    piece = disc(x, 0, 0.78)
    sheet.fill(moved(piece, 0.08, -0.16), hue.INK, opacity=0.45, blur=0.09, within=board)
    sheet.fill(piece, Linear((x - 0.4, 0.7), (x + 0.4, -0.7), colours), within=board)
    sheet.shade(piece, hue.INK, depth=0.25, opacity=0.45)
    sheet.shade(piece, hue.PAPER, depth=0.2, opacity=0.6, towards_light=True)
    sheet.outline(piece, hue.INK, 0.1)
    groove = disc(x, 0, 0.48).difference(disc(x, 0, 0.4))
    sheet.fill(moved(groove, 0.02, -0.04), hue.PAPER, opacity=0.7, within=piece)
    sheet.fill(groove, hue.INK, opacity=0.75, within=piece)
    sheet.fill(disc(x, 0, 0.13), hue.INK, opacity=0.75, within=piece)
