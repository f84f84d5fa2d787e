"""CPU time of the case study by process and by groups of functions; prints JSON. See scripts/bench.sh.

The program perf (Debian's linux-perf) samples all processes of a run by the CPU time that they use. A sample in a
library of the system counts for that library. A sample in this project's own code counts for the folder whose static
library defines the function; functions that several folders define (templates and inline functions) are a group of
their own. Without perf, the JSON says in `missing` why, and the exit status is 0.
Usage: measure.py [--build DIR] [--seconds S] [--rate HZ]
  --build DIR    folder of the build (default: build/release)
  --seconds S    simulated time of the run (default: 40)
  --rate HZ      samples in a second of CPU time (default: 997)
"""
import argparse
import collections
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py

ROOT = Path(__file__).resolve().parents[3]
PATIENCE_S = 300  # for the run
SAMPLE = re.compile(r"^\s*(?P<comm>.+?)\s+(?P<pid>\d+)/(?P<tid>\d+)\s+[0-9a-f]+ (?P<symbol>.*) \((?P<file>.*)\)$")
# The groups of the system's libraries: the beginnings of their names.
LIBRARIES = {
    "kernel": ["[kernel", "[guest.kernel"],
    "Cyclone DDS": ["libddsc", "libcyclonedds", "libiceoryx"],
    "C library": ["libc.so", "libpthread", "[vdso]"],
    "mathematical library": ["libm.so"],
    "C++ library": ["libstdc++", "libgcc_s"],
    "dynamic linker": ["ld-linux"],
    "Mesa and LLVM": ["libOSMesa", "libglapi", "libGL", "libLLVM", "[unknown]", "//anon", "perf-", "anon_inode"],
    "OpenCV": ["libopencv"],
    "OpenSSL (SHA-256)": ["libcrypto"],
    "drawing the figure": ["libcairo", "libpango", "libfreetype", "libfontconfig", "libpng", "libz.", "libpixman",
                           "libharfbuzz", "libglib"],
}


def why_not():
    """Why perf cannot sample here; empty if it can."""
    if shutil.which("perf") is None:
        return "the program perf is not installed (scripts/setup.sh bench)"
    with tempfile.NamedTemporaryFile() as file:
        tried = subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-o", file.name, "--", "true"], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if tried.returncode == 0:
        return ""
    lines = [line.strip() for line in tried.stdout.splitlines() if line.strip()]
    return (f"perf cannot sample on this machine: {lines[0] if lines else tried.returncode} (as root: "
            "sysctl kernel.perf_event_paranoid=1)")


def folders_of_symbols(build):
    """The folder of each function that a static library defines; None if several folders define it."""
    folders = {}
    for library in sorted(build.glob("**/lib*.a")):
        folder = str(library.parent.relative_to(build))
        listed = subprocess.run(["nm", "--defined-only", "--format=posix", library], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        for line in listed.stdout.splitlines():
            fields = line.split()
            if len(fields) >= 2 and fields[1] in "tTwWuV":
                known = folders.setdefault(fields[0], folder)
                if known != folder:
                    folders[fields[0]] = None
    return folders


def group_of(symbol, file, folders, build):
    name = os.path.basename(file) if file.startswith("/") and not file.startswith("//") else file
    if str(build) in file:
        symbol = symbol.split("+0x")[0]
        folder = folders.get(symbol, "programs")
        if folder is not None:
            return folder
        return "templates and inline functions"
    for group, beginnings in LIBRARIES.items():
        if any(name.startswith(beginning) for beginning in beginnings):
            return group
    return "other libraries"


def read_samples(data, build):
    """Numbers of samples by process and group. A process has the name of its first thread."""
    script = subprocess.run(["perf", "script", "-i", data, "--no-demangle", "-F", "comm,pid,tid,ip,sym,dso"], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    folders = folders_of_symbols(build)
    names = {}
    samples = collections.defaultdict(collections.Counter)
    for line in script.stdout.splitlines():
        match = SAMPLE.match(line)
        if not match:
            continue
        if match["pid"] == match["tid"]:
            names[match["pid"]] = match["comm"]
        samples[match["pid"]][group_of(match["symbol"], match["file"], folders, build)] += 1
    by_name = collections.defaultdict(collections.Counter)
    for pid, counted in samples.items():
        by_name[names.get(pid, "others")].update(counted)
    return by_name


def measure(options):
    build = Path(options.build).resolve()
    command = build / "bin" / "constrictor"
    if not os.access(command, os.X_OK):
        sys.exit(f"profile: there is no program {command}; run: ./scripts/build.sh")
    missing = why_not()
    if missing:
        return {"missing": missing}
    with tempfile.TemporaryDirectory() as folder:
        data = os.path.join(folder, "perf.data")
        report = os.path.join(folder, "report")
        run = ["perf", "record", "-q", "-e", "cpu-clock", "-F", str(options.rate), "-o", data, "--", str(command),
               "run", "case_study", "--seed", "1", "--max-sim-time", str(options.seconds), "--report", report]
        try:
            subprocess.run(run, env={**os.environ, "XDG_RUNTIME_DIR": folder}, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, timeout=PATIENCE_S)
            with open(os.path.join(report, "report.json"), encoding="utf-8") as file:
                simulated_s = json.load(file)["sim_time_s"]
            if simulated_s <= 0.0:
                raise ValueError("it made no tick")
            samples = read_samples(data, build)
        except (OSError, ValueError, KeyError, subprocess.SubprocessError) as error:
            # A case study that fails without perf, too, fails in the next step of scripts/bench.sh.
            return {"missing": f"the run under perf failed ({error}); try: {' '.join(run)}"}
    ms = 1e3 / options.rate / simulated_s
    return {"simulated_s": simulated_s, "samples": sum(sum(counted.values()) for counted in samples.values()),
            "cpu_ms_per_s": {name: {group: ms * number for group, number in counted.items()}
                             for name, counted in samples.items()}}


def main():
    parser = argparse.ArgumentParser(prog="profile", description=__doc__.splitlines()[0])
    parser.add_argument("--build", default=str(ROOT / "build" / "release"))
    parser.add_argument("--seconds", type=whole(5), default=40)
    parser.add_argument("--rate", type=whole(50), default=997)
    print(json.dumps(measure(parser.parse_args()), indent=2))


main()
