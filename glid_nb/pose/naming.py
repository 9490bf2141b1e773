"""How sentences name handles: as Python counts them, or as the editor's list of pins does."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Naming:
    """How sentences name handles: by a word, and by numbers from ``first`` on."""

    word: str
    first: int

    def __call__(self, *indices: int) -> str:
        """For example "handle 3", "handles 0 and 3" or "handles 0, 2 and 3"."""
        *others, last = (str(self.first + index) for index in indices)
        return f"{self.word}s {', '.join(others)} and {last}" if others else f"{self.word} {last}"


HANDLES = Naming("handle", 0)  # in Python
PINS = Naming("pin", 1)  # in the editor


def in_both(message: Callable[[Naming], str]) -> tuple[str, str]:
    """A message for Python, and the same for users of the editor: the arguments of an
    `InputError`."""
    return message(HANDLES), message(PINS)
