"""The exceptions of this package. Their texts are those of the command ``constrictor``."""

import builtins


class Error(RuntimeError):
    """A command to a run failed. The text names the object, what happened and what to do."""


class NoRunError(Error):
    """There is no such run, or there are several and none was chosen."""


class RefusedError(Error):
    """The run refused the command; the text is its reason."""


class NoAnswerError(Error):
    """The run did not answer in time."""


class WaitTimeoutError(Error, builtins.TimeoutError):
    """What was waited for did not happen within the given time. ``except TimeoutError`` catches it, too."""
