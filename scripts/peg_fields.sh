#!/usr/bin/env bash
# Drives the simulated robot through random fields of pegs, with contact control and without.
# Usage: scripts/peg_fields.sh [--robot ROBOT] [--output DIR]
#   --robot ROBOT   robot file, or the name of a shipped robot (default: mamba)
#   --output DIR    where peg_fields.png and peg_fields.json are written (default: build/peg_fields)
# Example: scripts/peg_fields.sh --output /tmp/peg_fields
# Takes three minutes.
set -euo pipefail
# shellcheck source=/dev/null
source "$(dirname "$0")/measure.sh"

measure peg_fields "$@"
