#!/usr/bin/env bash
# Analyses the C++ files with clang-tidy (.clang-tidy) and fails if there is a warning.
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
exec run-clang-tidy -quiet -p build/tidy "${parts[@]}"
