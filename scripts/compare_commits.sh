#!/usr/bin/env bash
# Compares this build with that of another commit: missions in turn, with their speed, CPU time and memory.
# Usage: scripts/compare_commits.sh [OPTION...] [COMMIT] [-- RUN ARGUMENT...]
#   COMMIT              what to compare with (default: 61916b1, the commit from which performance is counted). It is
#                       built in build/compare/COMMIT, with the packages that its scripts/setup.sh installs; that takes
#                       some minutes the first time
#   --runs N            runs of each of the two under each condition (default: 3)
#   --conditions C,...  of quiet, loaded (a busy loop on each core) and one_core (default: all three)
#   --output DIR        results: comparison.md, comparison.json and the reports (default: build/compare/results)
#   --programs DIR      programs of the other commit that are built already, instead of COMMIT
#   RUN ARGUMENT        what `constrictor run` gets (default: case_study --seed 1)
# Example: scripts/compare_commits.sh --runs 2 --conditions quiet HEAD~10 -- line
# Nothing else should run meanwhile. Ctrl-C ends the run that is going on.
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '2,/^[^#]/s/^# //p' "$0"; exit 0; fi
root=$(cd "$(dirname "$0")/.." && pwd)
fail() { echo "compare_commits: $1" >&2; exit 64; }

commit="" programs="" output=$root/build/compare/results options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  case "$1" in
    --runs|--conditions|--output|--programs)
      if [ $# -lt 2 ]; then fail "$1 needs a value (see --help)"; fi
      case "$1" in
        --output) output=$(realpath -m "$2") ;;
        --programs) programs=$(realpath -m "$2") ;;
        *) options+=("$1" "$2") ;;
      esac
      shift 2
      ;;
    -*) fail "there is no option \"$1\"; accepted: --runs, --conditions, --output, --programs" ;;
    *)
      if [ -n "$commit" ]; then fail "found the commits $commit and $1, accepted one"; fi
      commit=$1
      shift
      ;;
  esac
done
if [ "${1:-}" = -- ]; then shift; fi
compare() {
  /usr/bin/python3 "$root/tests/bench/commits/measure.py" --old "$programs/constrictor" \
    --new "$root/build/release/bin/constrictor" --output "$output" "${options[@]}" "$@"
}
compare --names a b --check
if [ -n "$commit" ] && [ -n "$programs" ]; then fail "found $commit and --programs, accepted one of them"; fi

if [ -n "$programs" ]; then
  name=$programs
  if [ ! -x "$programs/constrictor" ]; then fail "--programs: there is no program $programs/constrictor"; fi
else
  commit=${commit:-61916b1}
  name=$(git -C "$root" rev-parse --short --verify --quiet "$commit^{commit}") ||
    fail "there is no commit $commit; a shallow clone gets it by: git fetch --unshallow"
  tree=$root/build/compare/$name
  git -C "$root" worktree prune
  if [ ! -e "$tree/.git" ]; then git -C "$root" worktree add --detach "$tree" "$name"; fi
  echo "compare_commits: building $name in $tree"
  # An older script builds everything, with the tests; the programs of a run are enough.
  (cd "$tree" && ./scripts/setup.sh && cmake --preset release >/dev/null)
  of_runs='constrictor|constrictor_host|physics|camera|perception|guidance|navigation|control|planner|input|report'
  mapfile -t targets < <(ninja -C "$tree/build/release" -t targets all |
    sed -n 's/^\([a-z_]*\): phony$/\1/p' | grep -xE "$of_runs|overview")
  cmake --build "$tree/build/release" --target "${targets[@]}"
  programs=$tree/build/release/bin
fi
(cd "$root" && ./scripts/setup.sh core && ./scripts/build.sh)
compare --names "$name" "$(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo here)" -- "$@"
