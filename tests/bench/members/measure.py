"""What a tick costs with 2 to 32 members, each in a process of its own on Cyclone DDS; prints JSON like that of Google
Benchmark, so that bench_table fits the exponent. See scripts/bench.sh.

The members read the joints and write nothing: what remains are the barrier's messages, the wake-ups and the runtime.
Usage: measure.py [--program FILE] [--sizes N,N] [--ticks N]
  --program FILE  the program bench_members (default: build/release/bin/bench_members)
  --sizes N,N     numbers of members, the plant included (default: 2,8,16,32)
  --ticks N       measured ticks with 32 members, and as many times more as there are fewer members; in five parts, of
                  which the median counts (default: 500)
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py

ROOT = Path(__file__).resolve().parents[3]
SETTLE_TICKS = 200  # before the first measured one
PARTS = 5
PATIENCE_S = 120  # for one run


def sizes(text):
    return [whole(2, 100)(size) for size in text.split(",")]


def cpu_s(processes):
    """Processor time of all threads of the processes: the first number of schedstat, in ns."""
    total_ns = 0
    for process in processes:
        for stat in Path(f"/proc/{process.pid}/task").glob("*/schedstat"):
            total_ns += int(stat.read_text(encoding="ascii").split()[0])
    return 1e-9 * total_ns


def wake_ups(processes):
    """How often threads of the processes have waited and were woken."""
    total = 0
    for process in processes:
        for status in Path(f"/proc/{process.pid}/task").glob("*/status"):
            for line in status.read_text(encoding="ascii").splitlines():
                if line.startswith("voluntary_ctxt_switches:"):
                    total += int(line.split()[1])
    return total


def measure(program, members, measured, folder):
    """The processor time of a tick [s], each of PARTS times, and the wake-ups of a tick."""
    names = ["physics", *(f"member_{i}" for i in range(1, members))]
    marks = [SETTLE_TICKS + measured * part // PARTS for part in range(PARTS + 1)]
    environment = {**os.environ, "XDG_RUNTIME_DIR": folder}
    domain = str(101 + os.getpid() % 99)  # the launcher claims those up to 100
    processes = []
    times, wakes = [], []
    errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8")
    try:
        for name in names:
            arguments = [program, name, "--domain", domain, "--roster", ",".join(names), "--robot", "", "--patience",
                         str(PATIENCE_S)]
            if name == "physics":
                arguments += ["--max-sim-time", str(0.02 * (marks[-1] + 200)), "--output", folder]
            processes.append(subprocess.Popen(arguments, env=environment, text=True, stderr=errors,
                                              stdout=subprocess.PIPE if name == "member_1" else subprocess.DEVNULL))
        late = threading.Timer(PATIENCE_S, processes[1].kill)
        late.daemon = True  # Ctrl-C must not wait for it
        late.start()
        try:
            for line in processes[1].stdout:
                if line.startswith("tick ") and int(line.split()[1]) in marks:
                    times.append(cpu_s(processes))
                    wakes.append(wake_ups(processes))
        finally:
            late.cancel()
        if len(times) == len(marks):
            for process in processes:
                process.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        pass  # the exit statuses show it
    finally:
        for process in processes:
            if process.poll() is None:
                process.kill()
                process.wait()
    statuses = [process.returncode for process in processes]
    if len(times) != len(marks) or any(statuses):
        errors.seek(0)
        last = "".join(errors.readlines()[-5:])
        sys.exit(f"members: the run with {members} members has not ended by itself within {PATIENCE_S} s (exit "
                 f"statuses {statuses}); run it again with fewer --sizes or --ticks. Its last messages:\n{last}")
    return ([(after - before) * PARTS / measured for before, after in zip(times, times[1:])],
            (wakes[-1] - wakes[0]) / measured)


def main():
    parser = argparse.ArgumentParser(prog="members", description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "bin" / "bench_members"))
    parser.add_argument("--sizes", type=sizes, default=[2, 8, 16, 32])
    parser.add_argument("--ticks", type=whole(500, 10000, 500), default=500)
    options = parser.parse_args()
    if not os.access(options.program, os.X_OK):
        sys.exit(f"members: there is no program {options.program}; run: ./scripts/build.sh --tests bench_members")
    results = []
    with tempfile.TemporaryDirectory() as folder:  # a registry of its own: no other run of this host is meant
        for size in options.sizes:
            measured = 500 * max(1, options.ticks * 32 // size // 500)  # a short run would end while its times are read
            tick_s, woken = measure(options.program, size, measured, folder)
            results.append({"name": f"processes/{size}", "run_type": "iteration", "time_unit": "ms",
                            "iterations": measured, "cpu_time": 1e3 * statistics.median(tick_s),
                            "members": size, "wake_ups_per_tick": woken, "parts": [1e3 * part for part in tick_s]})
    print(json.dumps({"benchmarks": results}, indent=2))


main()
