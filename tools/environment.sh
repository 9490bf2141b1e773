#!/bin/sh
# Makes or updates a virtual environment with this package.
#   tools/environment.sh [EXTRA]      EXTRA: an extra of pyproject.toml, such as test or dev
# $VENV names the environment (default .venv), $PYTHON the interpreter (default: the newest one that
# tools/pythons.sh finds). With $RESOLUTION=lowest-direct, uv installs the oldest libraries that
# pyproject.toml allows.
set -euf
cd "$(dirname "$0")/.."
extra=${1:-}
venv=${VENV:-.venv}

say() { echo "glid-nb: $*" >&2; }
recent() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; }
has_venv() { "$1" -c 'import ensurepip, venv' >/dev/null 2>&1; }

if ! [ -x "$venv/bin/python" ] || ! recent "$venv/bin/python"; then
    python='' without_venv=''
    for candidate in $(tools/pythons.sh); do
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
    say "making the environment $venv with $("$python" --version), $python"
    "$python" -m venv --clear "$venv"
fi

say "installing glid-nb${extra:+[$extra]} and what it needs into $venv"
what="${extra:+--editable ./checker} --editable .${extra:+[$extra]}"
pip="$venv/bin/python -m pip install --quiet --disable-pip-version-check"
# uv is several times faster than pip, and knows the oldest libraries. It trusts the certificates that
# the system trusts, as pip does.
export UV_SYSTEM_CERTS=true UV_NATIVE_TLS=true
uv="$venv/bin/python -m uv pip install --quiet --compile-bytecode --python $venv/bin/python"
if $pip uv && $uv ${RESOLUTION:+--resolution "$RESOLUTION"} $what; then exit 0; fi
if [ -n "${RESOLUTION:-}" ]; then exit 1; fi
say "uv cannot install it here; pip tries"
$pip $what
