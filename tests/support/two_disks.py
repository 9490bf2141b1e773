"""A session of two parts: a red disk, which moves upwards behind a blue one."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import numpy as np

from glid_nb.imaging.backdrop import WHITE
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.look import Look


def disk(x: float, y: float, color: tuple[int, int, int]) -> np.ndarray:
    """A disk with stripes, so that its inside shows a deformation too."""
    rows, columns = np.mgrid[:360, :480]
    pixels = np.zeros((360, 480, 4), np.uint8)
    inside = np.hypot(columns - x, rows - y) < 90
    pixels[inside] = (*color, 255)
    pixels[inside & (rows // 20 % 2 == 0), :3] //= 2
    return pixels


@contextlib.contextmanager
def two_disks() -> Iterator[EditorModel]:
    """The session at its second pose. The white background lies behind both."""
    pictures = {"red": disk(180, 210, (220, 60, 30)), "blue": disk(290, 180, (30, 60, 220))}
    made = EditorModel(parts=pictures)
    made.set_look(Look(background=WHITE))
    deformation = made.deformation
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    middle = deformation.add_handle((x, y))
    side = deformation.add_handle((x - 2, y))
    deformation.save_pose()
    deformation.drag(middle, to=(x + 0.5, y + 1.5))
    deformation.drag(side, to=(x - 1.5, y + 2.5))
    deformation.solve()
    yield made
    made.close()
