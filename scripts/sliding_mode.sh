#!/usr/bin/env bash
# Measures sliding mode control beside the servos' own position control, in the simulated world.
# Usage: scripts/sliding_mode.sh [--robot ROBOT] [--output DIR]
#   --robot ROBOT   robot file, or the name of a shipped robot (default: mamba)
#   --output DIR    where sliding_mode.png is written (default: build/sliding_mode)
# Example: scripts/sliding_mode.sh --output /tmp/sliding_mode
# Takes a minute.
set -euo pipefail
# shellcheck source=/dev/null
source "$(dirname "$0")/measure.sh"

measure sliding_mode "$@"
