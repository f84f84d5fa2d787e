#!/usr/bin/env bash
# Measures how soon the robot is at rest after faults of its hardware and of its processes, on emulated hardware.
# Usage: scripts/fault_reactions.sh [--only TEXT] [--output FILE]
#   --only TEXT     only faults whose name contains this text
#   --output FILE   where the table is written (default: build/fault_reactions/table.md)
# Example: scripts/fault_reactions.sh --only camera
# Takes six minutes. Run nothing else meanwhile: the runs are at real-time pace.
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
cd "$(dirname "$0")/.."
root=$PWD
cd - > /dev/null
"$root/scripts/setup.sh" hardware python
"$root/scripts/build.sh" --hardware --python
PYTHONPATH=$root/build/release/python exec /usr/bin/python3 "$root/tests/bench/fault_reactions/measure.py" \
  --constrictor "$root/build/release/bin/constrictor" --output "$root/build/fault_reactions/table.md" "$@"
