"""The destination of results: a file, standard output, or a folder for many inputs."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from glid_nb._errors import InputFileError
from glid_nb.cli.output import (
    BAD_INPUT,
    STANDARD_OUTPUT,
    about_input,
    check_failures,
    check_folder,
    tell_error,
)


class Destination(NamedTuple):
    """The destination that a flag such as ``--out`` names."""

    path: Path
    is_folder: bool  # the text ends with a slash, or the folder exists


def destination(text: str) -> Destination:
    """Parse the argument of a flag, for argparse. ``-`` is standard output, ``./-`` a file."""
    if text == "-":
        return Destination(STANDARD_OUTPUT, False)
    path = Path(text)
    return Destination(path, text.endswith(("/", os.sep)) or path.is_dir())


def planned(
    inputs: Sequence[Path], flag: str, to: Destination | None, suffix: str
) -> list[Path | None]:
    """The file of each input's result. In a folder, the files have the inputs' names.

    A missing folder is made. Raises an InputFileError for many results with only one file, or for
    two results with the same name.
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
            raise InputFileError(f"{what}; give them different names, or run them separately")
        files[file] = given
    to.path.mkdir(parents=True, exist_ok=True)
    return list(files)


def for_each(inputs: Sequence[Path], run: Callable[[int], None], debug: bool = False) -> None:
    """Run every input, also after one that fails. Raises an InputError at the end if any failed."""
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
            tell_error(about_input(given, error))
            failed += 1
    check_failures(failed, len(inputs))


def refuse_standard_output(path: Path, flag: str, needs: str) -> None:
    """Raise an InputFileError for ``-`` if a command's results do not fit one stream."""
    if str(path) == "-":
        raise InputFileError(f"{flag} -: {needs}")
