"""Measures how soon the robot is at rest after faults of its hardware and of its processes.

Each row is a run of its own on emulated servos and an emulated camera, at real-time pace. The robot moves, a fault
begins, and the emulator's own notes of the joints (50 a second) show when they are at rest: no component of the run is
asked. scripts/fault_reactions.sh starts this program.
"""

import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from typing import Callable, List, Optional, Tuple

import constrictor

HERE = pathlib.Path(__file__).parent
BEFORE_S = 3.0  # the robot moves for so long before the fault
AFTER_S = 6.0  # and is watched for so long after it
STEP_RAD = 0.004  # of the fastest joint in 20 ms: slower is at rest (the servo's position has steps of 0.0015 rad)
REST_S = 0.3  # for so long


class Trial:
    """A run on emulated hardware that goes on until the end of the ``with`` block."""

    def __init__(self, command: pathlib.Path, folder: pathlib.Path, follows_line: bool) -> None:
        self.command, self.folder, self.follows_line = command, folder, follows_line
        self.report = folder / "report"

    def __enter__(self) -> "Trial":
        os.environ["XDG_RUNTIME_DIR"] = str(self.folder)  # no other run of this host is met
        arguments = ["run", "line", "--manifest", str(HERE / "manifest.yaml"), "--report", str(self.report)]
        self.output = (self.folder / "out").open("w")
        self.launcher = subprocess.Popen([str(self.command), *arguments], stdout=self.output, stderr=self.output)
        try:
            self.until("the run", lambda: bool(constrictor.runs()))
            self.run = constrictor.join(level="operator")
            self.run.latest("joint_state", timeout=30)
            if not self.follows_line:
                self.run.drive(0.5)
            self.run.wait(BEFORE_S)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if hasattr(self, "run"):
            self.run.close()
        if self.launcher.poll() is None:
            self.launcher.send_signal(signal.SIGTERM)
        try:
            self.launcher.wait(30)
        except subprocess.TimeoutExpired:
            self.launcher.kill()
            self.launcher.wait()
        self.output.close()

    def until(self, what: str, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + 30
        while not condition():
            if time.monotonic() > end or self.launcher.poll() is not None:
                raise RuntimeError(f"{what} did not come: {(self.folder / 'out').read_text()}")
            time.sleep(0.02)

    def tell(self, device: str, line: str) -> None:
        """Gives an emulated device a command."""
        with (self.report / f"{device}.commands").open("w") as pipe:
            pipe.write(line + "\n")

    def send(self, component: str, number: int) -> int:
        """Sends a signal to the process of a component; returns its process id."""
        pid = int(self.run.components()[component]["pid"])
        os.kill(pid, number)
        return pid

    def notes(self) -> List[dict]:
        """What the emulator has noted of the world so far."""
        lines = (self.report / "world.jsonl").read_text().splitlines()[1:]
        return [json.loads(line) for line in lines if line.endswith("}")]

    def said(self, file: str, key: str) -> List[str]:
        """What a driver has noted in its file, in the order of time."""
        try:
            found = json.loads((self.report / file).read_text()).get(key, [])
        except (OSError, ValueError):
            return []
        return [entry if isinstance(entry, str) else str(entry.get("text", entry)) for entry in found]


def rest_after(notes: List[dict], fault_s: float) -> Tuple[Optional[float], bool]:
    """Returns the time [s] from the fault to rest (None: never), and whether the robot moves at the end."""
    fastest = []
    for before, now in zip(notes, notes[1:]):
        step = max(abs(b - a) for a, b in zip(before["joints_rad"], now["joints_rad"]))
        fastest.append((now["time_s"], step * 0.02 / (now["time_s"] - before["time_s"])))
    begin: Optional[float] = None
    rest: Optional[float] = None
    for at_s, step in fastest:
        if at_s <= fault_s or rest is not None:
            continue
        if step > STEP_RAD:
            begin = None
        elif begin is None:
            begin = at_s
        elif at_s - begin >= REST_S:
            rest = begin - fault_s
    moves = any(step > STEP_RAD for at_s, step in fastest if at_s > fastest[-1][0] - 0.5)
    return rest, moves


@dataclass(frozen=True)
class Row:
    name: str
    begin: Callable[[Trial], None]
    end: Callable[[Trial], None] = lambda trial: None
    follows_line: bool = False


def servo(line: str) -> Callable[[Trial], None]:
    return lambda trial: trial.tell("servo_emulator", line)


def camera(line: str) -> Callable[[Trial], None]:
    return lambda trial: trial.tell("camera_emulator", line)


def process(component: str, number: int) -> Callable[[Trial], None]:
    return lambda trial: void(trial.send(component, number))


def void(_: object) -> None:
    return None


class Hang:
    """Stops a process, and lets it go on at the end, so that the run can end."""

    def __init__(self, component: str, then: Callable[[Trial], None] = lambda trial: None) -> None:
        self.component, self.then, self.pid = component, then, 0

    def begin(self, trial: Trial) -> None:
        self.pid = trial.send(self.component, signal.SIGSTOP)
        self.then(trial)

    def end(self, _: Trial) -> None:
        os.kill(self.pid, signal.SIGCONT)


class Load:
    """A busy loop on each core."""

    def __init__(self) -> None:
        self.loops: List[subprocess.Popen] = []

    def begin(self, _: Trial) -> None:
        cores = os.cpu_count() or 1
        self.loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(cores)]

    def end(self, _: Trial) -> None:
        for loop in self.loops:
            loop.kill()
            loop.wait()


def rows() -> List[Row]:
    bus, control, hung, load = Hang("servo_bus"), Hang("control"), Hang("input", emergency_stop), Load()
    return [
        Row("emergency stop", emergency_stop),
        Row("cable pulled behind the tenth servo", servo("cable 0 9")),
        Row("adapter of the servos unplugged", servo("unplug 0")),
        Row("adapter of the contact sensors unplugged", servo("unplug 1")),
        Row("a servo is silent", servo("silent 6")),
        Row("a servo reports overload", servo("error 6 32")),
        Row("a servo is overheated", servo("hot 6 95")),
        Row("undervoltage of a servo", servo("voltage 6 5")),
        Row("a servo has the id of no servo", servo("id 6 77")),
        Row("two servos have one id", servo("id 6 9")),
        Row("30 % of the bytes are damaged", servo("damage 0 0.3")),
        Row("a joint is stuck", servo("stuck 6")),
        Row("a servo is weak (30 %)", servo("weak 6 0.3")),
        Row("a contact sensor is dead", servo("numb 6")),
        Row("camera off", camera("off"), follows_line=True),
        Row("camera black", camera("black"), follows_line=True),
        Row("camera frozen", camera("freeze"), follows_line=True),
        Row("camera blurred (4 pixels)", camera("blur 4"), follows_line=True),
        Row("driver of the servos killed", process("servo_bus", signal.SIGKILL)),
        Row("driver of the servos hangs", bus.begin, bus.end),
        Row("control killed", process("control", signal.SIGKILL)),
        Row("control hangs", control.begin, control.end),
        Row("input hangs, then emergency stop", hung.begin, hung.end),
        Row("a busy loop on each core", load.begin, load.end),
    ]


def emergency_stop(trial: Trial) -> None:
    subprocess.run([str(trial.command), "stop"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=30)


def measure(command: pathlib.Path, row: Row) -> str:
    with tempfile.TemporaryDirectory(prefix="reactions-") as folder:
        with Trial(command, pathlib.Path(folder), row.follows_line) as trial:
            heard = len(trial.said("servo_bus.json", "news"))
            fault_s = trial.notes()[-1]["time_s"]
            try:
                row.begin(trial)
                time.sleep(AFTER_S)
                notes = trial.notes()
            finally:
                row.end(trial)
            said = trial.said("servo_bus.json", "news")[heard:]
            rest, moves = rest_after(notes, fault_s)
    reaction = "goes on" if rest is None else f"at rest after {rest * 1000:.0f} ms"
    if rest is not None and moves:
        reaction += ", then goes on"
    return f"| {row.name} | {reaction} | {said[0] if said else ''} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--constrictor", type=pathlib.Path, required=True, help="the command to measure")
    parser.add_argument("--only", default="", help="only rows whose name contains this text")
    parser.add_argument("--output", type=pathlib.Path, help="file for the table, besides the screen")
    given = parser.parse_args()
    wanted = [row for row in rows() if given.only in row.name]
    if not wanted:
        parser.error(f"--only: found '{given.only}', accepted a part of one of: " + "; ".join(r.name for r in rows()))
    lines = ["| fault | the robot | what the driver says first |", "|---|---|---|"]
    print("\n".join(lines), flush=True)
    for row in wanted:
        lines.append(measure(given.constrictor, row))
        print(lines[-1], flush=True)
    if given.output:
        given.output.parent.mkdir(parents=True, exist_ok=True)
        given.output.write_text("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
