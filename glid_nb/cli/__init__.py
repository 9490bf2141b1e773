"""The command line, ``glid-nb``: one module per command. It uses the package's public names only.

A command's module has ``add_arguments(parser)`` and ``run(chosen)``. Its docstring is the help.
"""

from glid_nb.cli.main import main

__all__ = ["main"]
