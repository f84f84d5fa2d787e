# shellcheck shell=bash
# Sourced by gaits.sh, peg_fields.sh and sliding_mode.sh: builds and starts a program that measures in the simulated
# world.

# measure NAME ARGUMENTS: starts measure_NAME with --robot FILE and --output DIR, by default build/NAME. --help prints
# the comment at the beginning of the script.
measure() {
  local name=$1 options=() output
  shift
  if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
  output=$(realpath -m "$(dirname "$0")/../build/$name")
  while [ $# -gt 0 ]; do
    case "$1" in --output|--robot) ;; *) echo "$name: unknown option $1 (see --help)" >&2; exit 64 ;; esac
    if [ $# -lt 2 ]; then echo "$name: $1 needs a value (see --help)" >&2; exit 64; fi
    case "$1" in
      --output) output=$(realpath -m "$2") ;;
      --robot) options+=(--robot "$(realpath "$2")") ;;
    esac
    shift 2
  done
  cd "$(dirname "$0")/.." || exit
  ./scripts/setup.sh core tests
  ./scripts/build.sh --tests "measure_$name"
  exec "build/release/bin/measure_$name" --output "$output" "${options[@]}"
}
