"""The names that tasks, events, colours, directions and motions have in commands and in messages."""

from __future__ import annotations

from . import _native

_names = _native.names()

#: The tasks that :meth:`constrictor.Run.start` starts.
TASKS: tuple[str, ...] = _names["tasks"]
#: The events of tasks, for :meth:`constrictor.Goal.wait_event`.
EVENTS: tuple[str, ...] = _names["events"]
#: The colours of lines, objects and zones.
COLOURS: tuple[str, ...] = _names["colours"]
#: The directions of ``rotate`` and ``explore``.
DIRECTIONS: tuple[str, ...] = _names["directions"]
#: The motions of :meth:`constrictor.Run.move`.
MOTIONS: tuple[str, ...] = _names["motions"]
