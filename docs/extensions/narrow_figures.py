"""On a phone, the panels of a figure come below each other, so that their text stays legible.

A notebook's picture names its parts (`glid_nb.figures.parts`). From these the site draws a second
picture, which narrow pages show instead. `page/js/frames/narrow.js` does the same for figures with
sliders.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from PIL import Image

from glid_nb.figures.drawing import PARTS

if TYPE_CHECKING:  # the functions need no Sphinx
    from sphinx.application import Sphinx

WIDTH = 346.0  # CSS pixels: a phone of 390 without its margins
_HIGH = 700.0  # CSS pixels that are visible at once
_SCALES = (0.95, 0.9, 0.85, 0.8, 0.75)  # letters of 12 CSS pixels then have 9

Box = Sequence[float]


def rows(parts: Sequence[Box], scale: float) -> list[list[Box]]:
    """The parts in rows like words; each row fits the width."""
    found: list[list[Box]] = []
    left = 0.0
    for part in parts:
        if not found or scale * part[2] > left:
            found.append([])
            left = WIDTH
        found[-1].append(part)
        left -= scale * part[2]
    return found


def height(found: Sequence[Sequence[Box]], scale: float) -> float:
    return sum(scale * max(part[3] for part in row) for row in found)


def best_scale(parts: Sequence[Box]) -> float:
    """The largest scale at which all parts are visible together, or else the smallest."""
    most = min(1.0, WIDTH / max(part[2] for part in parts))
    scales = [most, *(scale for scale in _SCALES if scale < most)]
    fits = (scale for scale in scales if height(rows(parts, scale), scale) <= _HIGH)
    return next(fits, scales[-1])


def narrow(picture: Image.Image, width: float) -> Image.Image | None:
    """The picture with its parts in rows; None if it has none. ``width`` is in CSS pixels."""
    parts = json.loads(picture.info.get(PARTS, "[]"))
    if not parts:
        return None
    scale, density = best_scale(parts), picture.width / width
    found = rows(parts, scale)
    size = WIDTH / scale, height(found, 1.0)
    paper = _blank(picture, (round(density * size[0]), round(density * size[1])))
    top = 0.0
    for row in found:
        left = (size[0] - sum(part[2] for part in row)) / 2
        for x, y, wide, high in row:
            corner = round(density * x), round(density * y)
            opposite = round(density * (x + wide)), round(density * (y + high))
            place = round(density * left), round(density * top)
            paper.paste(picture.crop((*corner, *opposite)), place)
            left += wide
        top += max(part[3] for part in row)
    return paper


def _blank(picture: Image.Image, size: tuple[int, int]) -> Image.Image:
    """White paper in the picture's own colours: reducing them again would tint the white."""
    palette = picture.getpalette()
    if picture.mode != "P" or palette is None:
        return Image.new(picture.mode, size, "white")
    light = [sum(palette[i : i + 3]) for i in range(0, len(palette), 3)]
    paper = Image.new("P", size, light.index(max(light)))
    paper.putpalette(palette)
    return paper


def add(app: Sphinx, document: nodes.document) -> None:
    """Put a narrow picture beside each picture of several panels; the style sheet shows one."""
    for image in list(document.findall(nodes.image)):
        path = Path(app.env.relfn2path(image["uri"])[1])
        if path.suffix != ".png" or "width" not in image or not path.is_file():
            continue
        with Image.open(path) as picture:
            made = narrow(picture, float(image["width"]))
        if made is None:
            continue
        made.save(path.with_stem(f"{path.stem}-narrow"), optimize=True)
        uri = str(Path(image["uri"]).with_stem(f"{path.stem}-narrow"))
        beside = nodes.image(uri=uri, width=f"{WIDTH:.0f}", classes=["narrow"])
        image["classes"] = [*image["classes"], "wide"]
        image.parent.insert(image.parent.index(image) + 1, beside)


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", add, priority=400)  # before Sphinx collects the pictures
    return {"parallel_read_safe": True, "parallel_write_safe": True}
