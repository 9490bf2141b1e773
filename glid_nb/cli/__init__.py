"""The command line, ``glid-nb``: one module per command, on the package's public face.

A command's module has ``add_arguments(parser)`` and ``run(chosen)``; its docstring is the help.
"""

from glid_nb.cli.main import main

__all__ = ["main"]
