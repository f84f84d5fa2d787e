#!/usr/bin/env bash
# Formats all C++ files with clang-format (.clang-format). scripts/setup.sh tools installs it.
# Usage: scripts/format.sh [--check]
#   --check   change nothing; list the files that are not formatted and exit with status 1 if there are any
set -euo pipefail
cd "$(dirname "$0")/.."

options=(-i)
case "${1:-}" in
  "") ;;
  --check) options=(--dry-run --Werror) ;;
  --help) sed -n '2,4s/^# //p' "$0"; exit 0 ;;
  *) echo "format: there is no option \"$1\"; accepted: --check" >&2; exit 64 ;;
esac

# Another version of clang-format would format some lines in another way.
version=$(clang-format --version 2>/dev/null | sed -n 's/.*version \([0-9]*\).*/\1/p')
if [ "$version" != 14 ]; then
  echo "format: clang-format 14 is needed, found \"${version:-none}\" (Debian 12: scripts/setup.sh tools)" >&2
  exit 69
fi

find idl components sim tests examples \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
  if ! xargs -0 -n 16 -P "$(nproc)" clang-format "${options[@]}"; then
    echo "format: the files above are not formatted; run scripts/format.sh" >&2
    exit 1
  fi
