"""``python -m glid_nb`` is ``glid-nb``."""

import sys

from glid_nb.cli import main

if __name__ == "__main__":
    sys.exit(main())
