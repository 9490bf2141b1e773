#!/bin/sh
# Runs the fast tests, the demo and one chapter on every Python of this machine except the newest,
# which `make test` uses; and on the oldest with the oldest allowed libraries.
# Each has its own environment in build/pythons.
set -eu
cd "$(dirname "$0")/.."

check() { # name of the environment, Python, resolution
    echo "glid-nb: $1" >&2
    VENV="build/pythons/$1" PYTHON="$2" RESOLUTION="${3:-}" \
        "${MAKE:-make}" --no-print-directory VENV="build/pythons/$1" unit demo chapter
}

oldest=''
for python in $(tools/pythons.sh --one-a-version | tail -n +2); do
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    check "$version" "$python"
    oldest=$python
done
oldest=${oldest:-$(tools/pythons.sh | head -n 1)}
check oldest-libraries "$oldest" lowest-direct
