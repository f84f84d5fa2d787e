"""Join a run of Constrictor: read its topics, drive the robot, start tasks, command the run.

    import constrictor

    with constrictor.join() as run:                       # the only run on this host
        print(run.latest("guidance/pose")["X_MH"])
        goal = run.start("follow_line", line_colour="blue")
        print(goal.wait(timeout=60))

The ``with`` block ends in order: the robot stands, authority is released, and DDS is left, also after an exception and
after Ctrl-C.
"""

from __future__ import annotations

from ._native import __version__
from .domain import Domain, Message, Publisher, Subscription, observe
from .errors import Error, NoAnswerError, NoRunError, RefusedError, WaitTimeoutError
from .names import COLOURS, DIRECTIONS, EVENTS, MOTIONS, TASKS
from .run import Goal, GoalEnd, Run, RunNote, join, runs

__all__ = [
    "COLOURS",
    "DIRECTIONS",
    "Domain",
    "EVENTS",
    "Error",
    "Goal",
    "GoalEnd",
    "MOTIONS",
    "Message",
    "NoAnswerError",
    "NoRunError",
    "Publisher",
    "RefusedError",
    "Run",
    "RunNote",
    "Subscription",
    "TASKS",
    "WaitTimeoutError",
    "__version__",
    "join",
    "observe",
    "runs",
]
