"""The browser, for tests that look at exported pages."""

from ..widgets.conftest import browser, page

__all__ = ["browser", "page"]
