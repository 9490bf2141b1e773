"""Run by the Python of another environment: a command of glid-nb, or the editor, from its wheel.

``python installed.py CHECKOUT WORD ...`` runs ``glid-nb WORD ...``; ``editor`` makes an editor and
saves a session, ``motion`` a motion. Warnings are errors, and so is opening a file of the checkout.
"""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

_OWN = Path(__file__).resolve()


def forbid_files_below(checkout: Path) -> None:
    """Refuse every file of the checkout except this script. Opened files are remembered."""
    root = os.path.realpath(checkout) + os.sep

    def audit(event: str, arguments: tuple[object, ...]) -> None:
        if event == "open" and isinstance(arguments[0], str | os.PathLike):
            path = os.path.realpath(arguments[0])
            if path.startswith(root) and path != str(_OWN):
                raise RuntimeError(f"{path} of the checkout is opened")

    sys.addaudithook(audit)


def make_warnings_errors() -> None:
    warnings.simplefilter("error")
    # pythreejs and its ipydatawidgets set trait metadata in a way that traitlets 5 deprecates.
    for module in ("traittypes", "ipydatawidgets"):
        message = ".*metadata.*was set from the constructor.*"
        warnings.filterwarnings("ignore", message, DeprecationWarning, module)


def editor() -> None:
    import glid_nb as glid

    editor = glid.Editor(glid.samples.image("gingerbread"))
    bounds = editor.document.domain.cage.exterior
    left, right = bounds[bounds[:, 0].argmin()], bounds[bounds[:, 0].argmax()]
    editor.add_handle(0.9 * left)
    editor.add_handle(0.9 * right)
    editor.drag(1, to=0.8 * right)
    assert editor.solve(timeout=200)
    assert editor.certificate.certified
    editor.save("session.glid")


def motion() -> None:
    import glid_nb as glid

    last = glid.HarmonicMap.load(Path("demo") / "map.json")
    glid.Motion([glid.HarmonicMap.identity(last.domain), last]).save("walk.motion.json")


def main(checkout: str, *words: str) -> None:
    make_warnings_errors()
    forbid_files_below(Path(checkout))
    import glid_nb
    from glid_nb.cli import main as command

    assert Path(glid_nb.__file__).is_relative_to(sys.prefix), glid_nb.__file__
    if words == ("editor",):
        editor()
    elif words == ("motion",):
        motion()
    else:
        sys.exit(command(words))


if __name__ == "__main__":
    main(*sys.argv[1:])
