#!/bin/sh
# Installs Chromium for the browser tests through apt, if none is there.
# $GLID_NB_CHROMIUM may name a browser elsewhere.
set -eu
if [ -n "${GLID_NB_CHROMIUM:-}" ] && [ -x "$GLID_NB_CHROMIUM" ]; then exit 0; fi
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then exit 0; fi
done
if ! command -v apt-get >/dev/null 2>&1; then
    echo "glid-nb: the browser tests need Chromium; install it, or name it in GLID_NB_CHROMIUM" >&2
    exit 1
fi
as_root=''
if [ "$(id -u)" -ne 0 ]; then as_root='sudo'; fi
export DEBIAN_FRONTEND=noninteractive
echo "glid-nb: installing chromium with apt-get" >&2
$as_root apt-get update -qq
$as_root apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core >/dev/null
