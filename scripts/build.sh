#!/usr/bin/env bash
# Builds into build/release; the programs are then in build/release/bin. With CI=true, warnings are errors.
# Usage: scripts/build.sh [--GROUP...] [--tests] [TARGET...]
#   --hardware   also the drivers of servos and cameras, emulated devices, and `constrictor camera` and `conform`
#   --web        also `constrictor dashboard`
#   --pictures   also `constrictor figure` and `film`
#   --ros        also ros_bridge
#   --python     also the Python package
#   --all        all of these
#   --tests      all of these, and the tests and benchmarks
# `scripts/setup.sh GROUP` installs what a group needs; for --tests: `scripts/setup.sh core tests`.
# Example: scripts/build.sh --hardware
# Without a target it builds the core, which runs the case study, and all groups that were chosen in this call or
# before. To forget the groups: rm build/release/CMakeCache.txt
set -euo pipefail
cd "$(dirname "$0")/.."

groups=(hardware web pictures ros python)
options=()
targets=()
tests=false
chosen=(core)
choose() { options+=("-DCONSTRICTOR_${1^^}=ON"); chosen+=("$1"); }
for argument in "$@"; do
  case "$argument" in
    --help) sed -n '2,14s/^# //p' "$0"; exit 0 ;;
    --hardware|--web|--pictures|--ros|--python) choose "${argument#--}" ;;
    --all) for group in "${groups[@]}"; do choose "$group"; done ;;
    --tests) choose tests; tests=true ;;
    -*)
      echo "build: there is no option \"$argument\"; accepted: ${groups[*]/#/--} --all --tests" >&2
      exit 64
      ;;
    *) targets+=("$argument") ;;
  esac
done
if [ ${#targets[@]} -eq 0 ]; then
  if [ "$tests" = true ]; then targets=(all); else targets=(programs); fi
fi
if [ "${CI:-}" = true ]; then options+=(-DCONSTRICTOR_WERROR=ON); fi  # otherwise as the build tree was configured

log=$(mktemp)
cache=build/release/CMakeCache.txt
trap 'rm -f "$log" "$log.cache"' EXIT
echo "build: configuring"
if [ -f "$cache" ]; then cp "$cache" "$log.cache"; fi
if ! cmake --preset release "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  # A group whose packages are missing does not stay chosen.
  if [ -f "$log.cache" ]; then cp "$log.cache" "$cache"; else rm -f "$cache"; fi
  echo "build: configuring failed; if packages are missing, run: ./scripts/setup.sh ${chosen[*]}" >&2
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
