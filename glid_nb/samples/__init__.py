"""Pictures drawn for this project, with two poses each.

The pictures are RGBA with a transparent background. In a checkout
``python -m studies.samples.draw`` draws them again. For a name or kind that does not exist every
function raises SampleError, which lists those that do.
"""

from pathlib import Path
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb._errors import InputError

PoseKind: TypeAlias = Literal["gentle", "extreme"]

_NAMES = ("gecko", "teapot", "frog", "monstera", "gingerbread", "bar")
_PICTURES = Path(__file__).parent / "pictures"


class SampleError(InputError):
    """There is no such sample, or it has no such pose."""


def names() -> tuple[str, ...]:
    """Names of the samples, the plainest shape last."""
    return _NAMES


def path(name: str) -> Path:
    """The PNG file of a sample."""
    if name not in _NAMES:
        raise SampleError(f"there is no sample {name!r}: choose one of {', '.join(_NAMES)}")
    return _PICTURES / f"{name}.png"


def image(name: str) -> NDArray[np.uint8]:
    """(h, w, 4) RGBA pixels of a sample, not premultiplied, row 0 at the top."""
    with Image.open(path(name)) as picture:
        return np.array(picture.convert("RGBA"))


def name_of(pixels: NDArray[np.uint8]) -> str | None:
    """The name of the sample with exactly these pixels (h, w, 4); None if there is none."""
    for name in _NAMES:
        with Image.open(path(name)) as picture:
            same_size = picture.size == pixels.shape[1::-1]
        if same_size and np.array_equal(image(name), pixels):
            return name
    return None


def pose_path(name: str, kind: PoseKind) -> Path:
    """The JSON file of a sample's pose, "gentle" or "extreme".

    It holds `handles` and `targets`, lists of [x, y] in world coordinates, and `description`.
    """
    kinds = get_args(PoseKind)
    if kind not in kinds:
        raise SampleError(f"there is no pose {kind!r}: choose one of {', '.join(kinds)}")
    return path(name).with_suffix(f".{kind}.json")
