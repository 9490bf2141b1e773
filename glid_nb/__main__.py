"""``python -m glid_nb`` is ``glid-nb``."""

from glid_nb.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
