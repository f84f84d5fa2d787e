#!/usr/bin/env bash
# Builds the release into build/release; programs are then in build/release/bin. With CI=true warnings are errors.
# Usage: scripts/build.sh [TARGET...]
set -euo pipefail
cd "$(dirname "$0")/.."

werror=OFF
if [ "${CI:-}" = true ]; then werror=ON; fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset release -DCONSTRICTOR_WERROR="$werror" >"$log" 2>&1; then
  cat "$log" >&2
  echo "build: configuring failed" >&2
  exit 1
fi
cmake --build build/release -- "$@"
