#!/usr/bin/env bash
# Repeats missions for hours while their processes are killed and stopped at random, and compares each with a run that
# was left alone.
# Usage: scripts/soak.sh [OPTIONS]
#   --hours H          end after so many hours of wall time (default: 8)
#   --missions N       end after N missions in all, those of earlier calls included
#   --output DIR       results, and the folders of missions that failed (default: build/soak)
#   --scenario NAME    scenario of all missions (default: case_study)
#   --manifest NAME    launch manifest (default: case_study)
#   --seeds A..B       seeds of the runs, in turn (default: 1..5)
#   --every S          mean time between two kills or stops, seconds of wall time (default: 2)
#   --draw N           seed of the random faults (default: 1)
#   --programs DIR     folder of the programs (default: build/release/bin, which is built first)
# Example: nice -n 19 scripts/soak.sh --hours 8
# Ctrl-C ends the mission that is going on and prints the summary. The same command goes on where it was interrupted.
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
root=$(cd "$(dirname "$0")/.." && pwd)
case " $* " in
  *" --programs "*) ;;
  *) "$root/scripts/setup.sh" core && "$root/scripts/build.sh" && set -- --programs "$root/build/release/bin" "$@" ;;
esac
exec /usr/bin/python3 "$root/tests/bench/soak/soak.py" --default-output "$root/build/soak" "$@"
