#!/bin/sh
# Measures the solver on this machine's GPU, with the machine's own Python and JAX.
#   tools/gpu.sh [ARGUMENTS]        those of `python -m studies gpu`
#   tools/gpu.sh wheels [NAME...]   before, with a network: download missing packages into wheels/
# $PYTHON names the interpreter (default python3). Its environment is not changed: missing packages
# are installed from wheels/ into build/gpu, without a network.
set -eu
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
wheels=wheels site=build/gpu
lacking='shapely trimesh pythoncdt python-flint'

say() { echo "glid-nb: $*" >&2; }

# Names of packages whose module (after the colon) cannot be imported.
missing() {
    "$python" - "$@" <<'END'
import importlib.util
import sys

pairs = [name.partition(":") for name in sys.argv[1:]]
print(*[name for name, _, module in pairs if importlib.util.find_spec(module or name) is None])
END
}

if [ "${1:-}" = wheels ]; then
    shift
    platforms=''
    for tag in 2_39 2_35 2_34 2_31 2_28 2_27 2_24 2_17; do
        platforms="$platforms --platform manylinux_${tag}_x86_64"
    done
    # shellcheck disable=SC2086 # words
    exec "$python" -m pip download --quiet --disable-pip-version-check --no-deps --only-binary=:all: \
        --python-version "${VERSION:-3.12}" --implementation cp $platforms --platform manylinux2014_x86_64 \
        --dest "$wheels" $lacking "$@"
fi

needed='jax numpy scipy matplotlib threadpoolctl lazy_loader shapely trimesh pythoncdt pillow:PIL scikit-image:skimage pytest pytest-timeout:pytest_timeout hypothesis python-flint:flint'
export PYTHONPATH="$PWD/$site${PYTHONPATH:+:$PYTHONPATH}"
# shellcheck disable=SC2086
names=$(missing $needed)
for name in $names; do
    if ls "$wheels"/"$(echo "$name" | tr '-' '_')"-*.whl >/dev/null 2>&1; then
        "$python" -m pip install --quiet --disable-pip-version-check --no-index --no-deps --no-compile \
            --find-links "$wheels" --target "$site" "$name"
    fi
done
# shellcheck disable=SC2086
names=$(missing $needed)
if [ -n "$names" ]; then
    say "$python lacks $names; with a network, run: tools/gpu.sh wheels $names, and take the folder wheels along"
    exit 1
fi
exec "$python" -m studies gpu "$@"
