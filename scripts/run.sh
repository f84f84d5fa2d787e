#!/usr/bin/env bash
# Installs what is missing, builds the programs, and runs the case study: each component in a process of its own.
# Usage: scripts/run.sh [SCENARIO] [--seed N] [--report DIR] ...   (all options of `constrictor run`)
# Example: scripts/run.sh --seed 7
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '2,4s/^# //p' "$0"; exit 0; fi
cd "$(dirname "$0")/.."

./scripts/setup.sh core
./scripts/build.sh
exec build/release/bin/constrictor run "$@"
