#!/usr/bin/env bash
# Analyses the C++ files with clang-tidy (.clang-tidy) and fails if there is a warning. Those in Eigen do not count.
# scripts/setup.sh core tests tools installs what it needs.
# Usage: scripts/tidy.sh [PATH PART...]
#   PATH PART   analyse only the files whose path contains one of these, each by itself, which also finds a missing
#               #include; without one, all files, up to 16 of a target as one, which takes a fraction of the time
# Example: scripts/tidy.sh components/control
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${1:-}" = --help ]; then sed -n '2,7s/^# //p' "$0"; exit 0; fi

# There are no precompiled headers, so that a file that is analysed by itself must include what it uses. Most of the
# time goes into the headers, which files that are compiled as one share. Such a unit includes .cpp files, which the
# check for suspicious includes would report.
if [ $# -gt 0 ]; then
  together=OFF
  options=()
  parts=("$@")
else
  together=ON
  options=(-checks=-bugprone-suspicious-include)
  # without the code that idlc and fastddsgen have generated
  parts=("$PWD/(build/tidy/)?(components|sim|idl|tests|examples)/(?!.*/generated/).*\.(cpp|cxx)$")
fi
cmake --preset tidy -DCONSTRICTOR_UNITY="$together" >/dev/null
cmake --build build/tidy --target generated_code
# The static analyser follows our calls into Eigen and doubts values and memory that Eigen's templates handle. A finding
# whose place is a line of Eigen is left out with its notes. clang-tidy shows it although the header is a system header,
# because the notes name our files; NOLINT in our files has no effect on it.
status=0
total=$(sed -n 's/^ *"file": "\(.*\)",*$/\1/p' build/tidy/compile_commands.json | sort -u |
  grep -cP "$(IFS='|'; echo "${parts[*]}")" || true)
if [ "$total" = 0 ]; then
  echo "tidy: no file that is compiled has a path that contains ${parts[*]}" >&2
  exit 64
fi
# Python would hold its output back, because a pipe reads it, and the progress would come in bursts.
PYTHONUNBUFFERED=1 run-clang-tidy -quiet -p build/tidy "${options[@]}" "${parts[@]}" 2>&1 | awk -v total="$total" '
  { gsub(/\033\[[0-9;]*m/, "") }  # run-clang-tidy always asks for colours
  /^[^ ]*clang-tidy[^ ]* -/ { printf "[%d/%d] %s\n", ++files, total, $NF; fflush(); eigen = 0; next }
  /(^|: )(fatal error|error|warning): / || /PLEASE submit a bug report|terminated by signal/ {
    eigen = /^[^ ]*\/eigen3\/[^ ]*: (error|warning): .*\[clang-analyzer-/
    if (eigen) ++left_out; else ++found
  }
  /^[0-9]+ (warnings?|errors?) / { eigen = 0; next }  # the end of a file, with the findings that do not count
  !eigen { print; fflush() }
  END {
    printf "tidy: %d findings; %d more in Eigen are left out\n", found, left_out
    exit found > 0 ? 1 : left_out > 0 ? 2 : 0
  }' || status=("${PIPESTATUS[@]}")
case "${status[*]}" in
  0 | "1 2") ;;  # nothing found; run-clang-tidy failed only because of what is left out
  *) exit 1 ;;
esac
