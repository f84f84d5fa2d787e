"""Runs a mission with two builds in turn and compares speed, CPU time and memory. See scripts/compare_commits.sh.

Machines differ by a factor of two in speed, and a shared one changes from minute to minute. Therefore the two builds
take turns, and the ratio of each condition is that of the medians of its runs.
"""
import argparse
import ctypes
import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py
from ending import end_in_order  # noqa: E402  tests/bench/ending.py

CONDITIONS = {
    "quiet": "all cores, nothing else started",
    "loaded": "a busy loop beside it on each core",
    "one_core": "the first core only (taskset -c 0)",
}
PATIENCE_S = 3600  # for a run
LEAVE_S = 30  # for a run that was interrupted


def die_with_parent():
    """In a new process: it ends when this program is killed."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print(f"compare_commits: {message} (see scripts/compare_commits.sh --help)", file=sys.stderr)
        sys.exit(64)


class Loops:
    """Busy loops, one for each core, as long as the `with` block lasts."""

    def __init__(self, wanted):
        self.cores = os.sched_getaffinity(0) if wanted else []

    def __enter__(self):
        loop = [sys.executable, "-c", "while True: pass"]
        self.loops = [subprocess.Popen(loop, preexec_fn=die_with_parent) for _ in self.cores]

    def __exit__(self, *_):
        for loop in self.loops:
            loop.kill()
            loop.wait()


def run_once(command, arguments, folder, condition):
    """Does one run, and returns what its report says. Ends this program if the run gives no report."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(folder / "report", ignore_errors=True)  # the report of an earlier call is not that of this run
    log = folder / "output.txt"
    words = ["taskset", "-c", "0"] if condition == "one_core" else []
    words += [str(command), "run", *arguments, "--report", str(folder / "report")]
    with Loops(condition == "loaded"), open(log, "w", encoding="utf-8") as text:
        # In a session of its own, a run gets one signal for each Ctrl-C: that of this program.
        run = subprocess.Popen(words, stdout=text, stderr=text, cwd=folder, preexec_fn=die_with_parent,
                               start_new_session=True)
        try:
            run.wait(PATIENCE_S)
        finally:
            end_in_order(run, LEAVE_S)
    try:
        report = json.loads((folder / "report" / "report.json").read_text(encoding="utf-8"))
        simulated_s = report["sim_time_s"]
        processes = {one["name"]: {"cpu_ms": 1e3 * one["cpu_s"] / simulated_s, "pss_mib": one["max_pss_mib"]}
                     for one in report["processes"]}
        return {"factor": report["real_time_factor"], "simulated_s": simulated_s, "success": report["success"],
                "processes": processes}
    except (OSError, ValueError, KeyError, TypeError, ZeroDivisionError) as error:
        sys.exit(f"compare_commits: {folder}/report/report.json: {type(error).__name__}: {error}; the run said:\n"
                 f"{log.read_text(encoding='utf-8')[-2000:]}")


def cpu_ms(run):
    return sum(one["cpu_ms"] for one in run["processes"].values())


def listed(values, digits):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def tables(results, names):
    """The results as two tables in Markdown."""
    old, new = names
    text = (f"| condition | times real time, {old} | {new} | ratio | CPU ms for a simulated second, {old} | {new} | "
            "ratio |\n|---|---|---|---|---|---|---|\n")
    for condition, sides in results.items():
        cells = [CONDITIONS[condition]]
        for value, digits in ((lambda run: run["factor"], 2), (cpu_ms, 0)):
            before, after = ([value(run) for run in side] for side in sides)
            ratio = statistics.median(after) / statistics.median(before)
            cells += [listed(before, digits), listed(after, digits), f"{ratio:.2f}"]
        text += "| " + " | ".join(cells) + " |\n"
    text += (f"\nMedians of the first condition:\n\n| process | CPU ms for a simulated second, {old} | {new} | ratio | "
             f"greatest PSS in MiB, {old} | {new} |\n|---|---|---|---|---|---|\n")
    sides = next(iter(results.values()))

    def median(runs, process, key):
        values = [run["processes"][process][key] for run in runs if process in run["processes"]]
        return statistics.median(values) if values else None

    def cell(value):
        return "" if value is None else f"{value:.1f}"

    for process in sorted({name for side in sides for name in side[0]["processes"]}):
        before, after = (median(side, process, "cpu_ms") for side in sides)
        ratio = f"{after / before:.2f}" if before and after is not None else ""
        memory = " | ".join(cell(median(side, process, "pss_mib")) for side in sides)
        text += f"| `{process}` | {cell(before)} | {cell(after)} | {ratio} | {memory} |\n"
    return text


def main():
    parser = Parser(add_help=False)
    parser.add_argument("--old", required=True, type=Path)
    parser.add_argument("--new", required=True, type=Path)
    parser.add_argument("--names", required=True, nargs=2)
    parser.add_argument("--output", required=True, type=Path)
    parser.add_argument("--runs", type=whole(1, 100), default=3)
    parser.add_argument("--conditions", default=",".join(CONDITIONS))
    parser.add_argument("--check", action="store_true", help="only check the options")
    parser.add_argument("arguments", nargs="*")
    options = parser.parse_args()
    conditions = options.conditions.split(",")
    for condition in conditions:
        if condition not in CONDITIONS:
            parser.error(f"--conditions: found '{condition}', accepted one or more of {','.join(CONDITIONS)}")
    if options.check:
        return
    arguments = options.arguments or ["case_study", "--seed", "1"]
    results = {}
    for condition in conditions:
        results[condition] = ([], [])
        for number in range(1, options.runs + 1):
            for side, command in enumerate((options.old, options.new)):
                folder = options.output / f"{condition}_{number}_{'old' if side == 0 else 'new'}"
                run = run_once(command, arguments, folder, condition)
                results[condition][side].append(run)
                print(f"{condition}, run {number} of {options.runs}, {options.names[side]}: {run['factor']:.2f} times "
                      f"real time, {cpu_ms(run):.0f} CPU ms for a simulated second"
                      f"{'' if run['success'] else '; the mission failed'}", flush=True)
    (options.output / "comparison.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    table = tables(results, options.names)
    (options.output / "comparison.md").write_text(table, encoding="utf-8")
    print(f"\n{table}\n{options.output}/comparison.md")


try:
    main()
except KeyboardInterrupt:
    sys.exit(130)
