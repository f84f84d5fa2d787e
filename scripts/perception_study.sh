#!/usr/bin/env bash
# Measures how well missions succeed when the camera and perception become worse, and draws the curves.
# Usage: scripts/perception_study.sh [OPTION...] [-- EVALUATE ARGUMENT...]
#   --quick           a short scenario and two seeds: half an hour on two cores instead of some hours
#   --seeds N         missions of each level, with the seeds 1 to N (default: 5)
#   --only NAME,...   only these errors (default: all of tests/bench/perception_study/factors.yaml)
#   --scenario NAME   (default: case_study)
#   --output DIR      folder of the study (default: build/perception_study); the same command continues it
#   --time-limit S    simulated seconds after which a mission has failed (default: 450; with --quick 240)
#   --jobs N          missions at a time (default: as many as there are processor cores)
#   --programs DIR    use the programs in this folder instead of building them
#   --factors FILE    another file of errors and levels
#   EVALUATE ARGUMENT what `constrictor evaluate` gets in addition, for example --robot FILE
# Example: scripts/perception_study.sh --only blur,late --seeds 20
# It does the first seed of all errors, then the second one, and so on, and writes study.png, study.svg, study.csv and
# study.md after each seed: Ctrl-C at any time leaves curves of what is done. Exit status: 0; 1 if missions ended with
# an error; 64 wrong option; 69 a program is missing; 74 the disk is full or a file cannot be written; 78 a file is
# wrong; 130 Ctrl-C. A study whose first evaluation is refused leaves nothing behind.
set -euo pipefail

fail() { echo "perception_study: $2" >&2; exit "$1"; }
whole() { [[ "$2" =~ ^[1-9][0-9]{0,4}$ ]] || fail 64 "$1: found $2, accepted a whole number from 1"; }
source=$(realpath "$(dirname "$0")/..")
seeds="" only="" scenario="" output="" jobs="" programs="" quick="" limit=""
factors=$source/tests/bench/perception_study/factors.yaml
more=()
while [ $# -gt 0 ]; do
  case "$1" in
    --help) sed -n '2,19s/^# //p' "$0"; exit 0 ;;
    --quick) quick=1; shift; continue ;;
    --) shift; more=("$@"); break ;;
    --seeds|--only|--scenario|--output|--time-limit|--jobs|--programs|--factors) ;;
    *)
      fail 64 "there is no option \"$1\"; accepted: --quick, --seeds, --only, --scenario, --output, --time-limit, \
--jobs, --programs, --factors, --"
      ;;
  esac
  if [ $# -lt 2 ] || [ -z "$2" ]; then fail 64 "$1 needs a value (see --help)"; fi
  case "$1" in
    --seeds) whole --seeds "$2"; seeds=$2 ;;
    --jobs) whole --jobs "$2"; jobs=$2 ;;
    --time-limit) whole --time-limit "$2"; limit=$2 ;;
    --only) only=$2 ;;
    --scenario) scenario=$2 ;;
    --output) output=$(realpath -m "$2") ;;
    --programs) programs=$(realpath -m "$2") ;;
    --factors) factors=$(realpath -m "$2") ;;
  esac
  shift 2
done
for word in "${more[@]}"; do
  case "$word" in
    --output*|--seeds*|--vary*|--shard*|--merge*|--jobs*|--max-sim-time*) fail 64 "$word belongs to this script" ;;
  esac
done
seeds=${seeds:-$([ -n "$quick" ] && echo 2 || echo 5)}
scenario=${scenario:-$([ -n "$quick" ] && echo short || echo case_study)}
limit=${limit:-$([ -n "$quick" ] && echo 240 || echo 450)}
output=${output:-$source/build/perception_study}
jobs=${jobs:-$(nproc)}

# Wrong names are refused before the programs are built, which takes minutes. The programs check files and names, too.
[ -r "$factors" ] || fail 64 "--factors: cannot read $factors"
known=$(grep -oP "\bname[\"']?:\s*[\"']?\K[\w.-]+" "$factors" || true)
IFS=, read -r -a only_names <<<"$only"
for name in "${only_names[@]}"; do
  if [ -n "$known" ] && ! grep -qxF -e "$name" <<<"$known"; then
    fail 64 "--only: found '$name', accepted $(paste -sd , <<<"$known" | sed 's/,/, /g')"
  fi
done
scenarios=${CONSTRICTOR_DATA:-$source}/sim/scenarios
if [ -z "$programs" ] && [ -d "$scenarios" ] && [ ! -f "$scenario" ] && [ ! -f "$scenarios/$scenario.yaml" ]; then
  fail 64 "--scenario: found '$scenario', accepted a file or one of $(basename -s .yaml "$scenarios"/*.yaml |
    paste -sd , | sed 's/,/, /g')"
fi

if [ -z "$programs" ]; then
  "$source/scripts/setup.sh" core tests
  "$source/scripts/build.sh" --tests programs draw_perception_study
  programs=$source/build/release/bin
fi
for program in constrictor draw_perception_study; do
  [ -x "$programs/$program" ] ||
    fail 69 "$programs/$program is missing: build it with scripts/build.sh --tests $program"
done
table=$("$programs/draw_perception_study" --factors "$factors" --list) || exit 64
if [ -n "$only" ]; then
  chosen=""
  for name in "${only_names[@]}"; do
    row=$(awk -F '\t' -v name="$name" '$1 == name' <<<"$table")
    [ -n "$row" ] ||
      fail 64 "--only: found '$name', accepted $(cut -f 1 <<<"$table" | paste -sd , | sed 's/,/, /g')"
    chosen+=$row$'\n'
  done
  table=${chosen%$'\n'}
fi
made=""
[ -e "$output" ] || made=1
mkdir -p "$output" 2>/dev/null || fail 74 "--output: cannot make the folder $output"
[ -w "$output" ] || fail 74 "--output: cannot write into $output"

# A study is continued only with the scenario and the arguments with which it began; seeds and errors may be added.
# `constrictor evaluate` checks the files and the programs.
what="$scenario --time-limit $limit ${more[*]}"
if [ -e "$output/study.conf" ] && [ "$(cat "$output/study.conf")" != "$what" ]; then
  fail 64 "--output: $output holds a study of '$(cat "$output/study.conf")', not of '$what'; choose another folder"
fi
begins=""
[ -e "$output/study.conf" ] || begins=1
echo "$what" >"$output/study.conf" || fail 74 "cannot write into $output"

levels=$(($(cut -f 2 <<<"$table" | paste -sd +)))
all=$(((levels + 1) * seeds))
count_done() {
  local total=0 name
  while IFS=$'\t' read -r name _; do
    if [ -d "$output/$name/runs" ]; then
      # A study that had more seeds before keeps them; they do not count now.
      total=$((total + $(find "$output/$name/runs" -maxdepth 3 -name outcome.json -printf '%h\n' |
        sed 's/.*seed_0*//' | awk -v last="$seeds" '$1 <= last' | wc -l)))
    fi
  done < <(printf 'reference\t0\n%s\n' "$table")
  echo "$total"
}
before=$(count_done) begin=$SECONDS
progress() {
  local done_now left=""
  done_now=$(count_done)
  if [ "$done_now" -gt "$before" ]; then
    left=", about $(((SECONDS - begin) * (all - done_now) / (done_now - before) / 60 + 1)) min left"
    if [ "$done_now" -ge "$all" ]; then left=""; fi
  fi
  echo "perception_study: $done_now of $all missions done$left"
}
draw() {
  local title="Missions with worse and worse perception: scenario $scenario, seeds 1 to $1"
  "$programs/draw_perception_study" --factors "$factors" --draw "$output" --title "$title" ||
    fail 74 "the curves could not be written into $output"
}
# Removes what a study has left whose first evaluation was refused, so that the corrected command may use the folder.
forget_study() {
  cat "$output/$1.log" >&2
  rm -f "$output/$1.log" "$output/study.conf"
  if [ -d "$output/$1" ]; then rmdir --ignore-fail-on-non-empty "$output/$1"; fi
  if [ -n "$made" ]; then rmdir --ignore-fail-on-non-empty "$output"; fi
}
interrupted="" child="" errors=0
# The evaluation stops its missions and keeps those that are done. It runs in the background, because bash would
# otherwise carry out the trap only after its end; in the background it ignores Ctrl-C, so that SIGTERM is sent to it.
trap 'interrupted=1; if [ -n "$child" ]; then kill -TERM "$child" 2>/dev/null || true; fi' INT TERM
# evaluate_factor NAME LAST_SEED [SETTING...]
evaluate_factor() {
  local name=$1 last=$2 status=0 vary=()
  shift 2
  for setting in "$@"; do vary+=(--vary "$setting"); done
  if [ "$(df --output=avail -m "$output" | tail -1)" -lt 100 ]; then
    fail 74 "less than 100 MB are free on the disk of $output; make room, then the same command goes on"
  fi
  "$programs/constrictor" evaluate "$scenario" --seeds "1..$last" "${vary[@]}" --jobs "$jobs" --keep none \
    --max-sim-time "$limit" "${more[@]}" --output "$output/$name" >"$output/$name.log" 2>&1 &
  child=$!
  while true; do  # a signal ends the first wait, not the evaluation
    status=0
    wait "$child" || status=$?
    kill -0 "$child" 2>/dev/null || break
  done
  child=""
  if [ -n "$interrupted" ] || [ "$status" -ge 128 ]; then
    progress
    echo "perception_study: interrupted; the same command goes on (folder: $output)" >&2
    exit 130
  fi
  # An evaluation that was refused as a whole has made no page.
  if [ -n "$begins" ] && [[ "$status" =~ ^(64|78)$ ]] && [ ! -e "$output/$name/index.html" ]; then
    forget_study "$name"
    fail "$status" "the first evaluation was refused, so that the study has not begun; correct the command"
  fi
  begins=""
  case "$status" in
    0) ;;
    70) errors=$((errors + 1)) ;;
    *) tail -n 3 "$output/$name.log" >&2
       fail "$status" "the evaluation of $name ended with status $status; its log is $output/$name.log" ;;
  esac
}
echo "perception_study: $all missions of $scenario, $jobs at a time, in $output"
for seed in $(seq 1 "$seeds"); do
  evaluate_factor reference "$seed"
  while IFS=$'\t' read -r name _ settings <&3; do
    IFS=$'\t' read -r -a words <<<"$settings"
    evaluate_factor "$name" "$seed" "${words[@]}"
    echo -n "seed $seed, $name: "
    progress
  done 3<<<"$table"
  draw "$seed"
done
echo "perception_study: $output/study.png, study.svg, study.csv and study.md"
if [ "$errors" -gt 0 ]; then
  fail 1 "some missions ended with an error (run.log in their folders); the same command does them again"
fi
