"""Several shapes on one canvas, in a real browser: what is seen is what `render` draws of them."""

from __future__ import annotations

import base64
import io
import time
from typing import Any

import numpy as np
import pytest
from PIL import Image

from ..support.browser import ARTEFACTS, bring_into_view
from .conftest import OpenNotebook
from .editor_page import Hand
from .test_timeline_browser import Timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A curled bar, red and blue at its ends, between a disc behind it and a plate in front of it, which
# has a half transparent stripe. All have soft edges.
SETUP = """
import base64, io
from dataclasses import replace
import numpy as np
from PIL import Image
import glid_nb as glid
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import AS_SEEN
from glid_nb.session.scenery import Scenery
glid.enable_compilation_cache()
rows, columns = np.mgrid[:200, :250]
x, y = (columns + 0.5 - 125) * 0.08, (100 - rows - 0.5) * 0.08

def painted(color, distance):
    picture = np.full((200, 250, 4), 255, np.uint8)
    picture[..., :3] = color
    picture[(rows // 12 + columns // 12) % 2 == 0, :3] //= 2
    picture[..., 3] = 255 * np.clip(distance / 0.08 + 0.5, 0, 1)
    return picture

def domain(loop):
    return glid.Domain.from_cage(glid.Cage(loop))

def moved(domain, f):
    start = glid.HarmonicMap.identity(domain)
    return glid.HarmonicMap(domain, np.where(start.phi != 0, f(start.phi), 0), start.psi)

def disc(centre, radius):
    turns = np.exp(2j * np.pi * np.arange(24) / 24)
    return domain(np.stack([*(centre + 1.06 * radius * turns).view(float).reshape(-1, 2).T], 1))

def far(centre):
    return abs(x + 1j * y - centre)

across = np.linspace(-9, 9, 73)
bar = domain(np.concatenate([np.stack([s * across, 0 * across - 0.8 * s], 1) for s in (1, -1)]))
bar_picture = painted([255, 40, 40], 0.7 - abs(y))
bar_picture[:, 125:, :3] = bar_picture[:, 125:, 2::-1]
turn = 2j * np.pi / 15
curled = moved(bar, lambda z: (np.exp(turn * z) - 1) / turn)
behind, front = disc(-2 + 1j, 3.5), disc(3 + 0j, 2.0)
behind_picture = painted([60, 220, 60], 3.5 - far(-2 + 1j))
front_picture = painted([250, 220, 60], 2.0 - far(3 + 0j))
stripe = abs(y) < 0.5
front_picture[stripe, 3] = front_picture[stripe, 3] // 2
shown = [
    Scenery("behind", behind_picture, moved(behind, lambda z: z + 0.03 * z**2)),
    Scenery("front", front_picture, moved(front, lambda z: (z - 3) * 1.1 * np.exp(0.4j) + 2 + 2j),
            above=True),
]
canvas = glid.widgets.DeformCanvas(
    bar_picture, bar, 500, 400, n_vertices=6000, evaluated_in=how
)
model = canvas.deformation
model.paused = True
model.apply(lambda state: state.changed(pose=glid.Pose([[0, 0]], curled([[0, 0]])), map=curled))
canvas.pane.stage.view = [0.0, 0.0, 0.04]
canvas.show_scenery(shown)

def wanted(*layers):
    picture = np.full((400, 500, 4), 255, np.uint8)
    for image, map in layers:
        picture = glid.render(image, map, (500, 400), background=picture)
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, "PNG")
    return base64.b64encode(buffer.getvalue()).decode()

def layers():
    edited = canvas.image, canvas.deformation.state.map
    at = [(s.picture, s.map) for s in canvas.scenery]
    count = sum(not s.above for s in canvas.scenery)
    return [*at[:count], edited, *at[count:]]
"""

_SEEN = """(canvas) => {
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  copy.getContext('2d').drawImage(canvas, 0, 0);
  return copy.toDataURL('image/png').split(',')[1];
}"""


def _picture(data: str) -> Any:
    """The colours of a picture over white, (h, w, 3)."""
    image = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGBA")
    white = Image.new("RGBA", image.size, "white")
    return np.asarray(Image.alpha_composite(white, image))[..., :3].astype(float)


class Eye:
    """Compares what the canvas shows with what `render` draws."""

    def __init__(self, hand: Hand) -> None:
        self.hand, self.book = hand, hand.book
        self.drawn = hand.pane.locator(".jupyter-threejs canvas")

    def sees(self, name: str, layers: str = "layers()") -> None:
        """Wait until the canvas shows these pairs of pictures and maps, the backmost first."""
        wanted = _picture(self.book.value(f"wanted(*{layers})"))
        end = time.monotonic() + 20
        while True:
            seen = _picture(self.drawn.evaluate(_SEEN))
            assert seen.shape == wanted.shape
            difference = np.abs(seen - wanted).max(axis=2)
            # Edges of the pictures differ by how their pixels are mixed; a part that is missing,
            # or in a wrong order, by far more.
            if difference.mean() < 3 and (difference > 60).mean() < 0.005:
                break
            if time.monotonic() > end:
                both = np.concatenate([seen, wanted], axis=1).astype(np.uint8)
                Image.fromarray(both).save(ARTEFACTS / f"scenery-{name}-bad.png")
                far = f"{difference.mean():.2f} on average, {(difference > 60).mean():.2%} far off"
                raise AssertionError(f"{name}: the canvas differs from render by {far}")
            self.book.page.wait_for_timeout(50)
        self.book.screenshot(f"scenery-{name}", of=self.hand.pane)


@pytest.mark.parametrize("how", ["shader", "page", "kernel"])
def test_all_shapes_are_drawn_in_their_order(open_notebook: OpenNotebook, how: str) -> None:
    book = open_notebook([f"how = {how!r}\n{SETUP}\ncanvas"])
    hand = Hand(book, settle=False)
    eye = Eye(hand)
    eye.sees(f"{how}-order")
    # Only one map is another one: that alone is sent.
    another = "moved(behind, lambda z: z * 0.9 - 1)"
    book.value("None", f"canvas.show_scenery([replace(shown[0], map={another}), shown[1]])")
    eye.sees(f"{how}-another-map")
    # Both behind, then alone.
    book.value("None", "canvas.show_scenery([replace(s, above=False) for s in shown])")
    eye.sees(f"{how}-behind")
    book.value("None", "canvas.show_scenery([])")
    eye.sees(f"{how}-alone")


_PRESSES = """
models = {"bar": model, "behind": Deformation(behind, begin=False),
          "front": Deformation(front, begin=False)}
pictures = {"bar": bar_picture, "behind": behind_picture, "front": front_picture}
for key, map in (("behind", shown[0].map), ("front", shown[1].map)):
    models[key].paused = True
    models[key].apply(lambda state: state.changed(map=map))
pressed, order = [], ["behind", "bar", "front"]
edited = "bar"

def around(key):
    return [Scenery(k, pictures[k], models[k].state.map, models[k].state.order,
                    above=order.index(k) > order.index(key)) for k in order if k != key]

def switch(key, event):
    global edited
    pressed.append(key)
    edited = key
    canvas.edit(models[key], pictures[key], around(key))

canvas.on_other_part = switch
canvas.show_scenery(around("bar"))
"""


def test_a_press_goes_to_the_visible_shape(open_notebook: OpenNotebook) -> None:
    book = open_notebook([f"how = None\n{SETUP}{_PRESSES}\ncanvas"])
    hand = Hand(book, settle=False)
    eye = Eye(hand)
    eye.sees("before-a-press")
    at = "[models[k].state.map(p)[0].tolist() for k, p in " + (
        "(('front', [[3, 1.5]]), ('behind', [[-4, 1]]), ('bar', [[-1, 0]]))]"
    )
    on_front, on_behind, on_bar = book.value(at)
    hand.click(on_front)
    book.wait_for("edited == 'front' and len(models['front'].pose) == 1")
    assert book.value("models['front'].pose.handles.tolist()[0]") == pytest.approx(
        [3, 1.5], abs=0.1
    )
    eye.sees("front-is-edited")
    hand.click(on_behind)
    book.wait_for("edited == 'behind' and len(models['behind'].pose) == 1")
    eye.sees("behind-is-edited")
    hand.click(on_bar)
    book.wait_for("edited == 'bar' and len(models['bar'].pose) == 2")
    assert book.value("pressed") == ["front", "behind", "bar"]
    eye.sees("bar-is-edited")
    # A press on the edited shape stays with it, and one beside all shapes does nothing.
    hand.click([-9.5, 7.5])
    book.wait_for("not models['bar'].selection")
    assert book.value("[pressed, edited]") == [["front", "behind", "bar"], "bar"]


_PLAYS = """
import ipywidgets
from glid_nb.session.animation import Animation
from glid_nb.widgets import TimelinePanel

def later(model, map):
    model.apply(lambda state: state.with_current(replace(state.current, solution=AS_SEEN)))
    model.save_pose()
    seen = dict(map=map, solution=AS_SEEN)
    model.apply(lambda state: state.with_current(replace(state.current, **seen)))

panel = TimelinePanel(canvas)
others = {key: Animation(models[key]) for key in ("behind", "front")}
small = moved(bar, lambda z: 0.8 * (np.exp(0.6 * turn * z) - 1) / (0.6 * turn))
later(models["bar"], small)
later(models["behind"], moved(behind, lambda z: z * 0.8 + 3 + 1j))
later(models["front"], moved(front, lambda z: (z - 3) * np.exp(0.4j) - 4 - 2j))
canvas.show_scenery(around("bar"))
panel.accompany(others)

def at(time):
    return [(pictures[k], (others[k] if k in others else panel.animation).at(time)) for k in order]

box = ipywidgets.VBox([canvas, panel])
"""


@pytest.mark.parametrize("how", ["shader", "page", "kernel"])
def test_all_shapes_play_together(open_notebook: OpenNotebook, how: str) -> None:
    book = open_notebook([f"how = {how!r}\n{SETUP}{_PRESSES}{_PLAYS}\nbox"])
    hand = Hand(book, settle=False)
    eye, timeline = Eye(hand), Timeline(hand)
    proved = "[s.status for a in (panel.animation, *others.values()) for s in a.spans]"
    book.wait_for(f"{proved} == ['proved'] * 3", 60)
    eye.sees(f"{how}-second-pose")
    for seconds in (0.5, 0.2):
        bring_into_view(timeline.root)
        timeline.scrub([seconds])
        eye.sees(f"{how}-at-{seconds}", f"at({timeline.time})")
    hand.page.keyboard.press("Escape")
    eye.sees(f"{how}-second-pose-again")
