"""Draw the samples anew: ``python -m studies.samples.draw [NAME ...] [--out DIR]``.

With the same versions of the libraries, the files are the same to the last bit. Another version of
the rasteriser may change pixels on an edge by a few grey levels.
"""

import argparse
import importlib
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb import samples
from glid_nb._files import write_atomically


def draw(name: str) -> NDArray[np.uint8]:
    """Draw a sample: RGBA (h, w, 4)."""
    module = importlib.import_module(f"studies.samples.drawings.{samples.path(name).stem}")
    return module.draw()


def png(rgba: NDArray[np.uint8]) -> bytes:
    """The pixels as a PNG file, with the strongest compression."""
    file = io.BytesIO()
    Image.fromarray(rgba).save(file, "PNG", optimize=True)
    return file.getvalue()


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the named samples, by default all, into a folder, by default that of the package."""
    parser = argparse.ArgumentParser(prog="python -m studies.samples.draw", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="default: all samples")
    parser.add_argument("--out", type=Path, metavar="DIR", help="default: into the package")
    given = parser.parse_args(arguments)
    try:
        places = [samples.path(name) for name in given.names or samples.names()]
    except samples.SampleError as error:
        parser.error(str(error))
    for place in places:
        file = place if given.out is None else given.out / place.name
        write_atomically(file, png(draw(place.stem)))
        print(file)


if __name__ == "__main__":
    main()
