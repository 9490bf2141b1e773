"""The command line, ``glid-nb``: one module per command, all on the package's public face."""

from glid_nb.cli.main import main

__all__ = ["main"]
