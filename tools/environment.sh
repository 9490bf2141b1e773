#!/bin/sh
# Makes or updates the virtual environment .venv with this package in it.
#   tools/environment.sh [EXTRA]      EXTRA: an extra of pyproject.toml, such as test or dev
# $PYTHON names the interpreter to use; otherwise the first Python >= 3.11 found is taken.
set -eu
cd "$(dirname "$0")/.."
extra=${1:-}
venv=.venv

say() { echo "glid-nb: $*" >&2; }
recent() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; }
has_venv() { "$1" -c 'import ensurepip, venv' >/dev/null 2>&1; }

if ! [ -x "$venv/bin/python" ] || ! recent "$venv/bin/python"; then
    python='' without_venv=''
    for candidate in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11 python; do
        recent "$candidate" || continue
        if has_venv "$candidate"; then python=$candidate; break; fi
        without_venv=${without_venv:-$candidate}
    done
    if [ -z "$python" ] && [ -n "$without_venv" ]; then
        say "$without_venv has no venv module; on Debian or Ubuntu run: sudo apt-get install python3-venv"
        exit 1
    elif [ -z "$python" ]; then
        say "no Python 3.11 or newer was found; on Debian or Ubuntu run: sudo apt-get install python3 python3-venv"
        exit 1
    fi
    say "making the environment $venv with $("$python" --version)"
    "$python" -m venv --clear "$venv"
fi

say "installing glid-nb${extra:+[$extra]} and what it needs into $venv (about a minute the first time)"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --editable ".${extra:+[$extra]}"
