#!/usr/bin/env bash
# Measures sliding mode control beside the servos' own position control, in the simulated world.
# Usage: scripts/sliding_mode.sh [--robot FILE] [--output DIR]
#   --robot FILE    robot file (default: mamba)
#   --output DIR    where sliding_mode.png is written (default: build/sliding_mode)
# Example: scripts/sliding_mode.sh --output /tmp/sliding_mode
# Takes a minute.
set -euo pipefail

if [ "${1:-}" = --help ]; then sed -n '2,7s/^# //p' "$0"; exit 0; fi
options=()
output=$(realpath -m "$(dirname "$0")/../build/sliding_mode")
while [ $# -gt 0 ]; do
  if [ $# -lt 2 ]; then echo "sliding_mode: $1 needs a value" >&2; exit 2; fi
  case "$1" in
    --output) output=$(realpath -m "$2") ;;
    --robot) options+=(--robot "$(realpath "$2")") ;;
    *) echo "sliding_mode: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
  shift 2
done
cd "$(dirname "$0")/.."

./scripts/setup.sh core tests
./scripts/build.sh --tests measure_sliding_mode
exec build/release/bin/measure_sliding_mode --output "$output" "${options[@]}"
