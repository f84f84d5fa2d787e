#!/usr/bin/env bash
# Measures the parts and the whole: writes DIR/bench.json and the table DIR/bench.md, and prints the table.
# Usage: scripts/bench.sh [--output DIR] [--no-peers] [--no-mission]
#   --output DIR   folder of the results, which replace those of an earlier call there (default: build/bench)
#   --no-peers     without the comparisons with MuJoCo, which takes some minutes, and with ddsperf
#   --no-mission   without the runs of the case study: CPU time by process and function, launch
# Example: scripts/bench.sh --no-peers
# Run it on a quiet machine. The exit status is 1 if something is above its limit.
set -euo pipefail
cd "$(dirname "$0")/.."

output=build/bench
peers=1
mission=1
while [ $# -gt 0 ]; do
  case "$1" in
    --help) sed -n '2,8s/^# //p' "$0"; exit 0 ;;
    --output)
      if [ $# -lt 2 ]; then echo "bench: --output needs a folder" >&2; exit 64; fi
      output=$2; shift ;;
    --no-peers) peers=0 ;;
    --no-mission) mission=0 ;;
    *) echo "bench: there is no option \"$1\"; accepted: --output DIR, --no-peers, --no-mission" >&2; exit 64 ;;
  esac
  shift
done

groups=(core tests)
targets=(bench_world bench_tick bench_camera bench_perception bench_growth bench_members bench_table)
if [ $peers = 1 ]; then groups+=(bench); targets+=(bench_engines bench_renderers); fi
if [ $mission = 1 ]; then targets+=(programs); fi
./scripts/setup.sh "${groups[@]}"
./scripts/build.sh --tests "${targets[@]}"
mkdir -p "$output"
# Results of an earlier call must not appear in the table. The folder may also hold files of others, which stay.
for part in world tick camera perception growth members engines renderers ddsperf launch profile bench; do
  rm -f "$output/$part.json"
done
rm -rf "$output/case_study"

# The other options of the program are those of Google Benchmark.
run_part() {
  local part=$1
  shift
  echo "bench: $part"
  "build/release/bin/bench_$part" "$@" --benchmark_out="$output/$part.json" --benchmark_out_format=json \
    >"$output/$part.txt"
}
for part in world camera perception growth; do run_part "$part"; done
# Parts and wholes take turns, so that what disturbs the machine disturbs both.
run_part tick --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true
echo "bench: members in processes of their own"
/usr/bin/python3 tests/bench/members/measure.py >"$output/members.json"
if [ $peers = 1 ]; then
  echo "bench: MuJoCo"
  build/release/bin/bench_engines >"$output/engines.json"
  run_part renderers
  if command -v ddsperf >/dev/null; then
    echo "bench: ddsperf"
    /usr/bin/python3 tests/bench/peers/ddsperf_ping.py >"$output/ddsperf.json"
  else
    echo "bench: without ddsperf, because it is not installed (scripts/setup.sh bench)"
  fi
fi
if [ $mission = 1 ]; then
  echo "bench: the launch of the case study"
  /usr/bin/python3 tests/bench/launch/measure.py >"$output/launch.json"
  echo "bench: the case study by groups of functions"
  /usr/bin/python3 tests/bench/profile/measure.py >"$output/profile.json"
  echo "bench: the case study"
  build/release/bin/constrictor run --seed 1 --report "$output/case_study" >"$output/case_study.txt" 2>&1 || {
    tail -5 "$output/case_study.txt" >&2
    echo "bench: the case study failed" >&2
    exit 1
  }
fi
build/release/bin/bench_table "$output"
