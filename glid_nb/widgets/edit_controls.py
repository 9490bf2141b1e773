"""The base of boxes of controls over a deformation."""

from __future__ import annotations

import html
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, ClassVar

import ipywidgets

from glid_nb.session.deformation import Deformation


class EditControls(ipywidgets.VBox):
    """Controls that show a deformation, change it, and say why a change was refused.

    A subclass makes its controls, calls this constructor, :meth:`_show`, and :meth:`_watch`.
    """

    _stop: Callable[[], None] | None = None

    _refusals: ClassVar[type[Exception]] = ValueError
    """What the model refuses a change with."""

    def __init__(
        self, deformation: Deformation, children: Sequence[ipywidgets.Widget], **kwargs: Any
    ) -> None:
        self.deformation = deformation
        """The model that this is a view of."""
        self.refusal = ipywidgets.HTML()
        """Why the last change was refused."""
        # Per thread: the model may change in one while a control is used in another.
        self._here = threading.local()
        super().__init__([*children, self.refusal], **kwargs)

    @property
    def _showing(self) -> bool:
        """Whether this thread's changes of controls come from the model."""
        return getattr(self._here, "showing", False)

    @contextmanager
    def _while_showing(self) -> Iterator[None]:
        self._here.showing = True
        try:
            yield
        finally:
            self._here.showing = False

    def _show(self) -> None:
        """Update the controls, which must not change the model."""
        raise NotImplementedError

    def _watch(self) -> None:
        self._stop = self.deformation.observe(self._on_model)

    def _on_model(self, what: str) -> None:
        if what == "state" and not self.deformation.dragged:
            self._show()

    def _act(self, act: Callable[[], None]) -> None:
        try:
            act()
            self.refusal.value = ""
        except self._refusals as error:
            self.refusal.value = f"<span style='color:#d55e00'>{html.escape(str(error))}</span>"
            self._show()

    def close(self) -> None:
        """Stop watching; the model lives on."""
        if self._stop is None:  # the constructor raised
            return
        self._stop()
        super().close()
