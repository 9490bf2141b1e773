#!/bin/bash
# Installs the wheels of some folders into an empty environment. Runs the demo and the checker in an
# empty folder:   tools/smoke.sh FOLDER ...
# $PYTHON names the interpreter, by default python.
set -euo pipefail
wheels=()
for folder in "$@"; do
    for wheel in "$(cd "$folder" && pwd)"/*.whl; do wheels+=("$wheel"); done
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python}" -m venv environment
programs=environment/bin
if [ -d environment/Scripts ]; then programs=environment/Scripts; fi
"$programs/python" -m pip install --quiet --disable-pip-version-check "${wheels[@]}"
export MPLBACKEND=agg
"$programs/glid-nb" demo --out demo
"$programs/python" - <<'PROOF'
import glid_nb as glid
map = glid.HarmonicMap.load("demo/map.json")
glid.certify(map).save("proof.json")
PROOF
"$programs/glid-check" demo/map.json proof.json
