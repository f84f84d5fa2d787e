#!/usr/bin/env bash
# Measures the dashboard beside a run of the case study in real time: the latency of a viewer alone and beside three
# viewers that read nothing, the dashboard's memory, and the time for which the page keeps the main thread of a browser
# busy in each frame. Prints one line for each; write them into components/tools/dashboard/README.md.
# Usage: scripts/bench_dashboard.sh [SECONDS]
#   SECONDS   length of the first part and of the last one; the middle one takes twice as long (default: 30)
# Run it on a quiet machine. It needs Chromium (scripts/setup.sh browser).
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${1:-}" = --help ]; then sed -n '2,7s/^# //p' "$0"; exit 0; fi
seconds=${1:-30}
case "$seconds" in
  ''|*[!0-9]*) echo "bench_dashboard: SECONDS: found \"$seconds\", accepted a whole number" >&2; exit 64 ;;
esac
./scripts/build.sh --tests bench_dashboard constrictor dashboard

folder=$(mktemp -d)
launcher=
finish() {
  if [ -n "$launcher" ]; then kill -INT "$launcher" 2>/dev/null || true; wait "$launcher" || true; fi
  rm -rf "$folder"
}
trap finish EXIT
# A registry of its own: no other run of this host is meant.
export XDG_RUNTIME_DIR=$folder
DISPLAY='' WAYLAND_DISPLAY='' build/release/bin/constrictor run --seed 1 --in-process --pace 1x --view --view-port 0 \
  --report "$folder/report" >"$folder/output" 2>&1 &
launcher=$!
for _ in $(seq 300); do
  port=$(sed -n 's/.*shown at http:.*:\([0-9]*\).*/\1/p' "$folder/output")
  [ -z "$port" ] || break
  kill -0 "$launcher" 2>/dev/null || { cat "$folder/output" >&2; exit 1; }
  sleep 0.1
done
[ -n "$port" ] || { echo "bench_dashboard: the dashboard did not start within 30 s" >&2; exit 1; }
dashboard=
for child in $(ps -o pid= --ppid "$launcher"); do
  if [ "$(cat "/proc/$child/comm")" = dashboard ]; then dashboard=$child; fi
done
sleep 3  # the dashboard discovers the topics of the run
echo "load of the machine: $(cut -d' ' -f1-3 /proc/loadavg)"
build/release/bin/bench_dashboard "$port" "$dashboard" "$seconds"
echo "the page in headless Chromium, 1440x900, main thread in each frame:"
node tests/support/browser.mjs "http://127.0.0.1:$port/" 1440x900 \
  "wait=document.querySelector('#connection').textContent === 'connected'" \
  "wait=document.querySelector('#solid').checked" "colours=30 #scene_3d" "frames=$seconds"
