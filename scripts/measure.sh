# shellcheck shell=bash
# Sourced by gaits.sh, peg_fields.sh and sliding_mode.sh: builds and starts a program that measures in the simulated
# world.

# measure NAME ARGUMENTS: starts measure_NAME with --robot FILE and --output DIR, by default build/NAME. --help prints
# the comment at the beginning of the script.
measure() {
  local name=$1 options=() output root robots
  shift
  if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
  root=$(realpath "$(dirname "$0")/..")
  output=$root/build/$name
  robots=$root/components/lib/robot
  while [ $# -gt 0 ]; do
    case "$1" in
      --output|--robot) ;;
      *) echo "$name: there is no option \"$1\"; accepted: --output DIR, --robot ROBOT" >&2; exit 64 ;;
    esac
    if [ $# -lt 2 ]; then echo "$name: $1 needs a value (see --help)" >&2; exit 64; fi
    case "$1" in
      --output) output=$(realpath -m "$2") ;;
      --robot)
        if [ -f "$2" ]; then
          options+=(--robot "$(realpath "$2")")
        elif [ -f "$robots/$2.yaml" ]; then
          options+=(--robot "$robots/$2.yaml")
        else
          echo "$name: --robot: found '$2', accepted a robot file or one of $(basename -s .yaml "$robots"/*.yaml |
            paste -sd , | sed 's/,/, /g')" >&2
          exit 64
        fi
        ;;
    esac
    shift 2
  done
  cd "$root" || exit
  ./scripts/setup.sh core tests
  ./scripts/build.sh --tests "measure_$name"
  exec "build/release/bin/measure_$name" --output "$output" "${options[@]}"
}
