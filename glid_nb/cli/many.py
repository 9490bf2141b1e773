"""Where results go: a file, standard output, or a folder for those of many inputs."""

import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from glid_nb._errors import InputError, InputFileError
from glid_nb.cli.output import BAD_INPUT, STANDARD_OUTPUT, check_folder, one_line


class Destination(NamedTuple):
    """What a flag such as ``--out`` names."""

    path: Path
    is_folder: bool  # it is written with a slash at its end, or is there


def destination(text: str) -> Destination:
    """The argument of a flag, for argparse; ``-`` is standard output, ``./-`` a file."""
    if text == "-":
        return Destination(STANDARD_OUTPUT, False)
    path = Path(text)
    return Destination(path, text.endswith(("/", os.sep)) or path.is_dir())


def planned(
    inputs: Sequence[Path], flag: str, to: Destination | None, suffix: str
) -> list[Path | None]:
    """The file of each input's result: in a folder, which is made, those of their names.

    An InputFileError for many results that one file cannot hold, or two of one name.
    """
    if to is None:
        return [None] * len(inputs)
    many = len(inputs) > 1
    if to.path is STANDARD_OUTPUT:
        if many:
            what = f"{flag} -: standard output takes the result of one input"
            raise InputFileError(f"{what}, and there are {len(inputs)}; name a folder")
        return [STANDARD_OUTPUT]
    if not many and not to.is_folder:
        return [to.path]
    if to.path.suffix and not to.is_folder:
        what = f"{flag} {to.path} is a file for the results of {len(inputs)} inputs"
        raise InputFileError(f"{what}; name a folder, such as {to.path.with_suffix('')}/")
    check_folder(to.path)
    files: dict[Path, Path] = {}
    for given in inputs:
        file = to.path / (given.stem + suffix)
        if (other := files.get(file)) is not None:
            what = f"{other} and {given} would both be written to {file}"
            raise InputFileError(f"{what}; give them different names, or run them apart")
        files[file] = given
    to.path.mkdir(parents=True, exist_ok=True)
    return list(files)


def for_each(inputs: Sequence[Path], run: Callable[[int], None], debug: bool = False) -> None:
    """Run every input, those too that come after one that fails; an InputError at the end, then."""
    if len(inputs) == 1:
        run(0)
        return
    failed = 0
    for i, given in enumerate(inputs):
        try:
            run(i)
        except BAD_INPUT as error:
            if debug:
                raise
            text = one_line(error)
            text = text if str(given) in text else f"{given}: {text}"
            print(f"glid-nb: error: {text}", file=sys.stderr)
            failed += 1
    if failed:
        raise InputError(f"{failed} of {len(inputs)} inputs failed, for the reasons above")


def refuse_standard_output(path: Path, flag: str, needs: str) -> None:
    """Raise an InputFileError for ``-`` where a command writes what one stream cannot hold."""
    if str(path) == "-":
        raise InputFileError(f"{flag} -: {needs}")
