#!/usr/bin/env bash
# Builds the pages of the public headers into build/docs/html with Doxygen. scripts/setup.sh tools installs it.
# Usage: scripts/docs.sh
# A warning, for example about a parameter that does not exist, makes it exit with status 1.
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${1:-}" = --help ]; then sed -n '2,4s/^# //p' "$0"; exit 0; fi
mkdir -p build/docs
doxygen Doxyfile
echo "docs: build/docs/html/index.html"
