"""Firefox, for tests of pages in a second engine.

Playwright cannot drive Debian's Firefox. `Firefox` speaks WebDriver BiDi, a standard of the W3C:
JSON over a web socket that Firefox opens by itself. Firefox has WebGL only on a display, so it runs
on one of Xvfb, which draws into memory.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import websocket

SCREEN = "1600x1200x24"
SECONDS = 30.0

_PREFERENCES = {
    "app.normandy.enabled": False,
    "app.update.auto": False,
    "browser.aboutwelcome.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.page": 0,
    "datareporting.policy.dataSubmissionEnabled": False,
    "dom.w3c_touch_events.enabled": 1,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "toolkit.telemetry.reportingpolicy.firstRun": False,
    "webgl.force-enabled": True,
}

_OWN_KEYS = {"Control": "\ue009", "Shift": "\ue008", "Delete": "\ue017", "Enter": "\ue007"}


def firefox() -> str:
    """The browser: ``$GLID_NB_FIREFOX``, or Firefox on the PATH."""
    named = os.environ.get("GLID_NB_FIREFOX")
    return _program([named] if named else ["firefox-esr", "firefox"])


def _program(names: Sequence[str]) -> str:
    for name in names:
        if found := shutil.which(name):
            return found
    raise RuntimeError(f"no program found as {', '.join(names)}; run tools/firefox.sh")


class Firefox:
    """One window of a running Firefox.

    ``errors`` holds the messages of kind "error" in the page's console, ``requests`` the addresses
    that it asked for. Both begin anew with `open`.
    """

    def __init__(self, address: str) -> None:
        self._socket = websocket.create_connection(
            f"{address}/session", timeout=SECONDS, suppress_origin=True
        )
        self._count = 0
        self.errors: list[str] = []
        self.requests: list[str] = []
        session = self._ask("session.new", capabilities={})
        self.version: str = session["capabilities"]["browserVersion"]
        self._ask("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])
        tree = self._ask("browsingContext.getTree")
        self._context: str = tree["contexts"][0]["context"]

    def _ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._count += 1
        message = {"id": self._count, "method": method, "params": parameters}
        self._socket.send(json.dumps(message))
        while True:
            answer = json.loads(self._socket.recv())
            if answer.get("id") == self._count:
                break
            self._hear(answer)
        if answer["type"] == "error":
            raise RuntimeError(f"{method}: {answer['error']}: {answer['message']}")
        return answer["result"]

    def _hear(self, event: dict[str, Any]) -> None:
        told = event.get("params", {})
        if event.get("method") == "network.beforeRequestSent":
            self.requests.append(told["request"]["url"])
        elif told.get("level") == "error":
            self.errors.append(told["text"])

    def open(self, url: str, width: int, height: int, downloads: Path | None = None) -> None:
        """Open a page in a window of this size. Files are saved into ``downloads``."""
        self._ask(
            "browsingContext.setViewport",
            context=self._context,
            viewport={"width": width, "height": height},
        )
        if downloads is not None:
            behavior = {"type": "allowed", "destinationFolder": str(downloads)}
            self._ask("browser.setDownloadBehavior", downloadBehavior=behavior)
        self.errors, self.requests = [], []
        self._ask("browsingContext.navigate", context=self._context, url=url, wait="complete")

    def value(self, expression: str) -> Any:
        """The value of an expression in the page; a promise is awaited."""
        answer = self._ask(
            "script.evaluate",
            expression=f"(async () => JSON.stringify(await ({expression})) ?? 'null')()",
            target={"context": self._context},
            awaitPromise=True,
        )
        if answer["type"] == "exception":
            raise RuntimeError(answer["exceptionDetails"]["text"])
        return json.loads(answer["result"]["value"])

    def wait_for(self, condition: str, seconds: float = SECONDS) -> None:
        """Wait until an expression in the page is true."""
        end = time.monotonic() + seconds
        while not self.value(condition):
            assert time.monotonic() < end, f"not in time: {condition}; {self.errors}"
            time.sleep(0.02)

    def drag(self, path: Sequence[tuple[float, float]], kind: str = "mouse") -> None:
        """Press at the first place, move through the others, release. One place is a click."""
        moves = [{"type": "pointerMove", "x": round(x), "y": round(y)} for x, y in path]
        pauses = [{**move, "duration": 16} for move in moves[1:]]
        press = [{"type": "pointerDown", "button": 0}]
        release = [{"type": "pointerUp", "button": 0}]
        self._act("pointer", [moves[0], *press, *pauses, *release], pointerType=kind)

    def press(self, *keys: str) -> None:
        """Press keys together, such as ``"Control", "z"``."""
        codes = [_OWN_KEYS.get(key, key) for key in keys]
        down = [{"type": "keyDown", "value": code} for code in codes]
        self._act("key", [*down, *({"type": "keyUp", "value": code} for code in codes[::-1])])

    def _act(self, kind: str, actions: list[dict[str, Any]], **parameters: str) -> None:
        source: dict[str, Any] = {"type": kind, "id": "-".join((kind, *parameters.values()))}
        if parameters:
            source["parameters"] = parameters
        self._ask(
            "input.performActions",
            context=self._context,
            actions=[{**source, "actions": actions}],
        )

    def click(self, selector: str) -> None:
        """Click the middle of the first element of a selector."""
        box = self.value(f"document.querySelector({json.dumps(selector)}).getBoundingClientRect()")
        self.drag([(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)])

    def screenshot(self, path: Path) -> None:
        """Save a picture of the window."""
        data = self._ask("browsingContext.captureScreenshot", context=self._context)["data"]
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(base64.b64decode(data))

    def close(self) -> None:
        """End the browser."""
        self._ask("browser.close")
        self._socket.close()


@contextlib.contextmanager
def launched_firefox() -> Iterator[Firefox]:
    """Firefox with a profile and a display of its own. Raises a RuntimeError if it is missing."""
    command = [firefox(), "--no-remote", "--remote-debugging-port", "0", "--profile"]
    with tempfile.TemporaryDirectory() as folder, _display() as display:
        lines = (f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in _PREFERENCES.items())
        Path(folder, "user.js").write_text("\n".join(lines), encoding="utf-8")
        environment = {**os.environ, "DISPLAY": display, "MOZ_ENABLE_WAYLAND": "0"}
        log = Path(folder, "log.txt")
        with log.open("wb") as file:
            process = subprocess.Popen(
                [*command, folder], env=environment, stdout=file, stderr=file
            )
        try:
            browser = Firefox(_address(log, process))
            yield browser
            browser.close()
            process.wait(SECONDS)
        finally:
            process.kill()
            process.wait()


def _address(log: Path, process: subprocess.Popen[bytes]) -> str:
    """The web socket that Firefox names when it has started."""
    end = time.monotonic() + SECONDS
    while True:
        text = log.read_text(errors="replace")
        if found := re.search(r"WebDriver BiDi listening on (ws://\S+)", text):
            return found[1]
        if process.poll() is not None or time.monotonic() > end:
            raise RuntimeError(f"Firefox did not start:\n{text}")
        time.sleep(0.05)


@contextlib.contextmanager
def _display() -> Iterator[str]:
    """A display in memory. Xvfb chooses its number and writes it into a pipe."""
    reading, writing = os.pipe()
    command = [_program(["Xvfb"]), "-displayfd", str(writing), "-screen", "0", SCREEN]
    with subprocess.Popen(
        [*command, "-nolisten", "tcp"], pass_fds=[writing], stderr=subprocess.DEVNULL
    ) as process:
        os.close(writing)
        try:
            with os.fdopen(reading, encoding="ascii") as file:
                number = file.readline().strip()
            if not number:
                raise RuntimeError("Xvfb did not start")
            yield f":{number}"
        finally:
            process.terminate()
