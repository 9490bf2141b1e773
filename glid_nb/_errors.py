"""Errors for bad input: the base class, a place in front of messages, "did you mean"."""

import difflib
import re
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


class InputError(ValueError):
    """Bad input, the only kind of error that is not a bug. The message says what to do.

    ``plain`` is the message for users of the editor. It names controls and pins, not options and
    handles.
    """

    def __init__(self, message: str, plain: str | None = None) -> None:
        super().__init__(message)
        self.plain = message if plain is None else plain

    def _render_traceback_(self) -> list[str]:
        """The traceback that IPython prints: the user's lines only, none of IPython or this
        package."""
        from IPython import get_ipython  # noqa: PLC0415 - only IPython calls this

        ours, name_of = str(Path(__file__).parent), get_ipython().compile.format_code_name
        lines = []
        for frame in traceback.extract_tb(self.__traceback__)[1:]:
            if frame.filename.startswith(ours):
                break
            where = " ".join(name_of(frame.filename) or ("File", frame.filename))
            lines.append(f"{where}, line {frame.lineno}\n    {frame.line}")
        return [*lines, f"{type(self).__name__}: {self}"]


def plainly(error: Exception) -> str:
    """What an error says to users of the editor."""
    return error.plain if isinstance(error, InputError) else str(error)


class IncompatibleVersionsError(InputError, AttributeError):
    """Installed libraries lack a required feature or do not fit together."""


class InputFileError(InputError):
    """A file has the wrong content; the message names the file and the key."""


@contextmanager
def about(where: str | Path, kind: type[InputError] = InputFileError) -> Iterator[None]:
    """Put ``where``, a file or a key, in front of an InputError's message, and raise it as
    ``kind``.
    """
    try:
        yield
    except InputError as error:
        texts = (_placed(where, text) for text in (str(error), error.plain))
        raise kind(*texts).with_traceback(error.__traceback__) from None
    except RecursionError:  # the checks recurse into nested lists
        raise kind(f"{where}: its values are nested too deep") from None


def _placed(where: str | Path, text: str) -> str:
    """A message with ``where`` in front, unless it begins so."""
    begins = re.match(rf"{re.escape(str(where))}(: | (is|has|holds|must) )", text)
    return text if begins else f"{where}: {text}"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a message, such as ``; did you mean 'cage'?``; empty if no name is similar."""
    near = difflib.get_close_matches(str(name), list(known), 1)
    return f"; did you mean {near[0]!r}?" if near else ""
