#!/usr/bin/python3
"""An external planner: follows a line to its end, and looks for the line again when it is lost.

    constrictor run long_line --pace 2x     # in another terminal
    python3 line_planner.py --colour blue

It takes authority from the built-in planner, which goes on when this program ends.
"""

import argparse
import math
import sys

import constrictor


def line_side(run: constrictor.Run) -> str:
    """Returns the side on which perception sees an object or saw the line last: where to turn to search."""
    offset_m = run.latest("perception/line")["offset_m"]
    return "right" if not math.isnan(offset_m) and offset_m < 0 else "left"


def look_for_line(run: constrictor.Run, colour: str, turns: int) -> bool:
    """Turns until perception sees the line. Returns False if it does not in `turns` turns of two seconds."""
    for turn in range(turns):
        direction = line_side(run)
        print(f"looking for the line on the {direction}", flush=True)
        goal = run.start("rotate", direction=direction, timeout_s=2.0)
        # The goal goes on while this loop watches the percepts; it stops turning as soon as the line is in view.
        for percept in run.subscribe("perception/line", timeout=10):
            if percept["visible"] and percept["colour"] == colour:
                goal.cancel()
                return True
            if any(event["event"] == "timeout" for event in goal.events()):
                break
    return False


def follow(run: constrictor.Run, colour: str, searches: int) -> bool:
    """Follows the line to its end. Returns False if it is lost for good."""
    for attempt in range(searches + 1):
        goal = run.start("follow_line", line_colour=colour)
        end = goal.wait()
        names = [event["event"] for event in goal.events() if event["event"] != "none"]
        print(f"follow_line {end}; events: {', '.join(names) or 'none'}", flush=True)
        if end.succeeded:
            return True
        if end.state != "aborted" or not look_for_line(run, colour, turns=4):
            return False
    return False


def main() -> int:
    parser = argparse.ArgumentParser(description="Follows a line to its end, as an external planner.")
    parser.add_argument("--run", type=int, help="DDS domain of the run (default: the only run on this host)")
    parser.add_argument("--colour", default="blue", choices=constrictor.COLOURS, help="of the line (default: blue)")
    parser.add_argument("--searches", type=int, default=3, help="how often to look for a lost line (default: 3)")
    arguments = parser.parse_args()
    try:
        with constrictor.join(arguments.run, name="line_plan") as run:
            return 0 if follow(run, arguments.colour, arguments.searches) else 1
    except constrictor.Error as error:
        print(f"line_planner: {error}", file=sys.stderr)
        return 70


if __name__ == "__main__":
    sys.exit(main())
