"""Checks the arguments of the package's functions, so that a mistake is named before anything is sent."""

from __future__ import annotations

import functools
import inspect
import numbers
import re
from typing import Any, Callable, Dict, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])
_Class = TypeVar("_Class", bound=type)

# A bool is an int in Python, but True is no speed and no number of ticks.
_CHECKS: Dict[str, Callable[[Any], bool]] = {
    "float": lambda value: isinstance(value, numbers.Real) and not isinstance(value, bool),
    "int": lambda value: isinstance(value, numbers.Integral) and not isinstance(value, bool),
    "str": lambda value: isinstance(value, str),
    "bool": lambda value: isinstance(value, bool),
    "None": lambda value: value is None,
}


def _accepted(annotation: str) -> list[str]:
    """Returns the accepted types of an annotation; none if it has a type that is not checked here."""
    words = [word for word in re.findall(r"[\w.]+", annotation) if word != "Union"]
    if "Optional" in words:
        words = [word for word in words if word != "Optional"] + ["None"]
    return words if all(word in _CHECKS for word in words) else []


def checked(function: _Function) -> _Function:
    """Returns the function with a check of the types of its arguments, by its annotations.

    A wrong type raises a TypeError that names the argument, what was found and what is accepted.
    """
    signature = inspect.signature(function)
    accepted = {name: _accepted(parameter.annotation) for name, parameter in signature.parameters.items()
                if isinstance(parameter.annotation, str)}

    @functools.wraps(function)
    def check(*arguments: Any, **named: Any) -> Any:
        try:
            given = signature.bind(*arguments, **named).arguments
        except TypeError:
            given = {}  # the call below raises Python's own error, which names the function
        for name, value in given.items():
            types = accepted.get(name, [])
            if types and not any(_CHECKS[each](value) for each in types):
                found = f"{value!r} ({type(value).__name__})"
                raise TypeError(f"{function.__name__}: {name}: found {found}, accepted {' or '.join(types)}")
        return function(*arguments, **named)

    return check  # type: ignore[return-value]


def checked_class(made: _Class) -> _Class:
    """Returns the class with :func:`checked` applied to its public functions."""
    for name, member in list(vars(made).items()):
        if not name.startswith("_") and inspect.isfunction(member):
            setattr(made, name, checked(member))
    return made


def in_range(name: str, value: int, least: int, most: int) -> int:
    """Returns the value; raises ValueError if it is out of range."""
    if not least <= value <= most:
        raise ValueError(f"{name}: found {value}, accepted {least} to {most}")
    return value
