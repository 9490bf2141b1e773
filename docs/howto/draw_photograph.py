"""Draws docs/howto/photograph.png: strokes where colours do not tell the shape from its background.

Also draws docs/howto/cut-out.png: what is drawn of a photograph when its shape moves.

``python docs/howto/draw_photograph.py``
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage.data import astronaut

import glid_nb as glid
from glid_nb.figures.style import ORANGE, SKY, VERMILION

OUT = Path(__file__).with_name("photograph.png")
CUT_OUT = Path(__file__).with_name("cut-out.png")
GREEN = (60, 180, 90)

# Pixels (x, y) of a picture of 700 by 700.
OVER_THE_SHAPE = [
    [[330, 165], [345, 175], [440, 195], [450, 190]],
    [[395, 90], [380, 130], [350, 220], [352, 300], [365, 380], [380, 420]],
    [[310, 250], [230, 240], [150, 200], [155, 185]],
    [[400, 240], [470, 215], [520, 200], [565, 212]],
    [[330, 390], [250, 400], [190, 390], [155, 372]],
    [[420, 395], [480, 410], [540, 460], [525, 500]],
    [[380, 440], [370, 520], [310, 580], [200, 590], [155, 550], [170, 525]],
]
OVER_THE_BACKGROUND = [
    [[20, 20], [680, 20], [680, 680], [20, 680], [20, 20]],
    [[240, 60], [270, 170], [200, 165]],
    [[60, 250], [250, 320], [50, 330]],
    [[540, 80], [510, 120], [560, 150]],
    [[660, 280], [460, 310], [600, 370]],
    [[470, 480], [440, 620], [300, 655]],
    [[80, 470], [240, 470], [300, 480]],
    [[60, 560], [70, 620], [130, 650]],
    [[620, 560], [500, 590]],
]

# Pixels of scikit-image's photograph of Eileen Collins (NASA), 512 by 512.
OVER_THE_ASTRONAUT = [
    [[220, 60], [200, 110], [225, 170]],
    [[180, 60], [225, 25], [265, 55], [270, 110]],
    [[240, 200], [120, 320], [60, 480]],
    [[240, 200], [330, 330], [380, 490]],
    [[200, 220], [220, 480]],
    [[300, 280], [320, 490]],
]
BEHIND_THE_ASTRONAUT = [
    [[10, 10], [10, 200], [30, 300]],
    [[20, 10], [130, 10], [140, 150], [90, 210]],
    [[330, 20], [330, 150]],
    [[420, 20], [480, 250]],
    [[300, 10], [500, 10], [505, 400]],
]


def photograph(seed: int = 3) -> np.ndarray:
    """The gecko before blotches of its own colours, with the grain of a camera."""
    picture = glid.samples.image("gecko")[::2, ::2].astype(float)
    h, w = picture.shape[:2]
    rng = np.random.default_rng(seed)
    noise = np.stack([gaussian_filter(rng.normal(size=(h, w)), 11) for _ in range(3)], axis=-1)
    blotches = np.array([128.0, 120.0, 84.0]) + [34, 26, 22] * noise / noise.std()
    alpha = picture[..., 3:] / 255
    mixed = alpha * picture[..., :3] + (1 - alpha) * blotches
    grain = rng.normal(0, 7, size=mixed.shape)
    return np.clip(mixed + grain, 0, 255).astype(np.uint8)


def draw_cut_out() -> None:
    picture = astronaut()
    strokes = glid.Scribbles(OVER_THE_ASTRONAUT, BEHIND_THE_ASTRONAUT)
    tracing = glid.trace(picture, scribbles=strokes)
    domain = glid.Domain.from_cage(tracing.cage)
    frame = tracing.frame
    pins = frame.to_world([[225, 90], [240, 190], [120, 430], [380, 430]])
    targets = pins + np.array([[3.2, -0.5], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0]])
    map = glid.solve(domain, glid.Pose(pins, targets)).map
    assert isinstance(map, glid.HarmonicMap)
    cut, behind = glid.cut_out(picture, tracing), glid.filled_in(picture, tracing)
    figure = Figure(figsize=(9, 3.25), layout="constrained")
    shown = {
        "all inside the cage": glid.render(picture, map, background=GREEN),
        "cut out": glid.render(cut, map, background=GREEN),
        "before the old picture, filled in": glid.render(cut, map, background=behind),
    }
    for ax, (title, drawn) in zip(figure.subplots(1, 3), shown.items(), strict=True):
        ax.imshow(drawn)
        ax.set_title(title, fontsize=10)
        ax.set_axis_off()
    figure.savefig(CUT_OUT, dpi=100)
    Image.open(CUT_OUT).convert("RGB").quantize(256).save(CUT_OUT, optimize=True)


def main() -> None:
    draw_cut_out()
    picture = photograph()
    strokes = glid.Scribbles(OVER_THE_SHAPE, OVER_THE_BACKGROUND)
    figure = Figure(figsize=(9, 3.25), layout="constrained")
    axes = figure.subplots(1, 3)
    tracings = (None, glid.trace(picture), glid.trace(picture, scribbles=strokes))
    titles = ("strokes over shape and background", "traced without them", "traced with them")
    for ax, tracing, title in zip(axes, tracings, titles, strict=True):
        ax.imshow(picture)
        ax.set_title(title, fontsize=10)
        ax.set_axis_off()
        ax.autoscale(False)
        if tracing is None:
            for stroke in OVER_THE_SHAPE:
                ax.plot(*np.array(stroke).T, color=SKY, lw=4)
            for stroke in OVER_THE_BACKGROUND:
                ax.plot(*np.array(stroke).T, color=ORANGE, lw=4)
        else:
            for loop in tracing.cage.loops:
                ax.fill(*tracing.frame.to_pixel(loop).T, fill=False, ec=VERMILION, lw=2)
    figure.savefig(OUT, dpi=100)
    Image.open(OUT).convert("RGB").quantize(256).save(OUT, optimize=True)


if __name__ == "__main__":
    main()
