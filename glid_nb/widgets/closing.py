"""The base class of our widgets, and how they close.

Closing a widget closes its parts. A cell that runs again closes its old widgets.
"""

import functools
import inspect
import sys
import weakref
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any, ParamSpec

import ipywidgets

from glid_nb._arguments import check_keywords

P = ParamSpec("P")

# For each cell: its last run, and the widgets that this run made.
widgets_of_cells: dict[str, tuple[str, weakref.WeakSet[Any]]] = {}


class ClosingWidget(ipywidgets.Widget):
    """The first base class of a widget. It refuses unknown keywords and closes all its parts."""

    _endings: tuple[Callable[[], Any], ...] = ()  # functions that closing calls
    _closed = False  # whether closing has begun; other threads check this before they draw

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        """Check the keywords before anything is made."""
        own = [name for name in inspect.signature(cls.__init__).parameters if name != "self"]
        traits = [name for name in cls.class_trait_names() if not name.startswith("_")]
        check_keywords(cls.__name__, kwargs, [*own, *traits])
        return super().__new__(cls, *args, **kwargs)

    def close(self) -> None:
        """Remove this and its parts from the page, and end its threads. A given model stays."""
        if self.comm is None:  # closed before, or its constructor raised
            return
        self._closed, endings, self._endings = True, self._endings, ()
        for end in endings:
            end()
        _, *parts = _with_parts(self)
        super().close()
        for part in parts:
            part.close()


def close_with_parts(*widgets: ipywidgets.Widget) -> None:
    """Close widgets and their parts, such as layouts, which ipywidgets would keep."""
    for widget in _with_parts(*widgets):
        widget.close()


def _with_parts(*widgets: ipywidgets.Widget) -> list[ipywidgets.Widget]:
    found: dict[int, ipywidgets.Widget] = {}
    waiting = list(widgets)
    while waiting:
        widget = waiting.pop()
        if id(widget) not in found:
            found[id(widget)] = widget
            for name in widget.traits(sync=True):
                waiting += _widgets_in(getattr(widget, name))
    return list(found.values())


def _widgets_in(value: Any) -> Iterator[ipywidgets.Widget]:
    if isinstance(value, ipywidgets.Widget):
        yield value
    elif isinstance(value, (list, tuple, dict)):
        for item in value.values() if isinstance(value, dict) else value:
            yield from _widgets_in(item)


def one_a_cell(make: Callable[P, None]) -> Callable[P, None]:
    """A constructor that finally closes the widgets from earlier runs of its cell.

    Their solvers are stopped during the constructor. If it raises, they continue.
    """

    @functools.wraps(make)
    def made(*arguments: P.args, **named: P.kwargs) -> None:
        new: Any = arguments[0]
        cell, run = running_cell()
        last_run, others = widgets_of_cells.get(cell, (run, weakref.WeakSet()))
        earlier = [] if last_run == run else list(others)
        with ExitStack() as going_on:
            for model in (old.model for old in earlier if old.model.has_shape):
                if model.deformation.busy:
                    model.deformation.stop()
                    going_on.callback(model.deformation.solve, timeout=0)
            make(*arguments, **named)
            going_on.pop_all()
        for old in earlier:
            old.close()
            _forget(old)
        if earlier:
            new.model.take_over_file()
        if cell:
            widgets_of_cells[cell] = (
                run,
                weakref.WeakSet([new, *(others if last_run == run else ())]),
            )

    return made


def _forget(closed: Any) -> None:
    """Remove a closed widget from ``Out`` and from names such as ``_12``, which keep it alive."""
    shell = sys.modules["IPython"].get_ipython()
    spaces = [getattr(shell, name, {}) for name in ("user_ns", "user_ns_hidden")]
    for names in (spaces[0].get("_oh", {}), *spaces):
        for name in [n for n, value in names.items() if value is closed]:
            if str(name).removeprefix("_").isdigit():  # not a name that the user chose
                del names[name]


def running_cell() -> tuple[str, str]:
    """The identities of the cell and of its run; empty if the notebook does not provide them."""
    ipython = sys.modules.get("IPython")
    shell: Any = None if ipython is None else ipython.get_ipython()
    parent = getattr(shell, "get_parent", dict)()
    cell = parent.get("metadata", {}).get("cellId")
    run = parent.get("header", {}).get("msg_id")
    return (str(cell), str(run)) if cell and run else ("", "")
