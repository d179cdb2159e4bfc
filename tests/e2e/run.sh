#!/usr/bin/env bash
# Runs the browser tests, in a network of their own where that is permitted: there nothing but loopback exists, so
# WebRTC cannot pick another address and no other program holds our ports.
#   tests/e2e/run.sh [TEST FILE]...
# CHROMIUM names the browser, LICHTVELD the render server (build/release/lichtveld).
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -gt 0 ] || set -- tests/e2e/*.test.js

for way in "unshare -n" "unshare -rn"; do
  if $way ip link set lo up 2>/dev/null; then
    exec $way bash -c 'ip link set lo up && exec "$@"' bash node --test "$@"
  fi
done
echo "run.sh: unshare -n is not permitted here (or ip is missing): using this machine's own network instead" >&2
exec node --test "$@"
