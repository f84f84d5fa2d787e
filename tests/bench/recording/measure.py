"""Processor time of runs with and without a recording; see scripts/bench_recording.sh."""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py

KINDS = {"none": [], "off": ["--record", "--images", "off"], "recompute": ["--record", "--images", "recompute"],
         "on": ["--record", "--images", "on"]}
GOALS = {"off": "1.05", "recompute": "1.05", "on": "1.20"}


def kinds(text):
    chosen = text.split(",")
    for kind in chosen:
        if kind not in KINDS:
            raise argparse.ArgumentTypeError(f"found '{kind}', accepted {', '.join(KINDS)}")
    return chosen


def parse():
    parser = argparse.ArgumentParser(prog="bench_recording", add_help=False)
    parser.add_argument("--seconds", type=whole(1), default=40)
    parser.add_argument("--rounds", type=whole(1), default=5)
    parser.add_argument("--kinds", type=kinds, default=list(KINDS))
    parser.add_argument("--scenario", default="case_study")
    parser.add_argument("--programs", required=True)
    return parser.parse_args()


def run(options, kind, folder, environment):
    """One run: the processor time [s] of all processes, that of the plant, the size of the recording, the state."""
    report_dir = os.path.join(folder, "report")
    command = [os.path.join(options.programs, "constrictor"), "run", options.scenario, "--seed", "1",
               "--max-sim-time", str(options.seconds), "--report", report_dir, *KINDS[kind]]
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        with open(os.path.join(report_dir, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
    except (OSError, ValueError):
        sys.exit(f"bench_recording: the run has no report (exit status {done.returncode}):\n{done.stdout}")
    if kind != "none" and not report["recording"]["proven_complete"]:
        sys.exit(f"bench_recording: the recording is not complete: {report['recording']['text']}")
    all_s = sum(process["cpu_s"] for process in report["processes"])
    plant_s = sum(process["cpu_s"] for process in report["processes"] if "physics" in process["name"].split(","))
    size = os.path.getsize(os.path.join(report_dir, "run.mcap")) if kind != "none" else 0
    shutil.rmtree(report_dir)
    return all_s, plant_s, size, report["state_hash"]


def main():
    options = parse()
    results = {kind: [] for kind in options.kinds}
    states = set()
    with tempfile.TemporaryDirectory() as folder:
        # A registry of its own: no other run of this host is meant.
        environment = {**os.environ, "XDG_RUNTIME_DIR": folder}
        for number in range(options.rounds):
            turn = number % len(options.kinds)
            for kind in options.kinds[turn:] + options.kinds[:turn]:
                all_s, plant_s, size, state = run(options, kind, folder, environment)
                results[kind].append((all_s, plant_s, size))
                states.add(state)
                with open("/proc/loadavg", encoding="ascii") as file:
                    load = file.read().split()[0]
                print(f"round {number + 1}, {kind:<9}  {all_s:6.2f} s, of which the plant's process {plant_s:5.2f} s"
                      f"  (load {load})", flush=True)
    if len(states) != 1:
        sys.exit(f"bench_recording: the runs have {len(states)} state hashes, accepted one")
    print(f"\nmedians of {options.rounds} alternating runs of {options.seconds} simulated s; equal state hashes")
    print("| images | processor time [s] | smallest [s] | of the plant's process [s] | ratio of medians "
          "| ratio of smallest | goal | MB per simulated minute |")
    print("|---|---|---|---|---|---|---|---|")
    reference = results.get("none")
    for kind, rows in results.items():
        median = statistics.median(row[0] for row in rows)
        least = min(row[0] for row in rows)
        ratios = ["", ""]
        if reference and kind != "none":
            ratios = [f"{median / statistics.median(row[0] for row in reference):.3f}",
                      f"{least / min(row[0] for row in reference):.3f}"]
        megabytes = rows[0][2] * 1e-6 * 60 / options.seconds
        print(f"| {'no recording' if kind == 'none' else kind} | {median:.2f} | {least:.2f} | "
              f"{statistics.median(row[1] for row in rows):.2f} | {ratios[0]} | {ratios[1]} | {GOALS.get(kind, '')} | "
              f"{'' if kind == 'none' else f'{megabytes:.1f}'} |")


main()
