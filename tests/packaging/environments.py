"""Helpers of the tests marked `install`: they build distributions and make environments."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import NamedTuple

CHECKOUT = Path(__file__).resolve().parents[2]
_SOURCES = ("checker", "glid_nb", "notebooks", "docs", "tests", "studies")
_FILES = ("pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md", "CITATION.cff")


class Built(NamedTuple):
    """The files of one distribution."""

    wheel: Path
    sdist: Path


def run(*command: object, folder: Path, **variables: str) -> str:
    """The output of a program in a folder, without variables that lead to files of this
    checkout."""
    hidden = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "PYTEST_ADDOPTS", "GLID_NB_CACHE"}
    kept = {name: value for name, value in os.environ.items() if name not in hidden}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env={**kept, "PYTHONUTF8": "1", **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, f"{command} ends with {done.returncode}:\n{done.stdout}"
    return done.stdout


def copy_of_the_checkout(to: Path) -> Path:
    """The files of a clone that an installation reads, without anything that was built."""
    for name in _SOURCES:
        shutil.copytree(CHECKOUT / name, to / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in _FILES:
        shutil.copy(CHECKOUT / name, to)
    return to


def build(source: Path, into: Path) -> Built:
    """The sdist of a source folder, and the wheel built from this sdist."""
    run(sys.executable, "-m", "build", "--outdir", into, source, folder=into)
    (wheel,), (sdist,) = into.glob("*.whl"), into.glob("*.tar.gz")
    return Built(wheel, sdist)


class Environment:
    """An empty virtual environment."""

    def __init__(self, folder: Path) -> None:
        run(sys.executable, "-m", "venv", folder, folder=folder.parent)
        self.folder = folder

    def program(self, name: str) -> Path:
        """The path of a program of the environment."""
        scripts = Path(sysconfig.get_path("scripts", "venv", {"base": str(self.folder)}))
        return scripts / (f"{name}.exe" if os.name == "nt" else name)

    def install(self, *requirements: object) -> None:
        pip = (self.program("python"), "-m", "pip", "--disable-pip-version-check")
        run(*pip, "install", "--quiet", *requirements, folder=self.folder)

    def packages(self) -> set[str]:
        """The names of the installed packages, except pip and those of venv itself."""
        command = "import importlib.metadata as m; print(*(d.name for d in m.distributions()))"
        names = run(self.program("python"), "-c", command, folder=self.folder).split()
        return {name.lower() for name in names} - {"pip", "setuptools"}
