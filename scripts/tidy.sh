#!/usr/bin/env bash
# Analyses the C++ files with clang-tidy (.clang-tidy) and fails if there is a warning. Those in Eigen do not count.
# scripts/setup.sh core tests tools installs what it needs.
# Usage: scripts/tidy.sh [PATH PART...]
#   PATH PART   analyse only the files whose path contains one of these; without one, all files
# Example: scripts/tidy.sh components/control
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${1:-}" = --help ]; then sed -n '2,6s/^# //p' "$0"; exit 0; fi

# Files are analysed without precompiled headers: a missing #include is an error then.
cmake --preset tidy >/dev/null
cmake --build build/tidy --target constrictor_messages
parts=("${@:-/(components|sim|idl|tests|examples)/}")
# The static analyser follows our calls into Eigen and doubts values and memory that Eigen's templates handle. A finding
# whose place is a line of Eigen is left out with its notes. clang-tidy shows it although the header is a system header,
# because the notes name our files; NOLINT in our files has no effect on it.
status=0
run-clang-tidy -quiet -p build/tidy "${parts[@]}" 2>&1 | awk '
  { gsub(/\033\[[0-9;]*m/, "") }  # run-clang-tidy always asks for colours
  /(^|: )(fatal error|error|warning): / || /PLEASE submit a bug report|terminated by signal/ {
    eigen = /^[^ ]*\/eigen3\/[^ ]*: (error|warning): .*\[clang-analyzer-/
    if (eigen) ++left_out; else ++found
  }
  /^[^ ]*clang-tidy / || /^[0-9]+ warnings? / { eigen = 0 }  # the next file, or the end of one
  !eigen
  END {
    printf "tidy: %d findings; %d more in Eigen are left out\n", found, left_out
    exit found > 0 ? 1 : left_out > 0 ? 2 : 0
  }' || status=("${PIPESTATUS[@]}")
case "${status[*]}" in
  0 | "1 2") ;;  # nothing found; run-clang-tidy failed only because of what is left out
  *) exit 1 ;;
esac
