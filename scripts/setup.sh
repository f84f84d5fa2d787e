#!/usr/bin/env bash
# Installs the Debian 12 packages that Constrictor needs. Does nothing if they are all installed already.
# Usage: scripts/setup.sh [GROUP...]
#   core      (the default) what is needed to build and run the case study
#   hardware, web, pictures, ros, python
#             core, and what the programs of this group need (scripts/build.sh --help)
#   all       all of these: what all programs need
#   tests     what the tests and benchmarks need in addition to core, which is all, and Fast DDS with its Java runtime
#   tools     what formatting, static analysis and the documentation need in addition
#   bench     MuJoCo, with which a benchmark compares physics and rendering, and perf, which shows the CPU time by
#             groups of functions
#   browser   Chromium, for the long test of the dashboard's page
#   cluster   GNU parallel and Slurm, for scripts/evaluate_on_hosts.sh and scripts/evaluate_slurm.sh and their long test
#   package   what scripts/package.sh needs in addition to make Debian packages
#   boot      debootstrap and systemd-nspawn, for the long test of the service that starts at boot
# Example: scripts/setup.sh core tests
set -euo pipefail

core=(
  # build
  g++ cmake ninja-build ccache pkg-config
  # communication and messages
  cyclonedds-dev cyclonedds-tools libssl-dev libcereal-dev nlohmann-json3-dev
  # physics, rendering, vision, mathematics
  libode-dev libosmesa6-dev libopencv-core-dev libopencv-imgproc-dev libpng-dev libeigen3-dev
  # the figure of a run
  libcairo2-dev libpango1.0-dev fonts-dejavu-core
  # configuration, command line, text, logs
  libyaml-cpp-dev libcli11-dev libfmt-dev libspdlog-dev
  # checksums of checkpoints
  libxxhash-dev
  # recordings
  libzstd-dev zlib1g-dev
  # gamepads
  libevdev-dev
)
# real cameras: their streams, their pictures, their calibration; the web server of an emulated one
hardware=(libopencv-videoio-dev libopencv-imgcodecs-dev libopencv-calib3d-dev libboost-dev)
# the web server of the dashboard
web=(libboost-dev)
# films
pictures=(libopencv-videoio-dev)
ros=()  # the bridge contains the definitions of its messages
python=(python3-dev pybind11-dev python3-numpy)
all=("${hardware[@]}" "${web[@]}" "${pictures[@]}" "${ros[@]}" "${python[@]}")
# CPack finds the libraries of a program with these
package=(file dpkg-dev)
tests=(
  # the tests start the programs of all groups
  "${all[@]}"
  # a test makes and installs the Debian packages
  "${package[@]}"
  # GoogleTest and Google Benchmark
  libgtest-dev libbenchmark-dev
  # tests of the Python package, and of the manual pages
  python3-pytest mandoc
  # a terminal for `constrictor teleop`, shells for the completion of `constrictor`
  tmux zsh fish
  # runs on several hosts, made of network namespaces
  openssh-server openssh-client iproute2
  # another vendor's DDS
  libfastrtps-dev libfastcdr-dev fastddsgen
  # definitions of ROS messages, with which those of the bridge to ROS 2 are compared (0.4 MB in all)
  ros-std-msgs ros-geometry-msgs ros-sensor-msgs ros-nav-msgs ros-tf2-msgs ros-rosgraph-msgs ros-visualization-msgs
  ros-diagnostic-msgs
  # parsers of the robot's descriptions for ROS and Gazebo
  liburdfdom-dev liburdfdom-tools libsdformat-dev
  # elements of pipelines of GStreamer, for tests of video_capture (3 MB in all)
  gstreamer1.0-plugins-base
)
# The official reader of recordings is a package of npm. A Node.js from elsewhere brings its own npm.
command -v npm >/dev/null || tests+=(nodejs npm)
tools=(clang-format clang-tidy doxygen shellcheck)
bench=(libmujoco-dev linux-perf)
# for the long tests: the page of the dashboard
browser=(chromium)
# evaluations on several machines
cluster=(parallel slurm-wlm munge)
# a small Debian with a systemd of its own
boot=(debootstrap systemd-container)

accepted="core, hardware, web, pictures, ros, python, all, tests, tools, bench, browser, cluster, package, boot"
packages=()
for group in "${@:-core}"; do
  case "$group" in
    core) packages+=("${core[@]}") ;;
    hardware) packages+=("${core[@]}" "${hardware[@]}") ;;
    web) packages+=("${core[@]}" "${web[@]}") ;;
    pictures) packages+=("${core[@]}" "${pictures[@]}") ;;
    ros) packages+=("${core[@]}" "${ros[@]}") ;;
    python) packages+=("${core[@]}" "${python[@]}") ;;
    all) packages+=("${core[@]}" "${all[@]}") ;;
    tests) packages+=("${tests[@]}") ;;
    tools) packages+=("${tools[@]}") ;;
    bench) packages+=("${bench[@]}") ;;
    browser) packages+=("${browser[@]}") ;;
    cluster) packages+=("${cluster[@]}") ;;
    package) packages+=("${package[@]}") ;;
    boot) packages+=("${boot[@]}") ;;
    --help) sed -n '2,17s/^# //p' "$0"; exit 0 ;;
    *) echo "setup: there is no package group \"$group\"; accepted: $accepted" >&2; exit 64 ;;
  esac
done
mapfile -t packages < <(printf '%s\n' "${packages[@]}" | sort -u)

# dpkg-query fails if a package is unknown; its list of the installed ones is complete all the same.
installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
            sed -n 's/^installed //p' || true)
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
    echo "setup: sudo is not installed; run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
echo "setup: done"
