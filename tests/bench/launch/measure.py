"""How long the case study takes from the start of the launcher to the first motion; prints JSON. See scripts/bench.sh.

The robot moves one tick (3 ms) after the first event of a task, which the component report writes into events.jsonl
at once. Each launch is a run of its own, which is ended after this event.
Usage: measure.py [--command FILE] [--launches N]
  --command FILE  the program constrictor (default: build/release/bin/constrictor)
  --launches N    number of launches, of which the median counts (default: 5)
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py
from ending import end_in_order  # noqa: E402  tests/bench/ending.py

ROOT = Path(__file__).resolve().parents[3]
PATIENCE_S = 60  # for the first motion, and for the end of the run


def launch(command):
    """[s] wall time until the first event."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report"
        events = report / "events.jsonl"
        output = Path(folder) / "output.txt"
        with open(output, "w", encoding="utf-8") as text:
            begin = time.monotonic()
            run = subprocess.Popen([command, "run", "case_study", "--seed", "1", "--report", str(report)], stdout=text,
                                   stderr=text, env={**os.environ, "XDG_RUNTIME_DIR": folder})
            try:
                while not (events.exists() and events.stat().st_size > 0):
                    if run.poll() is not None or time.monotonic() - begin > PATIENCE_S:
                        sys.exit(f"launch: no event within {PATIENCE_S} s; the run said:\n"
                                 f"{output.read_text(encoding='utf-8')}")
                    time.sleep(0.002)
                taken_s = time.monotonic() - begin
            finally:
                end_in_order(run, PATIENCE_S)
    return taken_s


def main():
    parser = argparse.ArgumentParser(prog="launch", description=__doc__.splitlines()[0])
    parser.add_argument("--command", default=str(ROOT / "build" / "release" / "bin" / "constrictor"))
    parser.add_argument("--launches", type=whole(1), default=5)
    options = parser.parse_args()
    if not os.access(options.command, os.X_OK):
        sys.exit(f"launch: there is no program {options.command}; run: ./scripts/build.sh")
    taken_s = [launch(options.command) for _ in range(options.launches)]
    print(json.dumps({"launches_s": taken_s, "median_s": statistics.median(taken_s), "load": os.getloadavg()[0]},
                     indent=2))


main()
