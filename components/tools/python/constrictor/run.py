"""A run: the robot, its tasks, its parameters and its time."""

from __future__ import annotations

import difflib
import os
from dataclasses import dataclass
from typing import Any, Optional, Sequence, Tuple

from . import _native
from .arguments import checked, checked_class, in_range
from .domain import Domain, domain_from_environment


@dataclass(frozen=True)
class RunNote:
    """A run, as its launcher has noted it on this host."""

    domain: int  #: number of the DDS domain, which identifies the run on this host
    pid: int  #: process id of the launcher
    scenario: str
    seed: int
    roster: list[str]  #: the components of the run
    plant: str  #: the component that owns the joints and the time
    directory: str  #: in which the run writes its report
    run_id: int
    on_this_host: bool  #: False: found by its messages only


@dataclass(frozen=True)
class GoalEnd:
    """How a goal ended."""

    state: str  #: "succeeded", "aborted", "preempted" (by another task) or "cancelled"
    reason: str  #: for people; may be empty

    @property
    def succeeded(self) -> bool:
        return self.state == "succeeded"

    def __str__(self) -> str:
        return f"{self.state}: {self.reason}" if self.reason else self.state


@checked_class
class Goal:
    """A task that was started. The robot works on it, also if no program waits for it."""

    def __init__(self, run: Run, goal: int, task: str) -> None:
        self._run = run  # which leaves the run when nothing refers to it any more
        self._session = run._session
        self.id = goal  #: as on the topics task/event and task/status
        self.task = task

    def wait(self, timeout: Optional[float] = None) -> GoalEnd:
        """Waits until the goal ends, at most ``timeout`` seconds of wall time (None: no bound).

        Raises WaitTimeoutError (the goal goes on), and Error if the run ends or is reset.
        """
        return GoalEnd(*self._session.wait_for_end(self.id, timeout))

    def wait_event(self, event: str, timeout: Optional[float] = None) -> dict[str, Any]:
        """Waits for an event of the goal, one of constrictor.EVENTS; an earlier one counts, too.

        Returns event, time_s (of the robot), tick, colour, object_handle and detail. Raises WaitTimeoutError, and Error
        if the goal ends without this event.
        """
        return self._session.wait_for_event(self.id, event, timeout)

    def events(self) -> list[dict[str, Any]]:
        """Returns the events of the goal so far. Those named "none" only changed its state."""
        return self._session.events(self.id)

    def cancel(self) -> None:
        """Makes the robot stand, which ends the goal. Authority stays."""
        self._session.move("stand", 0.0, 0.0, 0.0)

    def __repr__(self) -> str:
        return f"<constrictor.Goal {self.task} {self.id & 0xFFFFFFFF}>"


@checked_class
class Run(Domain):
    """A run that this program has joined; :func:`join` makes one. Use it in a ``with`` statement.

    The first command that moves the robot takes authority. It stays with this program until release(), the end of the
    ``with`` block, the end of the process, or until a source of a higher level takes it.

    It may be used from several threads; while one waits, the others go on. So another thread can stop the robot.
    """

    @property
    def note(self) -> RunNote:
        """Scenario, seed, components and report directory of the run."""
        note = self._session.note
        assert note is not None
        return RunNote(**note)

    @property
    def source(self) -> str:
        """The name under which this program sends its requests."""
        return self._session.source

    def state(self) -> dict[str, Any]:
        """Returns the newest RunState: tick (the next one), paused, pace, real_time_factor, seed, epoch ..."""
        return self._session.state()

    def over(self) -> str:
        """Returns why the run is over, for people; an empty text while it goes on."""
        return self._session.over()

    def components(self) -> dict[str, dict[str, Any]]:
        """Returns the newest status of each component: state, process, host, step times, counts of errors."""
        return self._session.components()

    # --- authority and motion ---

    def authority(self) -> dict[str, Any]:
        """Returns who has authority: level, source, emergency_stop, and mine (True: this program)."""
        return self._session.authority()

    def take(self) -> None:
        """Takes authority without a task: the robot stands. Raises RefusedError, NoAnswerError."""
        self._session.take()

    def release(self) -> bool:
        """Gives authority back: the running task is cancelled, and the built-in planner may go on.

        Returns whether this program has no authority afterwards.
        """
        return self._session.release()

    def drive(self, speed_m_s: float, turn_rad_s: float = 0.0) -> None:
        """Drives with this speed [m/s] (negative: backwards) and turn rate [rad/s] (positive: to the left).

        Returns at once; the robot drives until the next command. There is no feedback: the true speed depends on the
        ground. Raises ValueError, RefusedError, NoAnswerError.
        """
        self._session.drive(speed_m_s, turn_rad_s)

    def stand(self) -> None:
        """Stands still in the present posture; ends a task. Raises RefusedError, NoAnswerError."""
        self._session.move("stand", 0.0, 0.0, 0.0)

    def move(
        self, motion: str, *, speed_m_s: float = 0.0, curvature_1_m: float = 0.0, angle_rad: float = 0.0
    ) -> None:
        """Starts one of constrictor.MOTIONS. Raises ValueError, RefusedError, NoAnswerError.

        drive: speed_m_s along the path (negative: backwards), curvature_1_m of the path (positive: left)
        look: angle_rad by which the head bends. wrap: its sign is the side of the object.
        """
        self._session.move(motion, speed_m_s, curvature_1_m, angle_rad)

    def wait(self, duration_s: float) -> None:
        """Waits until the robot's time has advanced by this much, at whatever pace the run goes.

        Raises Error if the run ends before. A paused run waits as long as it is paused.
        """
        self._session.wait(duration_s)

    # --- tasks ---

    def start(
        self,
        task: str,
        *,
        line_colour: Optional[str] = None,
        object_colour: Optional[str] = None,
        drop_zone_colour: Optional[str] = None,
        direction: Optional[str] = None,
        object_handle: Optional[int] = None,
        timeout_s: Optional[float] = None,
        clearance_m: Optional[float] = None,
        wrap_scale: Optional[float] = None,
        path: Sequence[Tuple[float, float]] = (),
    ) -> Goal:
        """Starts one of constrictor.TASKS and waits until the robot has accepted it. It ends the running task.

        timeout_s: [s] after which ``rotate`` ends and every other task is aborted, in the robot's time. clearance_m:
        [m] of ``pregrasp``, between body and object. wrap_scale: of ``grasp``, width of the open U, 1: usual. path: 2
        to 64 points (x, y) [m] of ``follow_path``, in the frame of guidance/map. Which task needs what:
        idl/CLIENTS.md. Raises ValueError if a parameter is wrong or missing, RefusedError with the robot's reason,
        NoAnswerError.
        """
        if object_handle is not None:
            in_range("object_handle", object_handle, 0, 65535)
        numbers = {"timeout_s": timeout_s, "clearance_m": clearance_m, "wrap_scale": wrap_scale}
        goal = self._session.start(
            task,
            line_colour=line_colour,
            object_colour=object_colour,
            drop_zone_colour=drop_zone_colour,
            direction=direction,
            object_handle=object_handle,
            numbers={name: float(value) for name, value in numbers.items() if value is not None},
            path=[(float(x), float(y)) for x, y in path],
        )
        return Goal(self, goal, task)

    # --- safety ---

    def emergency_stop(self) -> None:
        """Stops the robot at once, whichever source has authority. The stop is latched: only clear_stop() ends it.

        It goes to the plant itself, too, so that it works while other components hang, and needs neither authority nor
        a token. Raises NoAnswerError if no component has confirmed it within 5 s.
        """
        self._session.emergency_stop()

    def clear_stop(self) -> None:
        """Clears the emergency stop. Nothing moves, and no source has authority. Raises RefusedError, NoAnswerError."""
        self._session.clear_stop()

    # --- parameters ---

    def parameters(self, prefix: str = "") -> dict[str, dict[str, Any]]:
        """Returns the run-time parameters whose names begin with ``prefix``.

        Each has value, default, unit, minimum, maximum, whole, choices, owner, changed_tick, pending and doc.
        """
        return {name: entry for name, entry in self._session.parameters().items() if name.startswith(prefix)}

    def get_parameter(self, name: str) -> float | str:
        """Returns the value in force; its name if the parameter is chosen by name.

        Raises KeyError if there is no such parameter.
        """
        known = self._session.parameters()
        found = known.get(name)
        if found is None:
            close = difflib.get_close_matches(name, known, 1)
            meant = f", did you mean '{close[0]}'?" if close else ""
            raise KeyError(f"no parameter '{name}'{meant} (parameters() returns all)")
        value: float | str = found["value"]
        return value

    def set_parameter(self, name: str, value: float | str, at_tick: int = 0) -> int:
        """Sets a parameter at a tick (0: the next one). Returns the tick from which the value is in force.

        ``value`` may be the name of a value, such as "sidewinding". Takes no authority. Raises RefusedError with the
        accepted values, NoAnswerError; ValueError if there is no value of this name.
        """
        if isinstance(value, str):
            choices = self._session.parameters().get(name, {}).get("choices", [])
            if value not in choices:
                raise ValueError(f"{name}: found '{value}', accepted {', '.join(choices) or 'a number'}")
            value = float(choices.index(value))
        return self._session.set_parameter(name, value, in_range("at_tick", at_tick, 0, 9 * 10**15))[1]

    # --- the time of the run; each returns the RunState right after the command ---

    def pause(self) -> dict[str, Any]:
        """Halts the ticks."""
        return self._session.pause()

    def resume(self) -> dict[str, Any]:
        """Continues a paused run."""
        return self._session.resume()

    def step(self, ticks: int = 1) -> dict[str, Any]:
        """Pauses the run, lets it make ``ticks`` ticks, and waits until they are done."""
        return self._session.step(in_range("ticks", ticks, 1, 1_000_000))

    def pace(self, factor: Optional[float]) -> dict[str, Any]:
        """Limits the run to ``factor`` times real time, 0.001 to 1000; None: lock-step, as fast as possible."""
        if factor is not None and not 0.001 <= factor <= 1000:
            raise ValueError(f"pace: found {factor}, accepted 0.001 to 1000, or None")
        return self._session.pace(factor or 0.0)

    def reset(self, seed: int) -> dict[str, Any]:
        """Ends the epoch and begins a new one with this seed."""
        return self._session.reset(in_range("seed", seed, 0, 2**64 - 1))

    def end(self) -> dict[str, Any]:
        """Ends the run in order, with a complete report."""
        return self._session.end()

    def __repr__(self) -> str:
        return f"<constrictor.Run in DDS domain {self.domain}{', closed' if self.closed else ''}>"


def runs() -> list[RunNote]:
    """Returns the runs on this host whose launcher is alive."""
    return [RunNote(**note) for note in _native.live_runs()]


@checked
def join(
    run: Optional[int] = None,
    *,
    directory: Optional["str | os.PathLike[str]"] = None,
    name: str = "python",
    level: str = "external",
    detached: bool = False,
    token: Optional[str] = None,
    token_file: Optional["str | os.PathLike[str]"] = None,
) -> Run:
    """Joins a run.

    run: its DDS domain, as ``constrictor run`` prints it; None: $CONSTRICTOR_DOMAIN, or the only run on this host.
    directory: instead of ``run``, the folder in which the run writes its report.
    name: begins the name of this program among the sources, at most 11 characters of it.
    level: "external" (a planner) or "operator" (a person), who may take authority from planners. While an operator has
        authority, a run in lock-step goes at most at the speed of real time.
    detached: authority and task outlive this program, until some source releases authority.
    token, token_file: of a run on another host (token_file: $CONSTRICTOR_TOKEN_FILE); found by itself on this one.

    Raises NoRunError if there is no such run, or if there are several; Error if this process has joined it already.
    """
    if level not in ("external", "operator"):
        raise ValueError(f"level: found '{level}', accepted external or operator")
    if run is not None and directory is not None:
        raise ValueError("run and directory: accepted is one of them")
    if not name or not all("!" <= character <= "~" for character in name):
        raise ValueError(f"name: found '{name}', accepted printable ASCII characters without blanks")
    return Run(
        domain=None if directory is not None else domain_from_environment(run),
        directory=os.fspath(directory) if directory is not None else "",
        observe=False,
        name=name,
        as_operator=level == "operator",
        detached=detached,
        token=token or "",
        token_file=os.fspath(token_file) if token_file is not None else "",
    )
