#!/usr/bin/env bash
# Installs what is missing, builds, and runs the case study headless: every component a process of its own.
# Usage: scripts/run.sh [SCENARIO] [--seed N] [--report DIR] ...   (all arguments of `constrictor run`)
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/setup.sh
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "run: building (the first time takes some minutes)"
if ! ./scripts/build.sh >"$log" 2>&1; then
  tail -n 60 "$log" >&2
  echo "run: the build failed" >&2
  exit 1
fi
rm -f "$log"
trap - EXIT
exec build/release/bin/constrictor run "$@"
