#!/usr/bin/env bash
# Measures control's gaits in the simulated world and draws them.
# Usage: scripts/gaits.sh [--robot ROBOT] [--output DIR]
#   --robot ROBOT   robot file, or the name of a shipped robot (default: mamba)
#   --output DIR    where gaits.png and gaits.json are written (default: build/gaits)
# Example: scripts/gaits.sh --output /tmp/gaits
# Takes half a minute.
set -euo pipefail
# shellcheck source=/dev/null
source "$(dirname "$0")/measure.sh"

measure gaits "$@"
