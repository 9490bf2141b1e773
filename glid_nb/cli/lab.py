"""Open JupyterLab on the editor's notebook.

A copy of the notebook is put into the folder, unless there is one already. What follows `--` goes
to JupyterLab as it is.
"""

from __future__ import annotations

import argparse
import importlib.util
import subprocess
import sys
from pathlib import Path

from glid_nb.cli.errors import CommandError

NOTEBOOK = "editor.ipynb"
