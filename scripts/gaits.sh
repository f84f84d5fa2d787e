#!/usr/bin/env bash
# Measures control's gaits in the simulated world and draws them.
# Usage: scripts/gaits.sh [--robot FILE] [--output DIR]
#   --robot FILE    robot file (default: mamba)
#   --output DIR    where gaits.png and gaits.json are written (default: build/gaits)
# Example: scripts/gaits.sh --output /tmp/gaits
# Takes half a minute.
set -euo pipefail

if [ "${1:-}" = --help ]; then sed -n '2,7s/^# //p' "$0"; exit 0; fi
options=()
output=$(realpath -m "$(dirname "$0")/../build/gaits")
while [ $# -gt 0 ]; do
  if [ $# -lt 2 ]; then echo "gaits: $1 needs a value" >&2; exit 2; fi
  case "$1" in
    --output) output=$(realpath -m "$2") ;;
    --robot) options+=(--robot "$(realpath "$2")") ;;
    *) echo "gaits: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
  shift 2
done
cd "$(dirname "$0")/.."

./scripts/setup.sh core tests
./scripts/build.sh --tests measure_gaits
exec build/release/bin/measure_gaits --output "$output" "${options[@]}"
