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

try:
    from ._native import __version__
except ModuleNotFoundError as error:
    if error.name != __name__ + "._native":
        raise
    import pathlib as _pathlib
    import sys as _sys

    _built = [file.name for file in _pathlib.Path(__file__).parent.glob("_native.*.so")]
    raise ImportError(
        f"constrictor: this is Python {_sys.version_info.major}.{_sys.version_info.minor} ({_sys.executable}), but the "
        f"package was built for {', '.join(_built) or 'no Python yet (build it: scripts/build.sh --python)'}; "
        "use Debian's Python, /usr/bin/python3"
    ) from None
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
