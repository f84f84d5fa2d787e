"""A DDS domain and the samples of its topics."""

from __future__ import annotations

import atexit
import os
import threading
import weakref
from types import TracebackType
from typing import Any, Callable, Dict, Generic, Iterator, Optional, Type, TypeVar, Union

from . import _native
from .arguments import checked, checked_class, in_range
from .errors import Error, WaitTimeoutError

#: A sample: nested dictionaries by the fields' names. Numbers are int and float (NaN: unknown), texts are str, arrays
#: of numbers are NumPy arrays of their type, arrays of structures are lists.
Message = Dict[str, Any]

# A process joins a DDS domain once. The domains that this process has joined, with those who joined them.
_joined: "weakref.WeakValueDictionary[int, Domain]" = weakref.WeakValueDictionary()
_lock = threading.RLock()

_Self = TypeVar("_Self", bound="_Closing")
_Native = TypeVar("_Native", bound=Union[_native.Subscription, _native.Publisher])


def domain_from_environment(domain: Optional[int]) -> Optional[int]:
    """Returns ``domain``, or $CONSTRICTOR_DOMAIN if it is None, or None."""
    if domain is None:
        text = os.environ.get("CONSTRICTOR_DOMAIN", "")
        if not text:
            return None
        if not text.isdigit():
            raise ValueError(f"CONSTRICTOR_DOMAIN: found '{text}', accepted a whole number from 0 to 229")
        domain = int(text)
    if not 0 <= domain <= 229:
        raise ValueError(f"run: found {domain}, accepted a DDS domain from 0 to 229")
    return domain


class _Closing:
    """What a ``with`` statement closes at its end."""

    def close(self) -> None:
        raise NotImplementedError

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(
        self, kind: Optional[Type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()


class _Endpoint(_Closing, Generic[_Native]):
    """What subscriptions and publishers have in common."""

    def __init__(self, native: _Native, owner: Optional[Domain]) -> None:
        self._native = native
        self._owner = owner  # which leaves the domain when nothing refers to it any more

    @property
    def topic(self) -> str:
        """The name of the topic."""
        return self._native.topic

    @property
    def type(self) -> str:
        """The IDL type of the messages, ``constrictor::msg::JointState``."""
        return self._native.type

    def close(self) -> None:
        """Ends the subscription or the publisher. Late readers then receive nothing from the publisher any more."""
        self._native.close()


@checked_class
class Subscription(_Endpoint[_native.Subscription]):
    """The samples of one topic, as dictionaries, in the order of their arrival.

    Iterate over it: the loop ends when the run ends. Or call :meth:`next` and :meth:`newest`, with a bound on the wait.
    No subscription delays the run: if samples arrive faster than they are taken, the newest ``depth`` stay.
    """

    def __init__(self, native: _native.Subscription, timeout: Optional[float], owner: Optional[Domain]) -> None:
        super().__init__(native, owner)
        self._timeout = timeout

    @property
    def dropped(self) -> int:
        """How many samples newer ones have replaced before they were taken."""
        return self._native.dropped

    def next(self, timeout: Optional[float] = None) -> Message:
        """Returns the next sample; waits at most ``timeout`` seconds for it (None: until the run ends).

        Raises WaitTimeoutError, and Error if the run has ended or the subscription was closed.
        """
        return self._sample(self._native.next, timeout)

    def newest(self, timeout: Optional[float] = None) -> Message:
        """Returns the newest sample and discards older ones; waits for one if none has arrived since the last call.

        Raises what :meth:`next` raises.
        """
        return self._sample(self._native.newest, timeout)

    def take(self) -> list[Message]:
        """Returns all samples that have arrived since the last call, without waiting."""
        return self._native.take()

    def __iter__(self) -> Iterator[Message]:
        return self

    def __next__(self) -> Message:
        return self._native.next(self._timeout)

    def _sample(self, read: Callable[[Optional[float]], Message], timeout: Optional[float]) -> Message:
        try:
            return read(timeout)
        except StopIteration as end:
            raise Error(f"no further sample of '{self.topic}': {end.value or end}") from None


@checked_class
class Publisher(_Endpoint[_native.Publisher]):
    """Publishes messages on one topic, checked against its type. Made by Domain.publisher()."""

    def __init__(self, native: _native.Publisher, owner: Domain) -> None:
        super().__init__(native, owner)

    @property
    def readers(self) -> int:
        """How many readers receive what is published."""
        return self._native.readers

    def publish(self, message: Message) -> None:
        """Publishes a dictionary. Fields that it leaves out are zero, None is NaN, constants may be given by name.

        Raises ValueError that names the field, what was found and what is accepted.
        """
        self._native.publish(message)

    def wait_for_reader(self, timeout: Optional[float] = 5.0) -> None:
        """Waits until the topic has a reader. Raises WaitTimeoutError."""
        self._native.wait_for_reader(timeout)

    def flush(self, timeout: float = 2.0) -> bool:
        """Waits until all reliable readers have what was published; returns False if they have not in time."""
        return self._native.flush(timeout)


class _Latest:
    """The newest sample of a topic."""

    def __init__(self, subscription: Subscription) -> None:
        self.subscription = subscription
        self._kept: Optional[Message] = None

    def get(self, timeout: Optional[float]) -> Message:
        kept = self._kept
        try:
            kept = self.subscription.newest(timeout if kept is None else 0.0)
        except WaitTimeoutError:
            if kept is None:
                raise
        self._kept = kept
        return kept


@checked_class
class Domain(_Closing):
    """A DDS domain: its topics, of any type, also of other programs. :func:`observe` makes one.

    It may be used from several threads; while one waits, the others go on.
    """

    def __init__(self, **options: Any) -> None:
        with _lock:
            wanted = options.get("domain")
            self._refuse_second(wanted)
            session = _native.Session(**options)
            self._session = session
            self._latest: Dict[tuple[str, bool, bool], _Latest] = {}
            self._latest_lock = threading.Lock()
            self._subscriptions: "weakref.WeakSet[Subscription]" = weakref.WeakSet()
            self._publishers: "weakref.WeakSet[Publisher]" = weakref.WeakSet()
            _joined[session.domain] = self

    @staticmethod
    def _refuse_second(domain: Optional[int]) -> None:
        candidates = [domain] if domain is not None else [run["domain"] for run in _native.live_runs()]
        if domain is None and len(candidates) != 1:
            return
        other = _joined.get(candidates[0])
        if other is not None and not other.closed:
            raise Error(
                f"this process has already joined DDS domain {candidates[0]}, and DDS allows that only once; use the "
                "object that join() or observe() has returned, or call its close() first"
            )

    @property
    def domain(self) -> int:
        """The number of the DDS domain."""
        return self._session.domain

    @property
    def closed(self) -> bool:
        """True after :meth:`close`."""
        return self._session.closed

    def topics(self) -> dict[str, dict[str, Any]]:
        """Returns the topics that have a reader or writer: type, number of writers, number of readers."""
        return self._session.topics()

    def subscribe(
        self,
        topic: str,
        *,
        timeout: Optional[float] = None,
        history: bool = False,
        depth: int = 256,
        names: bool = True,
        whole: bool = False,
    ) -> Subscription:
        """Begins to read a topic, of any type that its writer describes.

        timeout: [s] the longest wait of an iteration for the next sample; then WaitTimeoutError. None: no bound.
        history: begin with the samples that the writers keep for late readers; for events, answers and ``authority``.
        depth: number of samples that wait until they are taken. An image has 0.2 to 1 MB.
        names: fields that hold a constant get its name, ``"blue"``, instead of its number.
        whole: arrays keep all elements. Otherwise they lose those that their field ``..._count`` does not count.

        Raises Error if there is no such topic, or if its writer does not describe its type.
        """
        in_range("depth", depth, 1, 1_000_000)
        native = _native.Subscription(self._session, topic, history=history, depth=depth, names=names, whole=whole)
        return self._noted(Subscription(native, timeout, self))

    def _noted(self, subscription: Subscription) -> Subscription:
        self._subscriptions.add(subscription)
        return subscription

    def latest(
        self, topic: str, timeout: Optional[float] = 5.0, *, names: bool = True, whole: bool = False
    ) -> Message:
        """Returns the newest sample of a topic that has arrived, also if an earlier call has returned it.

        The first call begins to read the topic, and waits up to ``timeout`` seconds for a sample. Raises
        WaitTimeoutError, and what :meth:`subscribe` raises.
        """
        key = (topic, names, whole)
        with self._latest_lock:
            latest = self._latest.get(key)
            if latest is None:
                native = _native.Subscription(self._session, topic, history=True, depth=1, names=names, whole=whole)
                latest = _Latest(self._noted(Subscription(native, None, None)))
                self._latest[key] = latest
        return latest.get(timeout)

    def publisher(self, topic: str, type: str = "") -> Publisher:
        """Makes a publisher of a topic of another program, of a new one, or of the topics on which clients command.

        type: of a topic that has no reader or writer yet, for example ``"JointState"``.
        Raises RefusedError if the topic belongs to a run in this domain, and Error if its type is not known.
        """
        publisher = Publisher(_native.Publisher(self._session, topic, type), self)
        self._publishers.add(publisher)
        return publisher

    def close(self) -> None:
        """Leaves the domain. Subscriptions and publishers end."""
        # A process can join the domain again only after all that it read and wrote there is gone.
        for subscription in list(self._subscriptions):
            subscription.close()
        for publisher in list(self._publishers):
            publisher.close()
        self._latest.clear()
        self._session.close()

    def __del__(self) -> None:
        if hasattr(self, "_publishers"):  # else joining failed
            self.close()


@checked
def observe(domain: Optional[int] = None) -> Domain:
    """Opens a DDS domain to read its topics, also one without a run: a replay, or other programs.

    domain: its number; None: $CONSTRICTOR_DOMAIN, or that of the only run on this host.
    """
    return Domain(
        domain=domain_from_environment(domain),
        directory="",
        observe=True,
        name="python",
        as_operator=False,
        detached=False,
        token="",
        token_file="",
    )


@atexit.register
def _leave_all() -> None:
    """A program that ends without close() leaves its runs in order, too."""
    for domain in list(_joined.values()):
        domain.close()
