#!/usr/bin/env bash
# Compares the simulated physics with laws of mechanics, a model of Liljebäck's book, MuJoCo and finer solvers.
# Usage: scripts/validate_physics.sh [--output DIR] [--only GROUP...]
#   --output DIR    where validation.md, validation.json and the plots are written (default: build/validation)
#   --only GROUP    only these groups: bodies slopes joints contacts energy servos planar
#                   speeds mujoco (if it is installed: scripts/setup.sh bench) convergence
# Example: scripts/validate_physics.sh --only planar
# Takes 5 to 10 minutes on one core, most of them for convergence. Exit status 1: a required comparison failed.
set -euo pipefail

options=()
output=""
while [ $# -gt 0 ]; do
  case "$1" in
    --help) sed -n '2,8s/^# //p' "$0"; exit 0 ;;
    --output)
      if [ $# -lt 2 ]; then echo "validate_physics: --output needs a folder" >&2; exit 64; fi
      output=$(realpath -m "$2")
      shift 2
      ;;
    *) options+=("$1"); shift ;;
  esac
done
cd "$(dirname "$0")/.."

./scripts/setup.sh core tests
./scripts/build.sh --tests validate_physics
exec build/release/bin/validate_physics --output "${output:-build/validation}" "${options[@]}"
