"""Open JupyterLab on the editor's notebook.

The notebook is copied into the folder as editor.ipynb, unless this file exists. Arguments after
`--` are passed to JupyterLab.
"""

import argparse
import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import glid_nb
from glid_nb._errors import InputError

NOTEBOOK = "editor.ipynb"
_BUNDLED = Path("notebooks") / "02_editor.ipynb"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    folder = "folder to work in; created if it is missing (default: this folder)"
    add("folder", nargs="?", type=Path, default=Path(), metavar="FOLDER", help=folder)
    add("--print", action="store_true", help="print the command without running it")
    add("jupyter", nargs="*", metavar="ARGUMENT", help="for JupyterLab, after --")


def run(chosen: argparse.Namespace) -> None:
    if importlib.util.find_spec("jupyterlab") is None:
        raise InputError("JupyterLab is not installed here; run: pip install 'glid-nb[lab]'")
    notebook = chosen.folder / NOTEBOOK
    command = [sys.executable, "-m", "jupyterlab", str(notebook), *chosen.jupyter]
    if chosen.print:
        print(shlex.join(command) if os.name == "posix" else subprocess.list2cmdline(command))
        return
    chosen.folder.mkdir(parents=True, exist_ok=True)
    if not notebook.exists():
        shutil.copyfile(_bundled_notebook(), notebook)
    become(command)


def become(command: list[str]) -> None:
    """Run the command in place of this process, so that a signal to one ends both."""
    if os.name == "posix":
        sys.stdout.flush()
        os.execv(command[0], command)
    if status := subprocess.run(command, check=False).returncode:
        raise InputError(f"JupyterLab ended with the exit code {status}")


def _bundled_notebook() -> Path:
    """The editor's notebook: inside an installed package, or beside the package in a checkout."""
    for folder in Path(glid_nb.__file__).resolve().parents[:2]:
        if (folder / _BUNDLED).is_file():
            return folder / _BUNDLED
    raise InputError(f"{_BUNDLED} is missing from this installation; install glid-nb again")
