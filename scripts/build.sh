#!/usr/bin/env bash
# Builds into build/release; the programs are then in build/release/bin. With CI=true, warnings are errors.
# Usage: scripts/build.sh [--tests] [TARGET...]
#   --tests   also the tests and benchmarks (scripts/setup.sh core tests installs what they need)
# Example: scripts/build.sh physics
# Without a target it builds all programs.
set -euo pipefail
cd "$(dirname "$0")/.."

options=()
targets=()
for argument in "$@"; do
  case "$argument" in
    --help) sed -n '2,6s/^# //p' "$0"; exit 0 ;;
    --tests) options=(-DCONSTRICTOR_TESTS=ON) ;;
    -*) echo "build: there is no option \"$argument\"; accepted: --tests" >&2; exit 2 ;;
    *) targets+=("$argument") ;;
  esac
done
if [ ${#targets[@]} -eq 0 ]; then
  if [ ${#options[@]} -eq 0 ]; then targets=(programs); else targets=(all); fi
fi
if [ "${CI:-}" = true ]; then options+=(-DCONSTRICTOR_WERROR=ON); fi  # otherwise as the build tree was configured

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "build: configuring"
if ! cmake --preset release "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  echo "build: configuring failed" >&2
  exit 1
fi

# On a terminal, ninja shows one line that changes. Elsewhere its hundreds of lines are reduced to one every 15 s;
# warnings and errors are kept.
thin_out() {
  local line step="" shown=-15
  while IFS= read -r line; do
    if [[ $line =~ ^\[[0-9]+/[0-9]+\] ]]; then
      step=$line
      if ((SECONDS - shown < 15)); then continue; fi
      shown=$SECONDS
      step=""
    fi
    printf '%s\n' "$line"
  done
  if [ -n "$step" ]; then echo "$step"; fi  # the last step, unless it has been shown
}
echo "build: compiling ${targets[*]} (the first time takes some minutes)"
if [ -t 1 ]; then
  cmake --build build/release --target "${targets[@]}"
else
  cmake --build build/release --target "${targets[@]}" 2>&1 | thin_out
fi
