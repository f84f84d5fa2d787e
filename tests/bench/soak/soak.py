"""Repeats missions while their processes are killed and stopped at random. scripts/soak.sh starts this program.

Each mission has a seed of its own for its random faults, so that missions do not depend on those before them. Every
fourth one also has a random file of faults (lost, late, doubled and damaged samples). A mission passes if the run
ends in order and has the state hash of an undisturbed run in one process with the same seed and the same file.
"""

import argparse
import ctypes
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from typing import Dict, Iterable, List, Optional, Tuple

TOPICS = ["camera/image", "perception/line", "perception/objects", "joint_state", "imu_state", "joint_command"]
LAUNCHER_SHARE = 0.07  # of the kills and stops: the launcher is killed, and the run resumed
STOP_SHARE = 0.15  # a process is stopped for a moment instead of being killed
MEMORY_EVERY_S = 5.0
DEADLINE_S = 3600.0  # of a mission; a run that stands still is a failure


class Interrupted(Exception):
    """The user pressed Ctrl-C, or the time is over."""


def die_with_parent() -> None:
    """In the launcher, before it begins: without this program, no process would end its run."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def member(pid: int, folder: pathlib.Path) -> str:
    """The components that a member process of the run in `folder` hosts; empty if it is none, or has ended."""
    try:
        words = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return ""
    if str(folder) not in words or "--incarnation" not in words:
        return ""
    return pathlib.Path(words[0]).name if words[1].startswith("-") else words[1]


def named(pids: Iterable[int], folder: pathlib.Path) -> Dict[int, str]:
    names = {pid: member(pid, folder) for pid in pids}
    return {pid: name for pid, name in names.items() if name}


def left_of(folder: pathlib.Path) -> Dict[int, str]:
    """The member processes of the run in `folder`, whichever process started them."""
    return named((int(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()), folder)


def processes_of(launcher: int, folder: pathlib.Path) -> Dict[int, str]:
    """The member processes that this launcher has started; cheaper than a look at all processes."""
    pids: List[int] = []
    try:
        for task in pathlib.Path(f"/proc/{launcher}/task").iterdir():
            pids += [int(word) for word in (task / "children").read_text().split()]
    except OSError:
        pass
    return named(pids, folder)


def memory_mib(pid: int) -> float:
    try:
        for line in pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return 0.0


def faults_file(draw: random.Random) -> str:
    lines = [f"seed: {draw.randrange(1, 1000)}", "faults:"]
    for _ in range(draw.randrange(1, 4)):
        kind = draw.choice(["drop", "delay", "duplicate", "corrupt"])
        more = f", delay_ticks: {draw.randrange(1, 6)}" if kind == "delay" else ""
        share, begin = draw.uniform(0.01, 0.1), draw.randrange(0, 100)
        lines.append(
            f"  - {{topic: {draw.choice(TOPICS)}, kind: {kind}{more}, probability: {share:.3f}, from_s: {begin}, "
            f"until_s: {begin + draw.randrange(5, 60)}}}"
        )
    return "\n".join(lines) + "\n"


class Soak:
    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.folder = pathlib.Path(options.output).absolute()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.constrictor = pathlib.Path(options.programs).absolute() / "constrictor"
        self.rows = self.read_rows()
        self.end = time.monotonic() + 3600 * options.hours
        self.interrupted = False
        self.launcher: Optional[subprocess.Popen] = None
        self.environment = dict(os.environ, XDG_RUNTIME_DIR=str(self.folder / "runtime"))
        (self.folder / "runtime").mkdir(mode=0o700, exist_ok=True)

    def read_rows(self) -> List[dict]:
        """The missions of earlier calls. A line that was cut by a crash is left out."""
        what = {key: getattr(self.options, key) for key in ("scenario", "manifest", "seeds", "every", "draw")}
        plan = self.folder / "soak.json"
        if plan.exists():
            before = json.loads(plan.read_text())
            if before != what:
                text = f"{self.folder}: holds a soak with {before}; choose another folder with --output"
                print(text, file=sys.stderr)
                sys.exit(64)
        else:
            plan.write_text(json.dumps(what) + "\n")
        rows = []
        if (self.folder / "missions.jsonl").exists():
            for line in (self.folder / "missions.jsonl").read_text().splitlines():
                try:
                    rows.append(json.loads(line))
                except ValueError:
                    pass
        return rows

    def interrupt(self, *_: object) -> None:
        self.interrupted = True

    def check_time(self) -> None:
        if self.interrupted or time.monotonic() > self.end:
            raise Interrupted

    def start(self, arguments: List[str], output: pathlib.Path) -> subprocess.Popen:
        """Starts the launcher in a session of its own: Ctrl-C must reach it only by end_launcher()."""
        with output.open("a") as log:
            return subprocess.Popen(
                [str(self.constrictor), "run", *arguments],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=self.environment, start_new_session=True,
                preexec_fn=die_with_parent,
            )

    def end_launcher(self) -> None:
        if self.launcher is None or self.launcher.poll() is not None:
            return
        for number, bound_s in ((signal.SIGINT, 60), (signal.SIGINT, 10), (signal.SIGKILL, 10)):
            self.launcher.send_signal(number)
            try:
                self.launcher.wait(bound_s)
                return
            except subprocess.TimeoutExpired:
                continue

    def run_arguments(self, report: pathlib.Path, seed: int, faults: Optional[pathlib.Path]) -> List[str]:
        arguments = [self.options.scenario, "--manifest", self.options.manifest, "--seed", str(seed),
                     "--report", str(report)]
        return arguments + (["--faults", str(faults)] if faults else [])

    def report_of(self, folder: pathlib.Path) -> dict:
        try:
            return json.loads((folder / "report.json").read_text())
        except (OSError, ValueError):
            return {}

    def reference(self, seed: int, faults: Optional[pathlib.Path], number: int) -> dict:
        """The result of an undisturbed run in one process. Without a file of faults, results are kept and reused."""
        kept = self.folder / f"reference-{seed}.json"
        if not faults and kept.exists():
            return json.loads(kept.read_text())
        report = self.folder / f"reference-{number}"
        shutil.rmtree(report, ignore_errors=True)
        arguments = self.run_arguments(report, seed, faults) + ["--in-process"]
        self.launcher = self.start(arguments, self.folder / "reference.log")
        while self.launcher.poll() is None:
            self.check_time()
            time.sleep(0.1)
        json_report = self.report_of(report)
        if "state_hash" not in json_report or json_report.get("error"):
            sys.exit(f"the undisturbed run failed; its log is {self.folder / 'reference.log'}")
        result = {key: json_report.get(key) for key in ("state_hash", "success", "sim_time_s")}
        if not faults:
            kept.write_text(json.dumps(result) + "\n")
        shutil.rmtree(report, ignore_errors=True)
        return result

    def disturb(self, draw: random.Random, report: pathlib.Path, kills: Counter, output: pathlib.Path) -> None:
        """One kill or stop. A process that has just ended, or is not started yet, is not counted."""
        if draw.random() < LAUNCHER_SHARE:
            if self.launcher.poll() is not None or not (report / "run.json").exists():
                return
            self.launcher.kill()
            self.launcher.wait()
            if json.loads((report / "run.json").read_text())["over"]:
                return  # it was killed between the end of its run and its own
            kills["launcher"] += 1
            self.launcher = self.start(["--resume", str(report)], output)
            return
        victims = sorted(processes_of(self.launcher.pid, report).items(), key=lambda item: item[1])
        if not victims:
            return
        pid, name = draw.choice(victims)
        try:
            if draw.random() < STOP_SHARE:
                os.kill(pid, signal.SIGSTOP)
                kills["stop " + name] += 1
                time.sleep(draw.uniform(0.05, 2.0))
                os.kill(pid, signal.SIGCONT)
            else:
                os.kill(pid, signal.SIGKILL)
                kills[name] += 1
        except ProcessLookupError:
            pass

    def carry_out(self, draw: random.Random, report: pathlib.Path, arguments: List[str]) -> Tuple[Counter, dict]:
        kills: Counter = Counter()
        peak: Dict[str, float] = {}
        output = report.with_suffix(".log")
        output.unlink(missing_ok=True)
        begin = time.monotonic()
        self.launcher = self.start(arguments, output)
        due = begin + draw.expovariate(1 / self.options.every)
        memory_due = begin
        while self.launcher.poll() is None:
            self.check_time()
            now = time.monotonic()
            if now > begin + DEADLINE_S:
                self.end_launcher()
                break
            if now >= memory_due:
                memory_due = now + MEMORY_EVERY_S
                for pid, name in [*processes_of(self.launcher.pid, report).items(), (self.launcher.pid, "launcher")]:
                    peak[name] = max(peak.get(name, 0.0), memory_mib(pid))
            if now >= due:
                due = now + draw.expovariate(1 / self.options.every)
                self.disturb(draw, report, kills, output)
            time.sleep(0.02)
        return kills, peak

    def mission(self) -> None:
        number = len(self.rows) + 1
        draw = random.Random(self.options.draw * 1_000_003 + number)
        first, last = self.options.seeds
        seed = first + (number - 1) % (last - first + 1)
        faults = None
        if number % 4 == 0:
            faults = self.folder / f"faults-{number}.yaml"
            faults.write_text(faults_file(draw))
        expected = self.reference(seed, faults, number)
        report = self.folder / f"mission-{number}"
        shutil.rmtree(report, ignore_errors=True)
        begin = time.monotonic()
        kills, peak = self.carry_out(draw, report, self.run_arguments(report, seed, faults))
        found = self.report_of(report)
        row = {
            "number": number,
            "seed": seed,
            "faults": faults.name if faults else "",
            "kills": dict(sorted(kills.items())),
            "status": self.launcher.returncode,
            "success": found.get("success"),
            "error": found.get("error", "" if found else "no report"),
            "same_hash": found.get("state_hash") == expected["state_hash"],
            "sim_time_s": found.get("sim_time_s"),
            "wall_time_s": round(time.monotonic() - begin, 1),
            "memory_mib": {name: round(value, 1) for name, value in sorted(peak.items())},
            "left": sorted(left_of(report).values()),
        }
        row["passes"] = row["same_hash"] and not row["error"] and not row["left"]
        with (self.folder / "missions.jsonl").open("a") as log:
            log.write(json.dumps(row) + "\n")
        self.rows.append(row)
        count = sum(value for name, value in kills.items() if not name.startswith("stop"))
        print(
            f"mission {number}: seed {seed}{', ' + faults.name if faults else ''}, {count} kills "
            f"({kills['launcher']} of the launcher), {row['wall_time_s']:.0f} s, "
            f"{sum(peak.values()):.0f} MiB: " + ("passes" if row["passes"] else f"FAILS, see {report}"),
            flush=True,
        )
        if row["passes"]:
            shutil.rmtree(report, ignore_errors=True)
            report.with_suffix(".log").unlink(missing_ok=True)

    def summary(self) -> str:
        rows, kills = self.rows, Counter()
        for row in rows:
            kills.update(row["kills"])
        stops = sum(count for name, count in kills.items() if name.startswith("stop "))
        killed = {name: count for name, count in sorted(kills.items()) if not name.startswith("stop ")}
        failed = [row["number"] for row in rows if not row["passes"]]
        total = sum(row["wall_time_s"] for row in rows)
        lines = [
            "# Missions with random faults",
            "",
            f"{len(rows)} missions of {self.options.scenario} in {total / 3600:.2f} h: {len(rows) - len(failed)} have "
            f"the state hash of the undisturbed run, {len(failed)} failed"
            + (f" ({', '.join(map(str, failed))})." if failed else "."),
            "",
            f"{sum(killed.values())} kills, {stops} stops:",
            "",
            "| process | killed |",
            "|---|---|",
            *(f"| {name} | {count} |" for name, count in killed.items()),
            "",
            "| process | memory [MiB], median of the first third of the missions | of the last third |",
            "|---|---|---|",
        ]
        third = max(1, len(rows) // 3)
        names = sorted({name for row in rows for name in row["memory_mib"]})
        for name in names:
            halves = []
            for part in (rows[:third], rows[-third:]):
                values = sorted(row["memory_mib"][name] for row in part if name in row["memory_mib"])
                halves.append(f"{values[len(values) // 2]:.1f}" if values else "")
            lines.append(f"| {name} | {halves[0]} | {halves[1]} |")
        return "\n".join(lines) + "\n"

    def run(self) -> int:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.interrupt)
        try:
            while not self.options.missions or len(self.rows) < self.options.missions:
                self.check_time()
                self.mission()
        except Interrupted:
            print("ending the mission that is going on; it does not count", flush=True)
        finally:
            self.end_launcher()
        if self.rows:
            (self.folder / "summary.md").write_text(self.summary())
            print("\n" + self.summary() + f"\n{self.folder / 'summary.md'}", flush=True)
        if self.interrupted:
            print("interrupted; the same command goes on", file=sys.stderr)
            return 130
        return 0 if all(row["passes"] for row in self.rows) else 1


def seeds(text: str) -> List[int]:
    words = text.split("..")
    if len(words) not in (1, 2) or not all(word.isdigit() for word in words) or int(words[-1]) < int(words[0]):
        raise argparse.ArgumentTypeError(f"found {text}, accepted A..B, for example 1..5")
    return [int(words[0]), int(words[-1])]


def positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"found {text}, accepted a number above 0")
    return value


class Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:
        print(f"soak.sh: {message} (--help shows the options)", file=sys.stderr)
        sys.exit(64)


def main() -> int:
    parser = Parser(prog="soak.sh", allow_abbrev=False)
    parser.add_argument("--hours", type=positive, default=8.0)
    parser.add_argument("--missions", type=int, default=0)
    parser.add_argument("--default-output", help=argparse.SUPPRESS)
    parser.add_argument("--output", default="")
    parser.add_argument("--scenario", default="case_study")
    parser.add_argument("--manifest", default="case_study")
    parser.add_argument("--seeds", type=seeds, default=[1, 5])
    parser.add_argument("--every", type=positive, default=2.0)
    parser.add_argument("--draw", type=int, default=1)
    parser.add_argument("--programs", required=True)
    options = parser.parse_args()
    options.output = options.output or options.default_output
    if not (pathlib.Path(options.programs) / "constrictor").exists():
        parser.error(f"--programs: found no constrictor in {options.programs}")
    try:
        return Soak(options).run()
    except OSError as error:
        print(f"soak.sh: {error}", file=sys.stderr)
        return 74


if __name__ == "__main__":
    sys.exit(main())
