"""``glid-nb doctor``: what is installed and what works, for a bug report."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import jax
import numpy as np
import pytest

from glid_nb import _diagnosis, _jax

from .conftest import Run


def test_one_screen_tells_versions_devices_folders_and_extras(run: Run) -> None:
    code, out, err = run("doctor")
    assert (code, err) == (0, "")
    for part in (
        f"jax {jax.__version__}",
        f"numpy {np.__version__}",
        sys.executable,
        "LAPACK in place",
        "programs kept",
        "XLA options",
        "GLID_NB_CACHE",
        "GLID_NB_DATA",
        "none (no notebook)",
        "[video]",
    ):
        assert part in out
    assert len(out.splitlines()) <= 40
    assert max(map(len, out.splitlines())) <= 160


def test_as_json_it_is_complete(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("GLID_NB_CACHE", str(tmp_path))
    (tmp_path / "compiled").mkdir()
    (tmp_path / "compiled" / "one").write_bytes(bytes(1000))
    found = json.loads(run("doctor", "--json").out)
    assert found["folders"]["compiled programs"]["bytes"] == 1000
    assert found["folders"]["compiled programs"]["files"] == 1
    assert found["libraries"]["jax"]["installed"] == jax.__version__
    assert found["jax"]["devices"]
    assert found["problems"] == []
    assert {"lab", "check", "video", "compare"} <= set(found["extras"])


def test_a_folder_that_cannot_be_written_is_named(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder", encoding="utf-8")
    monkeypatch.setenv("GLID_NB_CACHE", str(tmp_path / "file"))
    code, out, err = run("doctor")
    assert code == 1
    assert "cannot be written to" in out
    assert re.search(r"programs kept\W+no\b", out)
    assert "name another one in GLID_NB_CACHE" in err


def test_a_folder_inside_one_that_is_closed_is_no_crash(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    closed = tmp_path / "closed"

    def exists(path: Path, **_: object) -> bool:
        if closed in path.parents:
            raise PermissionError(13, "Permission denied")
        return path.is_dir()

    monkeypatch.setattr(Path, "exists", exists)
    monkeypatch.setenv("GLID_NB_CACHE", str(closed))
    found = _diagnosis.diagnosis()["folders"]["compiled programs"]
    assert (found["files"], found["writable"]) == (0, False)
    assert found["path"] == str(closed / "compiled")


def test_a_jax_that_does_not_work_is_told_beside_everything_else(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Broken:
        def __getattr__(self, name: str) -> object:
            raise _jax.incompatible(f"needs jax.{name}")

    monkeypatch.setattr(_diagnosis, "jax", Broken())
    code, out, err = run("doctor")
    assert code == 1
    assert f"Installed are jax {jax.__version__}" in err
    assert "GLID_NB_CACHE" in out


def test_a_library_that_is_too_old_is_named(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    found = _diagnosis.version
    monkeypatch.setattr(
        _diagnosis, "version", lambda name: "0.1.0" if name == "scipy" else found(name)
    )
    code, _, err = run("doctor")
    assert code == 1
    assert "scipy 0.1.0, but glid-nb needs scipy>=" in err


@pytest.mark.parametrize(
    ("variables", "name"),
    [
        ({}, "none (no notebook)"),
        ({"COLAB_RELEASE_TAG": "release-colab_2026"}, "Google Colab"),
        ({"JPY_PARENT_PID": "1", "VSCODE_CWD": "/"}, "VS Code"),
        ({"JPY_PARENT_PID": "no number"}, "Jupyter"),
    ],
)
def test_the_host_is_told_by_what_it_leaves_in_the_environment(
    variables: dict[str, str], name: str
) -> None:
    ours = ("COLAB_RELEASE_TAG", "JPY_PARENT_PID")
    kept = {k: v for k, v in os.environ.items() if k not in ours and not k.startswith("VSCODE_")}
    source = "from glid_nb._diagnosis import host; print(host())"
    done = subprocess.run(
        [sys.executable, "-c", source],
        env={**kept, **variables},
        capture_output=True,
        text=True,
        timeout=100,
        check=True,
    )
    assert done.stdout.strip() == name
