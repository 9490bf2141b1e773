"""Every command on a page is run as printed, in a copy of the checkout.

Commands that install from the network are not run; the packages that they name must exist. `KINDS`
says how each kind of command is tried. A command of no kind fails.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import textwrap
import tomllib
import venv
from collections.abc import Callable, Iterator
from importlib.metadata import metadata, version
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement
from PIL import Image
from playwright.sync_api import Page

import glid_nb as glid

from ..support.browser import READY, Host, launched_chromium, watched_page
from ..support.documented import PAGES, REPOSITORY, Command, checkout, commands, here, spoken

pytestmark = pytest.mark.slow

SHOWN = [command for path in PAGES for command in commands(path)]
# What several pages show is tried once.
COMMANDS = list({tuple(command.words): command for command in reversed(SHOWN)}.values())[::-1]
# Whether all Markdown pictures of a page are loaded; None without pictures.
PICTURES = """() => {
  const text = '.jp-RenderedMarkdown img, .jp-RenderedHTMLCommon img';
  const all = [...document.querySelectorAll(text)];
  return all.length ? all.every((one) => one.complete && one.naturalWidth > 0) : null;
}"""


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return checkout(tmp_path_factory.mktemp("checkout"))


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A user's folder with pictures, a pose, problems, maps, sessions and a motion."""
    folder = tmp_path_factory.mktemp("work")
    image, pose = glid.samples.image("bar"), glid.samples.pose_path("bar", "gentle")
    domain = glid.Domain.from_cage(glid.trace(image).cage)
    result = glid.solve(domain, glid.io.load_pose(pose))
    identity = glid.HarmonicMap.identity(domain)
    for name in ("my-character.png", "gecko.png"):
        Image.fromarray(image).save(folder / name)
    shutil.copy(pose, folder / "pose.json")
    cage = {"cage": domain.cage.exterior.tolist(), "holes": []}
    (folder / "problems").mkdir()
    (folder / "maps").mkdir()
    for name in ("problem.json", "problems/first.json", "problems/second.json"):
        (folder / name).write_text(json.dumps({**cage, **json.loads(pose.read_text())}))
    for name in ("map.json", "maps/first.json", "maps/second.json"):
        result.map.save(folder / name)
    right = np.arange(image.shape[1]) >= image.shape[1] / 2
    labels = np.where(image[..., 3] > 127, np.where(right, 200, 100), 0)
    Image.fromarray(labels.astype(np.uint8)).save(folder / "labels.png")
    np.save(folder / "values.npy", labels / 7)
    x = np.mgrid[:20, :30][1]
    field = np.stack([np.sin(x / 3), 0.1 * x], axis=-1)
    for name in ("field.npy", "good.npy"):
        np.save(folder / name, field)
    mesh = "v 0 0\nv 1 0\nv 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    for name in ("mesh.obj", "image.obj", "rest.obj"):
        (folder / name).write_text(mesh.replace("v 0 1", "v 0 2") if name == "image.obj" else mesh)
    result.certificate.save(folder / "proof.json")
    glid.Motion([identity, result.map]).save(folder / "motion.json")
    how = glid.energies.SymmetricDirichlet(), glid.Options()
    bent = glid.io.NamedPose("bent", result.pose, *how, result.map)
    rest = glid.io.NamedPose("rest", result.pose.with_targets(result.pose.handles), *how, identity)
    session = domain.cage, domain, glid.TraceOptions(), None, (rest, bent), 0
    for name in ("my-character.glid", "gecko.glid", "session.glid"):
        glid.io.save_document(glid.io.Document(image, *session), folder / name)
    y, x = np.mgrid[:700, :700]
    light = np.where(np.hypot(x - 350, y - 350) < 300, 220, 40).astype(np.uint8)
    Image.fromarray(light).convert("RGB").save(folder / "photograph.jpg")
    strokes = {"foreground": [[[300, 300], [400, 400]]], "background": [[[20, 20], [20, 680]]]}
    (folder / "strokes.json").write_text(json.dumps(strokes))
    return folder


@pytest.fixture
def folder(work: Path, tmp_path: Path) -> Path:
    """A copy of `work` without files of other commands, which a glob would find."""
    return shutil.copytree(work, tmp_path / "work")


def requirement(name: str, clone: Path) -> Requirement:
    """The arguments of pip: a package, or the path of a project, ``.`` or ``./checker``."""
    path, *extras = re.split(r"(?=\[)", name, maxsplit=1)
    if path.startswith("."):
        about = tomllib.loads((clone / path / "pyproject.toml").read_text(encoding="utf-8"))
        return Requirement("".join([about["project"]["name"], *extras]))
    return Requirement(name)


def is_there(command: Command, clone: Path) -> None:
    """The named packages exist: this package's extras, and packages that tests have."""
    words = command.words
    named = [word for word in words[words.index("install") + 1 :] if not word.startswith("-")]
    assert named
    for name in named:
        wanted = requirement(name, clone)
        assert wanted.extras <= set(metadata(wanted.name).get_all("Provides-Extra") or ())
        assert wanted.specifier.contains(version(wanted.name))


def has_target(command: Command, clone: Path) -> None:
    subprocess.run([*command.words, "--dry-run"], cwd=clone, check=True, capture_output=True)


def in_shell(text: str, folder: Path) -> str:
    """The output of a line, run by a shell in which this environment is active."""
    program, space, rest = text.partition(" ")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    line = "".join([Path(program).name, space, rest])
    how = {"cwd": folder, "env": {**os.environ, "PATH": path}}
    done = subprocess.run(line, shell=True, capture_output=True, text=True, **how)
    assert done.returncode == 0, done.stderr
    return done.stdout


def runs(command: Command, folder: Path) -> None:
    text, *filters = command.text.split(" | ")
    printed = in_shell(text, folder)
    words = shlex.split(text, comments=True)
    for flag in ("--out", "--report", "--proof", "--figure"):
        if flag in words:
            is_written(words[words.index(flag) + 1], printed, folder)
    for one in filters:
        jq, key = shlex.split(one)  # jq may be missing
        assert jq == "jq"
        assert json.loads(printed)[key.removeprefix(".")]


def is_written(out: str, printed: str, folder: Path) -> None:
    if out == "-":
        assert json.loads(printed)
    else:
        assert (folder / out).exists()
        assert not out.endswith("/") or any((folder / out).iterdir())


def names_a_command(command: Command, folder: Path) -> None:
    """A sentence may name a command that needs arguments without them."""
    assert command.in_sentence, f"{command}: the arguments are missing"
    assert "usage:" in in_shell(f"{command.text} --help", folder)


def makes_environment(command: Command, folder: Path) -> None:
    runs(command, folder)
    assert (folder / command.words[-1] / "pyvenv.cfg").is_file()


def collects(command: Command, clone: Path) -> None:
    """The tests are found; this is one of them."""
    assert command.words[1:] == ["-m", "pytest"]
    more = ["--collect-only", "-q", "tests/geometry"]
    line = [*here(command.words), *more]
    subprocess.run(line, cwd=clone, check=True, capture_output=True)


def is_served(command: Command, clone: Path) -> None:
    """The served page opens in a browser, with all pictures and, after it is run, the editor."""
    words = command.words
    own = clone.parent / f"{clone.name}-{abs(hash(tuple(words))):x}"
    host = Host(here(words), clone, own)
    try:
        with launched_chromium() as browser, watched_page(browser) as page:
            page.set_default_timeout(120_000)
            if Path(words[0]).name == "voila":
                page.goto(host.start_page, timeout=0)
            else:
                page.goto(host.page_of(notebook_of(words)))
                run_all(page)
            page.locator(".glid-editor .glid-pad").first.wait_for(state="attached")
            page.wait_for_function(f"({PICTURES})() === true")
            assert not page.get_by_text("Traceback (most recent call last)").count()
    finally:
        host.close()


def notebook_of(words: list[str]) -> str:
    """The editor's notebook, opened by the command or lying in the served folder."""
    if words[-1].endswith(".ipynb"):
        return Path(words[-1]).name  # the server's root is the folder of a named notebook
    return "editor.ipynb" if spoken(words) == ["glid-nb", "lab"] else "02_editor.ipynb"


def run_all(page: Page) -> None:
    page.wait_for_function(READY)
    page.evaluate("() => void window.jupyterapp.commands.execute('notebook:run-all-cells')")


KINDS: dict[str, tuple[Callable[[Command, Path], None], str]] = {
    r"(\S*pip|\S*python -m pip) install .*": (is_there, "clone"),
    r"make \w+": (has_target, "clone"),
    r"python3 -m venv \S+": (makes_environment, "folder"),
    r"python -m pytest": (collects, "clone"),
    r"(voila|jupyter lab|jupyter notebook) \S+|glid-nb lab": (is_served, "clone"),
    r"python docs/\S+\.py": (runs, "clone"),
    r"glid-nb (samples|doctor|demo)( .*)?": (runs, "folder"),
    r"glid-nb (trace|solve|render|animate|page|audit) .*": (runs, "folder"),
    r"glid-nb (trace|solve|render|animate|page|audit)": (names_a_command, "folder"),
    r"(glid-check|python -c).*": (runs, "folder"),
}


def kind(command: Command) -> tuple[Callable[[Command, Path], None], str]:
    text = shlex.join(spoken(command.words))
    found = [how for pattern, how in KINDS.items() if re.fullmatch(pattern, text)]
    assert len(found) == 1, f"{command}: no test knows how to try it; add it to KINDS"
    return found[0]


def test_a_command_that_no_test_knows_is_a_fault() -> None:
    with pytest.raises(AssertionError, match="no test knows how to try it"):
        kind(Command("docs/howto/hosts.md", "docker run glid-nb"))


def test_the_pages_show_every_host_that_they_promise() -> None:
    shown = {" ".join(spoken(command.words)[:2]) for command in COMMANDS}
    assert {"jupyter lab", "jupyter notebook", "glid-nb lab", "glid-nb animate"} <= shown
    assert "voila notebooks/02_editor.ipynb" in shown


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(c, marks=pytest.mark.browser if kind(c)[0] is is_served else ())
        for c in COMMANDS
    ],
    ids=str,
)
def test_a_documented_command_works(command: Command, request: pytest.FixtureRequest) -> None:
    how, where = kind(command)
    how(command, request.getfixturevalue(where))


def test_the_cell_for_colab_runs() -> None:
    """In IPython, with substitutes for the installation and for Colab's own module."""
    page = (REPOSITORY / "docs" / "howto" / "hosts.md").read_text(encoding="utf-8")
    (cell,) = re.findall(r"^```python\n(%pip.*?)^```", page, re.DOTALL | re.MULTILINE)
    code = textwrap.dedent(f"""
        import sys
        from types import SimpleNamespace
        from IPython.core.interactiveshell import InteractiveShell
        done = []
        output = SimpleNamespace(enable_custom_widget_manager=lambda: done.append("widgets"))
        sys.modules["google.colab"] = SimpleNamespace(output=output)
        shell = InteractiveShell()
        shell.register_magic_function(done.append, magic_name="pip")
        shell.run_cell({cell!r}).raise_error()
        print(*done, sep="\\n")
    """)
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    install, widgets = ran.stdout.splitlines()
    is_there(Command("docs/howto/hosts.md", f"pip {install}"), REPOSITORY)
    assert widgets == "widgets"


@pytest.fixture
def binder(clone: Path, tmp_path: Path) -> Iterator[Host]:
    """The server as on Binder, in an environment that postBuild has filled."""
    venv.create(tmp_path / "env")
    python = tmp_path / "env" / "bin" / "python"
    (site,) = (tmp_path / "env").glob("lib/python*/site-packages")
    (site / "tests.pth").write_text(os.pathsep.join(p for p in sys.path if "site-packages" in p))
    (site / "pip.py").write_text("")  # the packages that it would install are here
    environment = {**os.environ, "PATH": f"{python.parent}{os.pathsep}{os.environ['PATH']}"}
    script = ["bash", "binder/postBuild"]
    subprocess.run(script, cwd=clone, env=environment, check=True, capture_output=True)
    host = Host([str(python), "-m", "jupyterlab"], clone, tmp_path / "own")
    yield host
    host.close()


@pytest.mark.browser
def test_binder_opens_the_editor(binder: Host) -> None:
    assert binder.start_page.endswith("/lab/tree/notebooks/02_editor.ipynb")
    with launched_chromium() as browser, watched_page(browser) as page:
        page.set_default_timeout(120_000)
        page.goto(binder.start_page)
        page.wait_for_function(READY)
        page.wait_for_function(f"({PICTURES})() === true")
