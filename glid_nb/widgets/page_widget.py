"""The base class of the widgets whose page is a bundle of ``page/js``."""

import uuid
from typing import Any

import anywidget
import traitlets

from glid_nb.page import bundle


class PageWidget(anywidget.AnyWidget):
    """A widget that loads the text of its trait ``_script`` as a module, once for each page.

    On a slow page, anywidget gives a widget up when its small module takes more than two seconds;
    from then on the widget would hear nothing from the kernel. ``page/js/pad/loader.js`` notices,
    listens itself and asks for what came meanwhile.
    """

    _esm = bundle("loader")
    _script = traitlets.Unicode().tag(sync=True)
    _own_id = traitlets.Unicode().tag(sync=True)
    """The identifier of this model, with which the page finds it."""

    def __init__(self, **kwargs: Any) -> None:
        own_id = uuid.uuid4().hex
        super().__init__(model_id=own_id, _own_id=own_id, **kwargs)
