"""Rounds of pings among processes of Cyclone DDS's own benchmark ddsperf; prints JSON. See scripts/bench.sh.

One process sends a ping to all others and the next one when all have answered. This is the exchange of a barrier,
without any content: what a tick of as many members costs at least with this middleware and its configuration.
Usage: ddsperf_ping.py [--members N] [--seconds S]
  --members N   processes in all (default: 9, as the case study has)
  --seconds S   duration of the pings (default: 6)
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from arguments import whole  # noqa: E402  tests/bench/arguments.py

CONFIGURATION = Path(__file__).resolve().parents[3] / "deploy" / "cyclonedds" / "loopback.xml"
WAIT_S = 10  # for all processes to find each other
LINE = re.compile(r" 50% (?P<median_us>[\d.]+)us .* cnt (?P<count>\d+)$")


def pss_mib(pid):
    for line in Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii").splitlines():
        if line.startswith("Pss:"):
            return float(line.split()[1]) / 1024.0
    return 0.0


def measure(members, seconds):
    environment = {**os.environ, "CYCLONEDDS_URI": f"file://{CONFIGURATION}"}
    domain = str(100 + os.getpid() % 100)
    before = os.times()

    def ddsperf(*arguments, output):
        return subprocess.Popen(["ddsperf", "-i", domain, *arguments], env=environment, stdout=output,
                                stderr=subprocess.STDOUT, text=True)
    pongs = [ddsperf("-D", str(seconds + WAIT_S), "pong", output=subprocess.DEVNULL) for _ in range(members - 1)]
    try:
        ping = ddsperf("-D", str(seconds), f"-Qminmatch:{members - 1}", f"-Qinitwait:{WAIT_S}", "ping",
                       output=subprocess.PIPE)
        text, _ = ping.communicate(timeout=seconds + 2 * WAIT_S)
        memory_mib = statistics.mean(pss_mib(pong.pid) for pong in pongs)
    finally:
        for pong in pongs:
            pong.terminate()
        for pong in pongs:
            pong.wait()
    after = os.times()
    lines = [match for match in map(LINE.search, text.splitlines()) if match]
    rounds = sum(int(line["count"]) for line in lines) / (members - 1)
    if ping.returncode != 0 or rounds == 0:
        sys.exit(f"ddsperf_ping: no rounds (exit status {ping.returncode}):\n{text}")
    cpu_s = sum(getattr(after, kind) - getattr(before, kind) for kind in ("children_user", "children_system"))
    return {"members": members, "rounds": round(rounds), "cpu_ms_per_round": 1e3 * cpu_s / rounds,
            "round_trip_median_us": statistics.median(float(line["median_us"]) for line in lines),
            "wall_ms_per_round": 1e3 * seconds / rounds, "pss_mib": memory_mib}


def main():
    parser = argparse.ArgumentParser(prog="ddsperf_ping", description=__doc__.splitlines()[0])
    parser.add_argument("--members", type=whole(2), default=9)
    parser.add_argument("--seconds", type=whole(2), default=6)
    options = parser.parse_args()
    print(json.dumps(measure(options.members, options.seconds), indent=2))


main()
