"""Draws docs/howto/knife.png: an arm that touches the body is cut loose, and moves in front of it.

``python docs/howto/draw_knife.py``
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

import glid_nb as glid
from glid_nb.figures.style import VERMILION

OUT = Path(__file__).with_name("knife.png")
SHARPER = 4  # the figure is drawn so many times larger first

# Pixels (x, y) of a picture of 500 by 500.
LINE = [[312, 388], [306, 350], [306, 196]]
SHOULDER, HAND, ELSEWHERE = [328, 188], [330, 345], [[250, 100], [235, 290], [205, 440], [285, 440]]
WAVE, IN_FRONT = [430, 80], [222, 285]


def figure() -> np.ndarray:
    """A person whose right arm hangs along the body, RGBA."""
    picture = Image.new("RGBA", (500 * SHARPER, 500 * SHARPER))
    pen = ImageDraw.Draw(picture)

    def part(box: tuple[int, int, int, int], radius: int, color: str) -> None:
        scaled = [SHARPER * side for side in box]
        outline = {"outline": "#22303a", "width": 4 * SHARPER}
        pen.rounded_rectangle(scaled, SHARPER * radius, color, **outline)

    part((188, 330, 246, 470), 22, "#3d4f7a")
    part((250, 330, 308, 470), 22, "#3d4f7a")
    part((180, 160, 310, 370), 40, "#2f9b8f")
    part((205, 40, 297, 170), 44, "#f0c9a4")
    for x in (233, 269):
        part((x - 5, 94, x + 5, 104), 5, "#22303a")
    pen.arc([SHARPER * side for side in (232, 104, 270, 136)], 20, 160, "#22303a", 4 * SHARPER)
    part((306, 300, 352, 366), 20, "#f0c9a4")
    part((304, 165, 354, 330), 24, "#e0853c")
    return np.asarray(picture.resize((500, 500), Image.Resampling.LANCZOS))


def main() -> None:
    picture = figure()
    tracing = glid.trace(picture)
    frame = tracing.frame
    cage, *_ = glid.cut(tracing.cage, frame.to_world(LINE))
    domain = glid.Domain.from_cage(cage)
    pins = frame.to_world([HAND, SHOULDER, *ELSEWHERE])
    drawing = Figure(figsize=(9, 3.25), layout="constrained")
    traced, *moved = drawing.subplots(1, 3)
    traced.imshow(picture)
    traced.set_title("one outline, and the knife's line", fontsize=10)
    for loop in tracing.cage.loops:
        traced.fill(*frame.to_pixel(loop).T, fill=False, ec="#0072b2", lw=1.5)
    traced.plot(*np.array(LINE).T, color="white", lw=4.5)
    traced.plot(*np.array(LINE).T, color=VERMILION, lw=2, ls=(0, (4, 2)))
    titles = ("cut loose, it waves", "with depth 1, it is in front")
    for ax, title, goal in zip(moved, titles, (WAVE, IN_FRONT), strict=True):
        targets = np.vstack([frame.to_world([goal]), pins[1:]])
        pose = glid.Pose(pins, targets, depths=[1, 0, 0, 0, 0, 0])
        map = glid.solve(domain, pose).map
        assert isinstance(map, glid.HarmonicMap)
        assert glid.certify(map).certified
        ax.imshow(glid.render(picture, map, pose=pose))
        ax.set_title(title, fontsize=10)
    for ax in (traced, *moved):
        ax.set_axis_off()
        ax.set(xlim=(130, 470), ylim=(490, 20))
    drawing.savefig(OUT, dpi=100)
    Image.open(OUT).convert("RGB").quantize(256).save(OUT, optimize=True)


if __name__ == "__main__":
    main()
