#!/bin/sh
# Lists the Pythons of this machine that the package can use, the best first, one path per line:
# first the tested versions, the newest first, then other released versions.
#   tools/pythons.sh [--one-a-version]     only the first of each version, such as 3.12
# Searches $PYTHON alone if it is set, else $PATH and the folders of pyenv.
set -eu

TESTED="3.14 3.13 3.12 3.11"
home=${HOME:-$(getent passwd "$(id -u)" 2>/dev/null | cut -d: -f6)}

candidates() {
    if [ -n "${PYTHON:-}" ]; then command -v "$PYTHON" || true; return; fi
    for name in $(for version in $TESTED; do echo "python$version"; done) python3 python; do
        command -v "$name" || true
    done
    for python in "${PYENV_ROOT:-$home/.pyenv}"/versions/*/bin/python3; do
        [ -x "$python" ] && echo "$python" || true
    done
}

# Prints whether the version is tested, then the version, for sorting. Prints nothing if it is too
# old, not released, or a build without the global lock, for which libraries have no wheels.
PROBE='
import sys, sysconfig
v = sys.version_info
if v >= (3, 11) and v.releaselevel == "final" and not sysconfig.get_config_var("Py_GIL_DISABLED"):
    version = f"{v[0]}.{v[1]}"
    tested = version in sys.argv[1].split()
    print(int(tested), v[1], v[2], version, sys.executable)
'
candidates | while read -r python; do
    "$python" -c "$PROBE" "$TESTED" 2>/dev/null || true
done | sort -k1,1nr -k2,2nr -k3,3nr -s | while read -r _ _ _ version python; do
    case " ${listed:-} " in *" ${version} "*) [ "${1:-}" = --one-a-version ] && continue ;; esac
    listed="${listed:-} $version"
    echo "$python"
done
