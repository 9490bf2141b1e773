"""Check that a tag may be released: ``python tools/check_release.py v1.2.3 DISTRIBUTION ...``.

The wheels and sdists of both distributions must exist, with the tag's version. The changelog must
have a section for that version.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

CHANGELOG = Path(__file__).resolve().parent.parent / "CHANGELOG.md"
_WANTED = {f"{name}{end}" for name in ("glid_nb", "glid_check") for end in (".whl", ".tar.gz")}
_FILE = re.compile(r"(glid_nb|glid_check)-(.+?)(?:-py3-none-any)?(\.whl|\.tar\.gz)")


def problems(tag: str, files: list[str], changelog: str) -> list[str]:
    """The reasons against releasing the files under the tag, one sentence each."""
    version, found, seen = tag.removeprefix("v"), [], set[str]()
    if not re.fullmatch(r"v\d+\.\d+\.\d+((a|b|rc)\d+)?", tag):
        found.append(f"the tag {tag} is not of the form v1.2.3 or v1.2.3rc1")
    for file in files:
        match = _FILE.fullmatch(Path(file).name)
        if match is None:
            found.append(f"{file} is not a wheel or sdist of glid-nb or glid-check")
            continue
        seen.add(match[1] + match[3])
        if match[2] != version:
            found.append(f"{file} has version {match[2]}, the tag says {version}")
    found += [f"{name} is missing" for name in sorted(_WANTED - seen)]
    if not re.search(rf"^## \[?{re.escape(version)}\b", changelog, re.MULTILINE):
        found.append(f"CHANGELOG.md has no section '## {version}'")
    return found


def main(tag: str, *files: str) -> None:
    if found := problems(tag, list(files), CHANGELOG.read_text(encoding="utf-8")):
        raise SystemExit("\n".join(found))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
