#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test but those labelled `long`.
# Usage: scripts/test.sh [--all] [CTEST ARGUMENT...]
#   --all   also the long tests, and the unit tests again under the address, undefined-behaviour and thread sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

if [ "${1:-}" = --help ]; then sed -n "2,4s/^# //p" "$0"; exit 0; fi
all=false
if [ "${1:-}" = --all ]; then
  all=true
  shift
fi

./scripts/setup.sh --fast-dds
echo "test: building"
./scripts/build.sh

# Tests of several processes are marked to run alone; the others share the cores.
options=(--output-on-failure -j "$(nproc)")
if [ "$all" = false ]; then
  exec ctest --test-dir build/release "${options[@]}" -LE long "$@"
fi

ctest --test-dir build/release "${options[@]}" "$@"
# Memory leaks at exit are OpenCV's and OSMesa's own; everything else counts.
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS="halt_on_error=1 suppressions=$PWD/tests/support/tsan.suppressions"
for sanitizer in asan tsan; do
  echo "test: building with $sanitizer"
  cmake --preset "$sanitizer" >/dev/null
  cmake --build "build/$sanitizer" --target unit_tests
  ctest --test-dir "build/$sanitizer" "${options[@]}" -L unit "$@"
done
