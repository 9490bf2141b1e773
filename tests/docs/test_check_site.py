"""The check of the built site finds planted errors."""

from __future__ import annotations

from pathlib import Path

import pytest

from glid_nb.figures import function, live
from tools.check_site import broken_links, faults_in_browser

GOOD = '<link rel="icon" href="data:,"><h1 id="a">A page</h1><a href="index.html#a">a</a>'

_SCROLLING = (
    '<math style="display: block; overflow-x: auto; width: 90px">'
    '<mrow><mspace width="2000px"></mspace><mi>x</mi></mrow></math>'
)
_DATA = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7"
_PICTURE = f'<img style="width: 2000px" src="{_DATA}">'
_PRINTED = '<pre style="overflow-x: auto; white-space: pre; width: 200px">{}</pre>'


def site(folder: Path, **pages: str) -> Path:
    for name, body in pages.items():
        text = f'<!doctype html><meta name="viewport" content="width=device-width">{body}'
        (folder / f"{name}.html").write_text(text, encoding="utf-8")
    return folder


def test_links_that_resolve_are_no_fault(tmp_path: Path) -> None:
    more = '<a href="#b">b</a><a name="b"></a><a href="https://a.example/b#c">elsewhere</a>'
    assert list(broken_links(site(tmp_path, index=GOOD, other=GOOD + more))) == []


@pytest.mark.parametrize("target", ["gone.html", "index.html#b", "#b", "gone.png", "../index.html"])
def test_a_link_to_nothing_is_found(tmp_path: Path, target: str) -> None:
    for tag in (f'<a href="{target}">', f'<img src="{target}">'):
        (fault,) = broken_links(site(tmp_path, index=GOOD, other=GOOD + tag))
        assert fault.startswith(f"other.html: {target}")


@pytest.mark.browser
@pytest.mark.slow
def test_a_browser_sees_errors_requests_wide_pages_and_dead_sliders(tmp_path: Path) -> None:
    bodies = {
        "plain": "",
        "error": "<script>throw Error('as it must')</script>",
        "request": '<img src="https://a.example/b.png">',
        "wide": '<div style="width: 2000px">wide</div>',
        "formula": f'<div class="equation"><div>{_SCROLLING}</div></div>',
        "sentence": f'<div class="cell_output">{_PRINTED.format("one word " * 40)}</div>',
        "table": f'<div class="cell_output columns">{_PRINTED.format("one  word " * 40)}</div>',
        "figure": f'<div class="cell_output" style="overflow-x: auto">{_PICTURE}</div>',
    }
    for name, slope in {"moving": 1, "still": 0}.items():
        figure = live(lambda a, slope=slope: function([0, 1], {"line": [0, slope * a]}), a=[1, 2])
        bodies[name] = figure._repr_mimebundle_()[0]["text/html"]
    bodies["dead"] = '<figure class="glid-frames"></figure>'
    pages = site(tmp_path, **{name: GOOD + body for name, body in bodies.items()})
    results = '<ul id="search-results"><li><a href="plain.html">found</a></li></ul>'
    found = list(faults_in_browser(site(pages, search=GOOD + results)))
    for name, words in {
        "error": "as it must",
        "request": "asks for https://a.example/b.png",
        "dead": "a figure has no slider",
        "still": "the slider a does not move the picture",
        "wide": "wider than the page: <div",
        "formula": "a formula, figure or sentence is cut off: x",
        "sentence": "a formula, figure or sentence is cut off: one word",
        "figure": "a formula, figure or sentence is cut off: <img",
    }.items():
        assert sum(fault.startswith(f"{name}.html") and words in fault for fault in found) == 2
    assert not any(fault.startswith(("plain", "moving", "table")) for fault in found)
