#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests except those with the label `long`.
# Usage: scripts/test.sh [--all] [CTEST OPTION...]
#   --all   also the long tests, and the unit tests once more with the address and undefined-behaviour sanitizers and
#           with the thread sanitizer
# Example: scripts/test.sh -R Planner
set -euo pipefail
cd "$(dirname "$0")/.."

if [ "${1:-}" = --help ]; then sed -n '2,6s/^# //p' "$0"; exit 0; fi
all=false
if [ "${1:-}" = --all ]; then
  all=true
  shift
fi

groups=(core tests)
if [ "$all" = true ]; then groups+=(browser cluster boot); fi
./scripts/setup.sh "${groups[@]}"
./scripts/build.sh --tests

# Tests of several processes often wait for simulated time, so twice as many tests as cores run side by side. ctest runs
# the tests that are marked RUN_SERIAL alone.
options=(--output-on-failure -j "$((2 * $(nproc)))")
if [ "$all" = false ]; then
  exec ctest --test-dir build/release "${options[@]}" -LE long "$@"
fi

ctest --test-dir build/release "${options[@]}" "$@"
# Leak detection is off because OpenCV and OSMesa leak memory at exit. Every other error stops the test.
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS="halt_on_error=1 suppressions=$PWD/tests/support/tsan.suppressions"
for sanitizer in asan tsan; do
  echo "test: building with $sanitizer"
  cmake --preset "$sanitizer" >/dev/null
  cmake --build "build/$sanitizer" --target unit_tests
  ctest --test-dir "build/$sanitizer" "${options[@]}" -L unit "$@"
done
