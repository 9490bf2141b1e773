#!/bin/sh
# Installs Firefox for the tests of exported pages through apt, if none is there. Also Xvfb, because
# Firefox has WebGL only on a display.
# $GLID_NB_FIREFOX may name a browser elsewhere.
set -eu
browser='' display=''
if [ -n "${GLID_NB_FIREFOX:-}" ] && [ -x "$GLID_NB_FIREFOX" ]; then browser=$GLID_NB_FIREFOX; fi
for name in firefox-esr firefox; do
    if command -v "$name" >/dev/null 2>&1; then browser=$name; fi
done
if command -v Xvfb >/dev/null 2>&1; then display=Xvfb; fi
if [ -n "$browser" ] && [ -n "$display" ]; then exit 0; fi
if ! command -v apt-get >/dev/null 2>&1; then
    echo "glid-nb: the tests need Firefox and Xvfb; install them, or name Firefox in GLID_NB_FIREFOX" >&2
    exit 1
fi
as_root=''
if [ "$(id -u)" -ne 0 ]; then as_root='sudo'; fi
export DEBIAN_FRONTEND=noninteractive
echo "glid-nb: installing firefox and xvfb with apt-get" >&2
$as_root apt-get update -qq
# Ubuntu's package `firefox` would be a snap, and Debian's is firefox-esr.
if [ -z "$browser" ]; then
    $as_root apt-get install -y -qq --no-install-recommends firefox-esr libegl1 libgl1-mesa-dri >/dev/null
fi
$as_root apt-get install -y -qq --no-install-recommends xvfb >/dev/null
