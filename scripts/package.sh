#!/usr/bin/env bash
# Makes the Debian packages constrictor, constrictor-dev and python3-constrictor in build/packages. Installs what the
# build needs.
# Usage: scripts/package.sh
# Then: apt install ./build/packages/constrictor_*.deb
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${1:-}" = --help ]; then sed -n '2,5s/^# //p' "$0"; exit 0; fi
if [ $# -gt 0 ]; then echo "package: there is no option \"$1\"; accepted: --help" >&2; exit 64; fi

scripts/setup.sh all package
scripts/build.sh --all
rm -rf build/packages
echo "package: packing"
cpack --config build/release/CPackConfig.cmake -B build/packages >build/release/cpack.log || {
  cat build/release/cpack.log >&2
  exit 1
}
rm -rf build/packages/_CPack_Packages
ls build/packages/*.deb
