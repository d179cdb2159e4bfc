#!/usr/bin/env bash
# Runs a command in a network of its own, where that is permitted: there nothing but loopback exists, so WebRTC cannot
# pick another address and no other program holds our ports.
#   tests/e2e/own_network.sh COMMAND [ARGUMENT]...
set -euo pipefail

for way in "unshare -n" "unshare -rn"; do
  if $way ip link set lo up 2>/dev/null; then
    exec $way bash -c 'ip link set lo up && exec "$@"' bash "$@"
  fi
done
echo "own_network.sh: unshare -n is not permitted here (or ip is missing): using this machine's own network" >&2
exec "$@"
