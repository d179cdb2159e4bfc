#!/usr/bin/env bash
# Runs the browser tests in a network of their own.
#   tests/e2e/run.sh [TEST FILE]...
# CHROMIUM names the browser, LICHTVELD the render server (build/release/lichtveld).
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -gt 0 ] || set -- tests/e2e/*.test.js
exec tests/e2e/own_network.sh node --test "$@"
