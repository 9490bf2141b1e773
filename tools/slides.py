"""Write slides for lectures from the chapters' own cells: ``python tools/slides.py [FOLDER]``.

Each lecture is one HTML file that needs no network and no kernel: figures with sliders move in it.
A section of a chapter becomes a slide, with the first sentence of each paragraph, the equations and
the figures. The chapter's question, exercises and the summary are whole. All of the text is in the
notes, which N shows. `docs/lecturers.md` lists the lectures.
"""

from __future__ import annotations

import base64
import html
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import nbformat
from nbconvert.filters import markdown2html
from nbformat import NotebookNode

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from docs.extensions.printed import has_columns
from tools.equations import displayed, mathml, pieces

REPOSITORY = Path(__file__).resolve().parent.parent
NOTEBOOKS = REPOSITORY / "notebooks"
FONT = REPOSITORY / "docs" / "static" / "math.woff"
LECTURES = {
    "1-folding": ("00", "02", "03"),
    "2-the-space-of-maps": ("04", "05"),
    "3-distortion": ("06",),
    "4-newton": ("07", "08"),
    "5-the-certificate": ("09", "09b"),
    "6-others-speed-motion": ("10", "11", "12"),
}
"""The chapters of each lecture, by the name of its file."""

_LEFT_OUT = re.compile(r"\*\*(?:Further|Next|Before this|Minutes)")
_MOST = 5  # points of a slide
_AFTER = 2  # points that stay on a slide after its figure: what to see in it
_PRINTED = 2  # printed outputs of a slide
_ROWS = 6  # of a table with printed outputs on its slide
_WHOLE = ("Exercise", "Summary")  # headings of which all is shown
_SHORT = 40  # letters of a sentence that says too little alone, such as "Drag the ring."
_LONG = 20  # letters of code that may take two lines
_MATH = re.compile(r"\$\$(.+?)\$\$|(?<![\\$])\$(?!\s)(.+?)(?<!\s)\$", re.DOTALL)
_CODE = re.compile(r"(?<!<pre>)<code>([^<]*)</code>")
# After a dot, a slash and the like, and between the words of `LikeThis`.
_WORD_ENDS = re.compile(r"(?<=[\w)][./_(=])(?=\w)|(?<=[a-z])(?=[A-Z][a-z])")
_NUMBER = re.compile(r"\\tag\*?\{([^{}]*)\}")
# A sentence ends before a capital letter, a formula or bold text.
_SENTENCE = re.compile(r"(?<=[^\d][.!?])[)\"]?\s+(?=[A-Z$*`(])")


@dataclass
class Slide:
    """A heading, points, and below them printed text and a figure."""

    heading: str
    points: list[str] = field(default_factory=list)
    printed: list[str] = field(default_factory=list)
    figure: str = ""
    notes: list[str] = field(default_factory=list)
    level: int = 2
    after: int = 0
    """Points that come after the figure."""

    @property
    def empty(self) -> bool:
        return not (self.points or self.printed or self.figure)

    def takes(self, output: str) -> bool:
        """Whether there is room for another output of a cell."""
        if _is_printed(output):
            rows = sum(one.count("<tr") for one in self.points)
            return len(self.printed) < _PRINTED and rows <= _ROWS
        return not self.figure

    def add(self, output: str) -> None:
        if _is_printed(output):
            self.printed.append(output)
        else:
            self.figure = output


def rendered(markdown: str) -> str:
    """HTML of Markdown with equations."""
    made: list[str] = []

    def kept(found: re.Match[str]) -> str:
        latex, inline = found[1], found[2]
        if latex is None:
            made.append(mathml(inline, "inline"))
        else:
            number = _NUMBER.search(latex)
            formulas = pieces(_NUMBER.sub("", latex).strip().rstrip("."))
            made.append("".join(map(displayed, formulas)))
            made[-1] += f"<small>({number[1]})</small>" if number else ""
            made[-1] = f'<span class="formulas">{made[-1]}</span>'
        return f"QMATH{len(made) - 1}Q"

    text = _MATH.sub(kept, markdown)
    text = re.sub(r"\]\([^)]*\.ipynb[^)]*\)|\]\(\.\./[^)]*\)", "]()", text)
    text = markdown2html(text)
    text = re.sub(r'<a href="">(.*?)</a>', r"\1", text)
    text = _CODE.sub(lambda found: f"<code>{breakable(found[1])}</code>", text)
    return re.sub(
        r"QMATH(\d+)Q([.,;:?!)]*)", lambda found: with_marks(made[int(found[1])], found[2]), text
    )


def with_marks(formula: str, marks: str) -> str:
    """A formula and the punctuation after it, which stays on its line."""
    return f'<span class="formula">{formula}{marks}</span>' if marks else formula


def breakable(code: str) -> str:
    """Code that goes on in a new line only between its words, and only if it is long."""
    return _WORD_ENDS.sub("<wbr>", code) if len(code) > _LONG else code


def blocks(markdown: str) -> Iterator[str]:
    """The parts between empty lines; a fence of code stays whole."""
    fence: list[str] = []
    for part in re.split(r"\n\s*\n", markdown.strip()):
        fence.append(part)
        if sum(p.count("```") for p in fence) % 2 == 0:
            yield "\n\n".join(fence)
            fence = []


def slides(book: NotebookNode) -> Iterator[Slide]:
    """The slides of a chapter."""
    now, before = Slide(""), ""

    def continued() -> Slide:
        return Slide(now.heading, level=max(now.level, 2))

    for cell in book.cells:
        tags = cell.metadata.get("tags", ())
        if cell.cell_type == "code":
            if {"check", "exercise", "remove-cell"} & set(tags):
                continue
            for output in shown(cell):
                if not now.takes(output):
                    yield now
                    now = continued()
                now.add(output)
            continue
        if cell.source.startswith("<details>"):  # a solution
            continue
        for block in blocks(with_pictures(cell)):
            heading = re.match(r"(#{1,3}) +(.+)", block)
            if heading:
                if not now.empty:
                    yield now
                now = Slide(heading[2], level=len(heading[1]))
                block = block[heading.end() :].strip()
            if not block or _LEFT_OUT.match(block):
                continue
            now.after += bool(now.figure or now.printed)
            full = now.after > _AFTER or len(now.points) >= _MOST
            goes_on = bool(now.notes) and within_sentence(before, block)
            if full and not goes_on:
                yield now
                now = continued()
            before = block
            now.notes.append(rendered(block))
            whole = now.heading.startswith(_WHOLE)
            now.points.append(rendered(block) if whole else point(block))
    if not now.empty:
        yield now


def within_sentence(before: str, block: str) -> bool:
    """Whether a sentence goes on from one block to the next, often into an equation."""
    if block.startswith("$$"):
        return not before.endswith((".", "?"))
    return block[0].islower()


def with_pictures(cell: NotebookNode) -> str:
    """The text of a cell, with its attached pictures inside."""
    text = cell.source
    for name, data in cell.get("attachments", {}).items():
        text = text.replace(f"attachment:{name}", f"data:image/png;base64,{data['image/png']}")
    return text


def point(block: str) -> str:
    """What a slide shows of a block: all of an equation, list, table, fence or of the chapter's
    question, else a sentence. The next one follows too if that is a question, or short."""
    if re.match(r"\$\$|\||- |\d\. |```|!\[|\*\*The question", block):
        return rendered(block)
    first, *more = _SENTENCE.split(block, maxsplit=1)
    if more and (first.endswith("?") or len(first) < _SHORT):
        second, *more = _SENTENCE.split(more[0], maxsplit=1)
        first = f"{first} {second}"
    if first.startswith("(") and first.count("(") > first.count(")"):
        first = first[1:]  # its end is left out
    equations = [found[0] for rest in more for found in _MATH.finditer(rest) if found[1]]
    return rendered("\n\n".join([first, *equations]))


def shown(cell: NotebookNode) -> Iterator[str]:
    """The outputs of a cell of code. A live figure stays live."""
    for output in cell.outputs:
        data = output.get("data", {})
        if "text/html" in data:
            yield data["text/html"]
        elif "image/png" in data:
            size = output.metadata.get("image/png", {})
            width = f' width="{size["width"]}"' if "width" in size else ""
            picture = data["image/png"].replace("\n", "")
            yield f'<img src="data:image/png;base64,{picture}"{width} alt="figure">'
        elif output.output_type == "stream":
            columns = ' class="columns"' if has_columns(output.text) else ""
            text = output.text.rstrip().lstrip("\n")  # spaces before the first word align it
            yield f"<pre{columns}>{html.escape(text)}</pre>"


def _is_printed(output: str) -> bool:
    return output.startswith("<pre")


def page(title: str, chapters: list[NotebookNode]) -> str:
    """A lecture as one HTML page."""
    parts = []
    for book in chapters:
        for slide in slides(book):
            number, words = re.fullmatch(r"(\d\d[a-z]?\. )?(.*)", slide.heading).groups("")  # type: ignore[union-attr]
            words = re.sub(r"</?p>", "", rendered(words))
            heading = f"<h{slide.level}>{number}{words}</h{slide.level}>"
            points = "".join(f'<div class="point">{one}</div>' for one in slide.points)
            text = f'<div class="points">{points}</div>' if points else ""
            outputs = slide.figure + "".join(slide.printed)
            figure = f'<div class="shown">{outputs}</div>' if outputs else ""
            notes = f"<aside>{''.join(slide.notes)}</aside>" if slide.notes else ""
            beside = ' class="beside"' if "<img" in figure and text else ""
            parts.append(f"<section>{heading}<div{beside}>{text}{figure}</div>{notes}</section>")
    template = (Path(__file__).parent / "slides.html").read_text(encoding="utf-8")
    font = base64.b64encode(FONT.read_bytes()).decode("ascii")
    template = template.replace("TITLE", html.escape(title)).replace("FONT", font)
    return template.replace("SLIDES", "\n".join(parts))


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, numbers in LECTURES.items():
        paths = [next(NOTEBOOKS.glob(f"{number}_*.ipynb")) for number in numbers]
        books = [nbformat.read(path, as_version=4) for path in paths]
        title = name.partition("-")[2].replace("-", " ").capitalize()
        (folder / f"{name}.html").write_text(page(title, books), encoding="utf-8")
    print(f"{folder}: {len(LECTURES)} lectures; open one in a browser")


if __name__ == "__main__":
    main(Path(*sys.argv[1:2] or ["slides"]))
