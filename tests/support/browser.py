"""A real browser on a real JupyterLab, for tests of what a user sees.

`JupyterServer` is a server of its own: a random port, temporary folders for notebooks, settings and
workspaces. It uses none of the user's files. Like Notebook and Voila, it is started by the command
that the documentation shows. `LabNotebook` is one notebook open in it, in JupyterLab or Notebook;
`VoilaPage` is one that Voila shows. `SharedLab` is a page and a kernel that notebooks use one after
the other, because loading the page and starting a kernel take longer than most tests.
"""

from __future__ import annotations

import abc
import ast
import contextlib
import json
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import nbformat
from jupyter_client.blocking.client import BlockingKernelClient
from playwright.sync_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Locator,
    Page,
    ViewportSize,
    sync_playwright,
)
from playwright.sync_api import TimeoutError as NotInTime

from .documented import REPOSITORY, documented

WINDOW: ViewportSize = {"width": 1366, "height": 768}
ARTEFACTS = Path(os.environ.get("GLID_NB_ARTEFACTS", REPOSITORY / "artefacts"))

CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    "--no-first-run",
    "--disable-dev-shm-usage",
    # A page that asks for a font elsewhere is told at once that there is none.
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)

# As a user's browser draws, which shows other frames. With it the tests would take longer.
GPU_RASTER_FLAGS = tuple(flag for flag in CHROMIUM_FLAGS if not flag.startswith("--disable-gpu-"))

# Messages of pages that are not our fault. Every other message of the kind "error" fails a test.
_HARMLESS = (
    # On a slow machine anywidget gives a widget up; ours listen on: test_slow_page_browser.py.
    re.compile(r"\[anywidget\] Failed to initialize model"),
    # A server without jupyter-lsp, which JupyterLab asks for.
    re.compile(r"Failed to load resource.*404.*/lsp/status"),
    # JupyterLab draws a picture's address before it has resolved the attachment.
    re.compile(r"ERR_UNKNOWN_URL_SCHEME.*\(attachment:"),
    # JupyterLab asks for a workspace and settings that a fresh server does not have.
    re.compile(r"Failed to load resource.*404.*/(lab/api/|api/contents|favicon)"),
    # Notebook 7.6 asks its own settings for a plugin that it does not have.
    re.compile(r"reading 'schema'\).*/static/notebook/notebook_core", re.DOTALL),
    # On a slow machine it opens its path before its file browser is there, and refuses a font.
    re.compile(r"'filebrowser:open-path' not registered.*/static/notebook/", re.DOTALL),
    re.compile(r"Failed to load resource.*403.*/static/(notebook|lab)/\w+\.woff2"),
    # Voila fetches fonts and MathJax from elsewhere, and tries to load extensions of JupyterLab.
    re.compile(r"ERR_(NAME_NOT_RESOLVED|INTERNET_DISCONNECTED).*https://cdn"),
    re.compile(r"shared module is not a function.*@jupyterlab/.*/voila/", re.DOTALL),
)

_SETTINGS = {
    # No question about news, no look-up of newer versions.
    "apputils-extension/notification": {"fetchNews": "false", "checkForUpdates": False},
    # Cells outside the window stay in the page.
    "notebook-extension/tracker": {"windowingMode": "none", "autoStartDefaultKernel": True},
}

READY = """() => {
  const panel = window.jupyterapp?.shell?.currentWidget;
  return panel?.context?.isReady && panel.sessionContext?.isReady &&
    panel.sessionContext.session?.kernel?.status === 'idle';
}"""

# Closes what a notebook made in the kernel that it shares with the next one.
_CLEAR_KERNEL = """
import ipywidgets as _widgets
from glid_nb.widgets import CageTracer, DeformCanvas, Editor
for _one in list(_widgets.widget._instances.values()):
    if isinstance(_one, (Editor, DeformCanvas, CageTracer)):
        _one.close()
_widgets.Widget.close_all()
get_ipython().reset(new_session=True, aggressive=False)
"""

_EXECUTE = """async ({id, code}) => {
  const model = {id, name: 'python3'};
  const kernel = window.jupyterapp.serviceManager.kernels.connectTo({model});
  const reply = (await kernel.requestExecute({code, silent: true, store_history: false}).done);
  kernel.dispose();
  return reply.content.status === 'ok' ? null : `${reply.content.ename}: ${reply.content.evalue}`;
}"""

_START_SESSION = """({path, id}) => window.jupyterapp.serviceManager.sessions.startNew(
  {path, name: path, type: 'notebook', kernel: {id}}).then((session) => session.dispose())"""

_OPEN = """(path) => window.jupyterapp.commands.execute('docmanager:open', {path})
  .then(() => null)"""

_EVALUATE = """async ({setup, expression}) => {
  const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
  const future = kernel.requestExecute({
    code: setup, silent: true, store_history: false,
    user_expressions: {value: `__import__('json').dumps(${expression})`},
  });
  const reply = (await future.done).content;
  if (reply.status !== 'ok') return {error: `${reply.ename}: ${reply.evalue}`};
  const value = reply.user_expressions.value;
  if (value.status !== 'ok') return {error: `${value.ename}: ${value.evalue}`};
  return {text: value.data['text/plain']};
}"""

_RUN_ONE = """(index) => {
  window.jupyterapp.shell.currentWidget.content.activeCellIndex = index;
  return window.jupyterapp.commands.execute('notebook:run-cell');
}"""

_SCROLL = """async (part) => {
  const place = () => JSON.stringify(part.getBoundingClientRect());
  for (let before = ''; before !== place(); ) {
    before = place();
    await new Promise(requestAnimationFrame);
  }
  part.scrollIntoViewIfNeeded();
  return part.isConnected;
}"""

_RUN_ALL = "() => window.jupyterapp.commands.execute('notebook:run-all-cells')"


def chromium() -> str:
    """The browser: ``$GLID_NB_CHROMIUM``, or Chromium (or Chrome) on the PATH."""
    named = os.environ.get("GLID_NB_CHROMIUM")
    names = [named] if named else ["chromium", "chromium-browser", "google-chrome"]
    for name in names:
        found = shutil.which(name)
        if found:
            return found
    raise RuntimeError(
        f"no browser found as {', '.join(names)}; run tools/chromium.sh, or name one in "
        "$GLID_NB_CHROMIUM"
    )


@contextlib.contextmanager
def launched_chromium() -> Iterator[Browser]:
    """The running browser."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium(), headless=True, args=list(CHROMIUM_FLAGS)
        )
        yield browser
        browser.close()


def bring_into_view(part: Locator) -> None:
    """Scroll a part of a page into view when it stands still, even if the page makes it anew.

    Playwright's ``scroll_into_view_if_needed`` fails if that happens meanwhile.
    """
    while not part.evaluate(_SCROLL):
        pass


def wait_until(page: Page, holds: Callable[[], bool], what: str, seconds: float = 30.0) -> None:
    """Wait until something holds of which the page has no event, such as a picture's pixels."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"not in {seconds:g} s: {what}"
        page.wait_for_timeout(50)


def still_sliders(figure: Locator) -> list[str]:
    """Move each slider and check box of a figure by the keyboard. One sentence for each that leaves
    the picture unchanged."""
    inputs, picture = figure.locator("input"), figure.locator("img")
    try:
        inputs.first.wait_for(timeout=5_000)
    except NotInTime:
        return ["a figure has no slider"]
    found = []
    for one in inputs.all():
        at_first = one.evaluate("(slider) => slider.value === slider.min")
        key = "End" if at_first else "Home"
        before = picture.screenshot()
        one.press("Space" if one.get_attribute("type") == "checkbox" else key)
        picture.evaluate("(picture) => picture.decode()")  # an error if it cannot be shown
        if picture.screenshot() == before:
            found.append(f"the slider {one.get_attribute('aria-label')} does not move the picture")
    return found


class Host:
    """A server that a documented command starts, on a free port of this machine, without a token.

    Parameters
    ----------
    words
        The command, as the page has it; everything else is said by files of settings.
    folder
        Where it is run.
    own
        A folder for settings, workspaces and what the server runs; nothing of the user's is used.
    """

    def __init__(self, words: Sequence[str], folder: Path, own: Path) -> None:
        self.runtime = own / "runtime"
        port = _free_port()
        _write_settings(own, port, self.runtime)
        environment = {
            **os.environ,
            "JUPYTER_CONFIG_DIR": str(own / "config"),
            "JUPYTER_DATA_DIR": str(own / "data"),
            "JUPYTER_RUNTIME_DIR": str(self.runtime),
            "JUPYTERLAB_SETTINGS_DIR": str(own / "settings"),
            "JUPYTERLAB_WORKSPACES_DIR": str(own / "workspaces"),
            "IPYTHONDIR": str(own / "ipython"),
            "PYTHONPATH": _import_path(),
        }
        self.url = f"http://127.0.0.1:{port}"
        self._log: list[str] = []
        self._process = subprocess.Popen(
            words,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        self._wait_until_it_serves(words)
        # The pipe must be emptied as long as the server writes into it.
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _wait_until_it_serves(self, words: Sequence[str]) -> None:
        assert self._process.stderr is not None
        for line in self._process.stderr:
            self._log.append(line)
            if self.url in line:
                return self._wait_until_it_listens()
        raise RuntimeError(f"{shlex.join(words)} did not start:\n" + "".join(self._log))

    def _wait_until_it_listens(self) -> None:
        """Some servers name their address before they listen there."""
        if not _listens(self.url):
            raise RuntimeError(f"nothing listens at {self.url}")

    def _read(self) -> None:
        assert self._process.stderr is not None
        self._log.extend(self._process.stderr)

    @property
    def log(self) -> str:
        """What the server has written so far."""
        return "".join(self._log)

    @property
    def start_page(self) -> str:
        """The page that the server names when it has started."""
        (page, *_) = re.findall(rf"{self.url}/\S*", self.log)
        return page

    def page_of(self, notebook: str) -> str:
        """The page on which JupyterLab or Notebook shows a notebook that the command names."""
        notebook_7 = self.start_page.rstrip("/").endswith("/tree")
        return f"{self.url}/{'notebooks' if notebook_7 else 'lab/tree'}/{notebook}"

    def close(self) -> None:
        """End the server, its kernels and what has started it."""
        os.killpg(self._process.pid, signal.SIGTERM)
        try:
            self._process.wait(30)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._reader.join()
        assert self._process.stderr is not None
        self._process.stderr.close()


@contextlib.contextmanager
def marimo_server(notebook: Path, log: Path) -> Iterator[str]:
    """The address at which marimo serves a notebook of its own kind."""
    url = f"http://127.0.0.1:{_free_port()}"
    _, host, port = url.split(":")
    words = [sys.executable, "-m", "marimo", "run", str(notebook), "--headless", "--no-token"]
    words += ["--host", host.strip("/"), "--port", port]
    environment = {**os.environ, "PYTHONPATH": _import_path()}
    with (
        log.open("wb") as out,
        subprocess.Popen(
            words,
            env=environment,
            cwd=notebook.parent,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=out,
            start_new_session=True,
        ) as process,
    ):
        try:
            if not _listens(url):
                raise RuntimeError(f"{shlex.join(words)} did not start:\n{log.read_text()}")
            yield url
        finally:
            os.killpg(process.pid, signal.SIGTERM)


def _import_path() -> str:
    """The path with which a server's kernels import the package that is being tested."""
    return os.pathsep.join([str(REPOSITORY), *filter(None, [os.environ.get("PYTHONPATH")])])


def _listens(url: str) -> bool:
    """Wait until a server listens at an address."""
    host, port = url.split("/")[2].split(":")
    for _ in range(600):
        with socket.socket() as tried:
            if tried.connect_ex((host, int(port))) == 0:
                return True
        time.sleep(0.1)
    return False


def _free_port() -> int:
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        return bound.getsockname()[1]


def _write_settings(own: Path, port: int, runtime: Path) -> None:
    """Files with settings that would be flags of the command."""
    network = {"ip": "127.0.0.1", "port": port, "open_browser": False}
    server = {
        "ServerApp": {**network, "allow_root": True, "password": "", "terminals_enabled": False},
        "IdentityProvider": {"token": ""},
    }
    app = {"expose_app_in_browser": True}
    never = "jupyterlab.NeverCheckForUpdate"
    lab = {**app, "extension_manager": "readonly", "check_for_updates_class": never}
    voila = {**network, "connection_dir_root": str(runtime)}
    files = {
        "config/jupyter_server_config.json": server,
        "config/jupyter_lab_config.json": {**server, "LabApp": lab},
        "config/jupyter_notebook_config.json": {**server, "JupyterNotebookApp": app},
        "config/voila.json": {"Voila": voila},
    }
    for name, values in _SETTINGS.items():
        files[f"settings/@jupyterlab/{name}.jupyterlab-settings"] = values
    for name, values in files.items():
        (own / name).parent.mkdir(parents=True, exist_ok=True)
        (own / name).write_text(json.dumps(values))
    runtime.mkdir(exist_ok=True)


class JupyterServer(Host):
    """JupyterLab, started as the course's page says, and what else shows its notebooks.

    Parameters
    ----------
    folder
        Empty; notebooks go to ``folder/notebooks``, everything else beside it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.notebooks = folder, folder / "notebooks"
        self.notebooks.mkdir(parents=True)
        super().__init__(documented("jupyter", "lab", "notebooks"), folder, folder / "lab")

    def beside(self, name: str, *start: str) -> Host:
        """A server for one of the notebooks, by the documented command that begins like this."""
        words = documented(*start)
        words[-1] = f"notebooks/{name}.ipynb"
        return Host(words, self.folder, self.folder / name)


class Watch:
    """Collects what goes wrong in the pages of a browser context."""

    def __init__(self, context: BrowserContext) -> None:
        self.errors: list[str] = []
        context.on("console", self._console)
        context.on("weberror", lambda e: self._note(f"uncaught: {e.error.stack or e.error}"))

    def _console(self, message: ConsoleMessage) -> None:
        if message.type != "error":
            return
        self._note(f"{message.text} ({message.location.get('url', '')})")

    def _note(self, text: str) -> None:
        if not any(pattern.search(text) for pattern in _HARMLESS):
            self.errors.append(text)

    def check(self) -> None:
        """Fail if there were errors."""
        assert not self.errors, "errors in the browser's console:\n" + "\n".join(self.errors)


@contextlib.contextmanager
def watched_page(browser: Browser, script: str = "", **settings: Any) -> Iterator[Page]:
    """A page in a context of its own; an error in its console fails the test at the end.

    ``script`` runs in the page before anything else does; ``settings`` are those of Playwright's
    browser context, such as ``has_touch=True``.
    """
    context = browser.new_context(**{"viewport": WINDOW, **settings})
    if script:
        context.add_init_script(script)
    watch = Watch(context)
    page = context.new_page()
    page.set_default_timeout(30_000)
    try:
        yield page
        watch.check()
    finally:
        context.close()


class NotebookPage(abc.ABC):
    """A notebook that a page shows and a kernel has run.

    Attributes
    ----------
    page
        Playwright's page, for everything a hand and an eye can do.
    """

    def __init__(self, page: Page, server: JupyterServer, cells: Sequence[str]) -> None:
        self.page = page
        self._name = f"test-{uuid.uuid4().hex[:10]}"
        book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(c) for c in cells])
        book.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
        nbformat.write(book, server.notebooks / f"{self._name}.ipynb")

    @abc.abstractmethod
    def value(self, expression: str, setup: str = "") -> Any:
        """The value of a Python expression in the kernel, through JSON."""

    @abc.abstractmethod
    def shut_down(self) -> None:
        """End the kernel."""

    def wait_for(self, condition: str, timeout: float = 30.0, told: str = "''") -> None:
        """Wait until a Python expression in the kernel is true.

        If it does not become true, the error has what the expression ``told`` says then.
        """
        end = time.monotonic() + timeout
        while not self.value(f"bool({condition})"):
            if time.monotonic() > end:
                what = f"the kernel did not reach {condition!r} in {timeout:g} s"
                raise AssertionError(f"{what}. {self.value(f'str({told})')}")
            self.page.wait_for_timeout(50)  # lets the page work; the kernel has no event for us

    def screenshot(self, name: str, of: Locator | None = None) -> Path:
        """Save what is seen, of the whole window or of one element, to look at later."""
        ARTEFACTS.mkdir(exist_ok=True)
        path = ARTEFACTS / f"{name}.png"
        (of if of is not None else self.page).screenshot(path=path)
        return path


class LabNotebook(NotebookPage):
    """One notebook, open in JupyterLab or in Notebook (``interface``), its cells run.

    With ``lab``, in the kernel of that page, which `SharedLab.clear` empties; else in its own one.
    """

    def __init__(
        self,
        page: Page,
        server: JupyterServer,
        cells: Sequence[str],
        interface: Literal["lab", "notebook"] = "lab",
        lab: SharedLab | None = None,
    ) -> None:
        super().__init__(page, server, cells)
        self._own: Host | None = None
        if interface == "lab":
            self._url = f"{server.url}/lab/workspaces/{self._name}/tree/{self._name}.ipynb"
        else:
            self._own = server.beside(self._name, "jupyter", "notebook")
            self._url = f"{self._own.url}/notebooks/{self._name}.ipynb"
        if lab is not None:
            lab.start_session(f"{self._name}.ipynb")
        if lab is not None and lab.page is page:
            page.evaluate(_OPEN, f"{self._name}.ipynb")
        else:
            page.goto(self._url)
        self._wait_until_ready()
        # The notebook gets the whole window, as users often arrange it.
        page.evaluate(
            """() => { const app = window.jupyterapp;
              if (app.shell.leftCollapsed === false) app.shell.collapseLeft(); }"""
        )
        self.run_all()

    def _wait_until_ready(self) -> None:
        self.page.wait_for_function(READY, timeout=90_000, polling=200)

    def run_all(self, timeout: float = 120.0) -> None:
        """Run all cells and wait for the last one; an exception in one fails the test."""
        self._run(_RUN_ALL, timeout)

    def run_cell(self, index: int, timeout: float = 120.0) -> None:
        """Run one cell and wait for it; an exception in any cell fails the test."""
        self._run(_RUN_ONE, timeout, index)

    def _run(self, script: str, timeout: float, argument: Any = None) -> None:
        self.page.set_default_timeout(timeout * 1000)
        self.page.evaluate(script, argument)
        self.page.set_default_timeout(30_000)
        outputs = self.page.evaluate(
            """() => window.jupyterapp.shell.currentWidget.content.model.toJSON().cells
              .flatMap(c => c.outputs || []).filter(o => o.output_type === 'error')
              .map(o => `${o.ename}: ${o.evalue}`)"""
        )
        assert not outputs, f"a cell raised {outputs}"

    def reload(self) -> None:
        """Save the notebook and load the page again. The kernel continues."""
        self.page.evaluate("() => window.jupyterapp.commands.execute('docmanager:save')")
        self.page.goto(self._url)
        self._wait_until_ready()

    def outputs(self) -> Locator:
        """The output areas of all cells, in order."""
        return self.page.locator(".jp-OutputArea-child .jp-OutputArea-output")

    def value(self, expression: str, setup: str = "") -> Any:
        reply = self.page.evaluate(_EVALUATE, {"setup": setup, "expression": expression})
        if "error" in reply:
            raise AssertionError(f"the kernel says of {expression!r}: {reply['error']}")
        return json.loads(ast.literal_eval(reply["text"]))

    @contextlib.contextmanager
    def running(self, code: str) -> Iterator[None]:
        """Let the kernel run code during the block, which has to make it end."""
        self.page.evaluate(
            """(code) => {
              const kernel = jupyterapp.shell.currentWidget.sessionContext.session.kernel;
              window.running = kernel.requestExecute({code}).done;
            }""",
            code,
        )
        self.page.wait_for_function(
            "() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.status === 'busy'"
        )
        yield
        self.page.evaluate("() => window.running")

    def theme(self, name: str) -> None:
        """Change JupyterLab's theme, for example to "JupyterLab Dark"."""
        self.page.evaluate(
            "theme => window.jupyterapp.commands.execute('apputils:change-theme', {theme})", name
        )
        self.page.wait_for_function(
            "name => document.body.dataset.jpThemeName === name"
            " && !document.getElementById('jupyterlab-splash')",
            arg=name,
            timeout=10_000,
        )

    def shut_down(self) -> None:
        self.page.evaluate(
            "() => window.jupyterapp.shell.currentWidget?.sessionContext?.shutdown()"
        )
        if self._own is not None:
            self._own.close()


class SharedLab:
    """A page of JupyterLab and one kernel, for notebooks that follow one another."""

    def __init__(self, browser: Browser, server: JupyterServer) -> None:
        self._context = browser.new_context(viewport=WINDOW)
        self._watch = Watch(self._context)
        self.page = self._context.new_page()
        self.page.set_default_timeout(30_000)
        self.page.goto(f"{server.url}/lab")
        self.page.wait_for_function(
            "() => window.jupyterapp?.restored.then(() => true)", timeout=90_000
        )
        self._kernel = self.page.evaluate(
            """() => window.jupyterapp.serviceManager.kernels.startNew({name: 'python3'})
              .then((kernel) => { kernel.dispose(); return kernel.id; })"""
        )

    def start_session(self, path: str) -> None:
        """Tie a notebook that is not open yet to the kernel."""
        self._watch.errors.clear()
        self.page.evaluate(_START_SESSION, {"path": path, "id": self._kernel})

    def clear(self) -> None:
        """Close the notebook on the page and everything that was made in the kernel.

        What the page says of widgets that are closed behind its back is not kept.
        """
        raised = self.page.evaluate(_EXECUTE, {"id": self._kernel, "code": _CLEAR_KERNEL})
        assert raised is None, f"closing what the notebook had made raised {raised}"
        self.page.evaluate("() => window.jupyterapp.shell.currentWidget?.dispose()")
        self.page.set_viewport_size(WINDOW)
        self._watch.errors.clear()

    def check(self) -> None:
        """Fail if there were errors in the console since the last check."""
        try:
            self._watch.check()
        finally:
            self._watch.errors.clear()

    def close(self) -> None:
        """Leave the page. The kernel ends with the server."""
        self._context.close()


class VoilaPage(NotebookPage):
    """One notebook, run and shown by Voila; the kernel is asked beside the page."""

    def __init__(self, page: Page, server: JupyterServer, cells: Sequence[str]) -> None:
        super().__init__(page, server, cells)
        # Comes when all cells have run, on a busy machine with nothing compiled too; the test's own
        # time limit ends it.
        self._host = server.beside(self._name, "voila")
        page.goto(self._host.start_page, timeout=0)
        kernel = page.evaluate(
            "JSON.parse(document.getElementById('jupyter-config-data').textContent).kernelId"
        )
        (connection,) = self._host.runtime.rglob(f"kernel-{kernel}.json")
        self._client = BlockingKernelClient(connection_file=str(connection))
        self._client.load_connection_file()
        self._client.start_channels()

    def value(self, expression: str, setup: str = "") -> Any:
        asked = {"value": f"__import__('json').dumps({expression})"}
        reply = self._client.execute_interactive(
            setup, silent=True, user_expressions=asked, timeout=60
        )["content"]
        value = reply if reply["status"] != "ok" else reply["user_expressions"]["value"]
        if value["status"] != "ok":
            raise AssertionError(
                f"the kernel says of {expression!r}: {value['ename']}: {value['evalue']}"
            )
        return json.loads(ast.literal_eval(value["data"]["text/plain"]))

    def shut_down(self) -> None:
        self._client.shutdown()
        self._client.stop_channels()
        self._host.close()
