"""`make slides`: lectures made from the chapters' own cells."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import nbformat
import pytest
from playwright.sync_api import Locator

from tools import slides

from ..support.browser import launched_chromium, still_sliders

CHECKOUT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def lectures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slides")
    slides.main(folder)
    return folder


def outputs(numbers: tuple[str, ...]) -> list[Any]:
    """What the chapters' cells show, except exercises and their checks."""
    found = []
    for number in numbers:
        (path,) = slides.NOTEBOOKS.glob(f"{number}_*.ipynb")
        for cell in nbformat.read(path, as_version=4).cells:
            if not {"check", "exercise"} & set(cell.metadata.get("tags", ())):
                found += [out.get("data", {}) for out in cell.get("outputs", ())]
    return found


def test_there_is_a_file_for_each_lecture_of_the_lecturers_page(lectures: Path) -> None:
    page = (CHECKOUT / "docs" / "lecturers.md").read_text(encoding="utf-8")
    table = page.partition("## Six lectures")[2].partition("\n\n|")[2].partition("\n\n")[0]
    rows = re.findall(r"^\| (\d)\. .*? \| ([\w, ]+) \|", table, re.MULTILINE)
    listed = {number: tuple(chapters.split(", ")) for number, chapters in rows}
    assert {name[0]: numbers for name, numbers in slides.LECTURES.items()} == listed
    assert sorted(file.stem for file in lectures.glob("*.html")) == sorted(slides.LECTURES)


@pytest.mark.parametrize("name", slides.LECTURES)
def test_a_lecture_shows_every_figure_of_its_chapters(lectures: Path, name: str) -> None:
    text = (lectures / f"{name}.html").read_text(encoding="utf-8")
    shown = outputs(slides.LECTURES[name])
    live = sum("text/html" in data for data in shown)
    pictures = sum("image/png" in data and "text/html" not in data for data in shown)
    assert text.count('<figure class="glid-frames"') == live > 0
    assert len(re.findall(r'<div class="shown"><img src="data:image/png', text)) == pictures


@pytest.mark.parametrize("name", slides.LECTURES)
def test_a_lecture_shows_no_solution_and_needs_no_network(lectures: Path, name: str) -> None:
    text = (lectures / f"{name}.html").read_text(encoding="utf-8")
    assert "<details" not in text
    for number in slides.LECTURES[name]:
        (path,) = (slides.NOTEBOOKS / "solutions").glob(f"{number}_*.py")
        first = path.read_text(encoding="utf-8").partition(": solution\n")[2]
        assert first.splitlines()[0] not in text
    assert not re.search(r'(?:src|href)="https?:', text)


def test_a_point_is_a_first_sentence_with_the_equations_after_it() -> None:
    text = "Take **1. this** one, which has many more words. It is long. $$x^2$$ And more."
    made = slides.point(text)
    assert "Take <strong>1. this</strong> one, which has many more words." in made
    assert "long" not in made
    assert "<math" in made


def book(*cells: Any) -> Any:
    """A chapter: a text is Markdown, a tuple has the outputs of a cell of code."""
    made = nbformat.v4.new_notebook()
    for cell in cells:
        if isinstance(cell, str):
            made.cells.append(nbformat.v4.new_markdown_cell(cell))
        else:
            made.cells.append(nbformat.v4.new_code_cell(outputs=list(cell)))
    return made


PRINTED = nbformat.v4.new_output("stream", text="certified: True")
PICTURE = nbformat.v4.new_output("display_data", {"image/png": "AAAA"})


def test_what_a_cell_prints_stands_beside_its_figure() -> None:
    (slide,) = slides.slides(book("# A chapter\n\nIt has a sentence.", (PRINTED, PICTURE)))
    assert "certified" in slide.printed[0]
    assert "<img" in slide.figure


def test_a_second_figure_begins_a_slide() -> None:
    first, second = slides.slides(book("# A\n\nIt has a sentence.", (PICTURE,), (PICTURE,)))
    assert first.figure
    assert second.figure
    assert second.heading == "A"


def test_questions_exercises_and_summaries_are_whole() -> None:
    text = "# A\n\n**The question:** what is it? And why?\n\n## Summary\n\nIt is one. It is two."
    question, summary = slides.slides(book(text))
    assert "And why?" in question.points[0]
    assert "It is two." in summary.points[0]


def test_a_short_sentence_and_a_question_bring_the_next_one() -> None:
    assert "two" in slides.point("Drag the ring. It has two sliders. The rest is left out.")
    assert "two" in slides.point(
        "Is this point really the only minimum there is? It has two. Three."
    )
    assert "rest" not in slides.point("Drag the ring. It has two sliders. The rest is left out.")


def test_a_bracket_without_its_end_is_left_out() -> None:
    point = slides.point("(The paper has another sign for the larger one. We do not.)")
    assert "(" not in point


@pytest.mark.parametrize("last", ["$$\nx = 1\n$$", "where x is the largest number of all."])
def test_a_sentence_that_goes_on_stays_on_its_slide(last: str) -> None:
    before = [f"This sentence number {i} is long enough to stand alone." for i in range(4)]
    text = "\n\n".join(["# A", *before, "With the largest number of all", last])
    assert len(list(slides.slides(book(text)))) == 1
    more = "\n\n".join(["# A", *before, before[0], before[0]])
    assert len(list(slides.slides(book(more)))) == 2


@pytest.mark.browser
def test_slides_change_and_live_figures_move(lectures: Path) -> None:
    with launched_chromium() as browser:
        page = browser.new_page(viewport={"width": 1366, "height": 768})
        failed: list[str] = []
        page.on("pageerror", lambda error: failed.append(str(error)))
        page.goto((lectures / "1-folding.html").as_uri())
        assert page.locator("section.now").count() == 1
        assert still_sliders(page.locator("section.now .glid-frames")) == []
        page.locator("section.now h1").click()
        page.keyboard.press("ArrowRight")
        assert page.locator("section.now h2").inner_text() == "Holomorphic functions"
        page.keyboard.press("n")
        assert page.locator("section.now aside").is_visible()
        assert not failed


_TOO_LARGE = """() => [...document.querySelectorAll('section')].flatMap((slide, i) => {
  go(i);
  const { scrollHeight, clientHeight, scrollWidth, clientWidth } = slide;
  const fits = scrollHeight <= clientHeight + 1 && scrollWidth <= clientWidth + 1;
  return fits ? [] : [`slide ${i + 1}: ${scrollWidth} x ${scrollHeight}`];
})"""

_CLIPPED = """() => [...document.querySelectorAll('section')].flatMap((slide, i) => {
  go(i);
  return [...slide.querySelectorAll('math[display=block], pre')]
    .filter((shown) => shown.scrollWidth > shown.clientWidth + 1)
    .map((shown) => `slide ${i + 1}: ${shown.textContent}`);
})"""
_LIVE = """() => [...document.querySelectorAll('.glid-frames')]
  .every((figure) => figure.querySelector('input'))"""
_WITH_RINGS = """() => [...document.querySelectorAll('section')]
  .flatMap((slide, i) => (slide.querySelector('.glid-ring') ? [i] : []))"""


def moved_by_ring(figure: Locator) -> bool:
    """Whether dragging the ring across the figure moves a slider."""
    values = "(found) => found.map((one) => one.value)"
    before = figure.locator("input").evaluate_all(values)
    ring, picture = (
        figure.locator(".glid-ring").bounding_box(),
        figure.locator("img").bounding_box(),
    )
    assert ring is not None
    assert picture is not None
    x, y = ring["x"] + ring["width"] / 2, ring["y"] + ring["height"] / 2
    mouse = figure.page.mouse
    mouse.move(x, y)
    mouse.down()
    for share in (0.0, 1.0):  # to the one end and to the other
        mouse.move(
            picture["x"] + share * picture["width"], picture["y"] + share * picture["height"]
        )
    mouse.up()
    return figure.locator("input").evaluate_all(values) != before


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("width", [1366, 1024])
def test_every_slide_fits_a_projector_and_rings_are_dragged_on_slides(
    lectures: Path, width: int
) -> None:
    with launched_chromium() as browser:
        page = browser.new_page(viewport={"width": width, "height": 768})
        for name in slides.LECTURES:
            page.goto((lectures / f"{name}.html").as_uri())
            page.wait_for_function(_LIVE)
            assert page.evaluate(_TOO_LARGE) == []
            assert page.evaluate(_CLIPPED) == []
            rings = page.evaluate(_WITH_RINGS)
            for number in rings:
                page.evaluate("go", number)
                assert moved_by_ring(page.locator("section.now .glid-frames")), f"{name}, {number}"


_WIDE = """() => [...document.querySelectorAll('section')].flatMap((slide, i) => {
  go(i);
  return slide.scrollWidth <= slide.clientWidth + 1 ? [] : [`slide ${i + 1}`];
})"""
_SMALLEST = """() => Math.min(...[...document.querySelectorAll('section')].map((slide, i) => {
  go(i);
  const shown = slide.querySelector('div');
  return Number(shown.style.zoom || 1) * parseFloat(getComputedStyle(shown).fontSize);
}))"""


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("size", [(844, 390), (390, 844), (1024, 768)])
def test_slides_on_small_screens_have_legible_letters_and_scroll_only_downwards(
    lectures: Path, size: tuple[int, int]
) -> None:
    with launched_chromium() as browser:
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.goto((lectures / "2-the-space-of-maps.html").as_uri())
        page.wait_for_function(_LIVE)
        assert page.evaluate(_WIDE) == []
        assert page.evaluate(_SMALLEST) >= 13


def test_long_code_breaks_only_between_its_words() -> None:
    made = slides.rendered("in `energies.ExponentialSymmetricDirichlet(s)`, `np.roll`")
    assert "<code>energies.<wbr>Exponential<wbr>Symmetric<wbr>Dirichlet(<wbr>s)</code>" in made
    assert "<code>np.roll</code>" in made


def test_punctuation_stays_with_its_formula() -> None:
    assert re.search(
        r'<span class="formula"><math.*?</math>,</span> so', slides.rendered("$v$, so")
    )


def test_a_printed_table_keeps_its_columns() -> None:
    cell = nbformat.v4.new_code_cell()
    cell.outputs = [nbformat.v4.new_output("stream", text="  BDHM: 0.5\nNewton: 0.6\n")]
    assert list(slides.shown(cell)) == ['<pre class="columns">  BDHM: 0.5\nNewton: 0.6</pre>']
