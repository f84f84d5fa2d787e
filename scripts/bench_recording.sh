#!/usr/bin/env bash
# Measures what recording costs: runs of the case study without recording, and with each kind of recorded images, one
# after the other in several rounds. Prints the processor time of each run, and a table of medians and ratios; write it
# into components/tools/cli/README.md.
# Usage: scripts/bench_recording.sh [OPTIONS]
#   --seconds S      simulated time of each run (default: 40)
#   --rounds N       rounds; each has one run of each kind, in another order (default: 5)
#   --kinds K,K      some of none, off, recompute, on (default: all)
#   --scenario NAME  scenario of all runs (default: case_study)
#   --programs DIR   folder of the programs (default: build/release/bin, which is built first)
# Example: scripts/bench_recording.sh --seconds 20 --rounds 3
# One round of 40 simulated seconds takes about a minute. Other programs on the machine change processor times, too: by
# the caches and the hyperthreads that they share. Use more rounds there.
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
root=$(cd "$(dirname "$0")/.." && pwd)
case " $* " in
  *" --programs "*) ;;
  *) "$root/scripts/build.sh" && set -- --programs "$root/build/release/bin" "$@" ;;
esac
exec /usr/bin/python3 "$root/tests/bench/recording/measure.py" "$@"
