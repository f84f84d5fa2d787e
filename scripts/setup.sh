#!/usr/bin/env bash
# Installs what Constrictor needs to build and run on Debian 12. Does nothing, at once, when all of it is there.
# Usage: scripts/setup.sh [--fast-dds]
#   --fast-dds   also Fast DDS, for the tests and the example with another vendor's DDS (40 MB and a Java runtime)
# Neither installs clang-tidy: only the CMake preset `tidy` needs it, which no script uses.
set -euo pipefail

packages=(
  # build
  g++ cmake ninja-build ccache pkg-config binutils
  # communication and messages
  cyclonedds-dev cyclonedds-tools libssl-dev libcereal-dev nlohmann-json3-dev
  # physics, rendering, vision, mathematics
  libode-dev libosmesa6-dev libopencv-dev libeigen3-dev
  # configuration, command line, text, logs
  libyaml-cpp-dev libcli11-dev libfmt-dev libspdlog-dev
  # tests and benchmarks
  libgtest-dev libgmock-dev libbenchmark-dev tmux zsh fish
)

if [ "${1:-}" = --fast-dds ]; then
  packages+=(libfastrtps-dev libfastcdr-dev fastddsgen fastdds-tools)
fi

# dpkg-query fails when a package is unknown; what counts is what it lists as installed.
installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null | sed -n 's/^installed //p' || true)
missing=()
for package in "${packages[@]}"; do
  grep -Fqx "$package" <<<"$installed" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "setup: installing ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: these packages are missing and there is no sudo; as root, run: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
echo "setup: done"
