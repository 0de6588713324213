# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What pickle, copy and == of several types share."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np

from . import _core
from ._errors import Error

_Self = TypeVar("_Self")
_Part = TypeVar("_Part")


class Immutable:
    """What never changes is its own copy."""

    __slots__ = ()

    def __copy__(self: _Self) -> _Self:
        return self

    def __deepcopy__(self: _Self, memo: dict[int, Any]) -> _Self:
        return self


def stated(kind: str, **parts: Any) -> dict[str, Any]:
    """The state of a pickled object: what it is, which version wrote it, and its parts."""
    return {"glidar": _core.version(), "kind": kind, **parts}


def part(state: Mapping[str, Any], name: str, kind: type[_Part]) -> _Part:
    """A part of a state, of the type that it must have."""
    value = state[name]
    if not isinstance(value, kind):
        raise TypeError(f"'{name}' is a {type(value).__name__} instead of a {kind.__name__}")
    return value


@contextmanager
def restoring(kind: str, state: object) -> Iterator[None]:
    """Makes a glidar.Error of whatever a malformed state leads to."""
    where = f"pickled {kind}"
    remedy = "pickle it again with this version of glidar"
    if not isinstance(state, dict) or state.get("kind") != kind:
        raise Error(where, "a state of something else", f"the state of a {kind}", remedy)
    try:
        yield
    except Error:
        raise
    except Exception as problem:
        found = f"a malformed state ({type(problem).__name__}: {problem})"
        version = state.get("glidar")
        wrote = f" of version {version}" if isinstance(version, str) and version != _core.version() else ""
        raise Error(where, found + wrote, f"the state of a {kind}", remedy) from problem


def key_of(value: object) -> object:
    """A hashable value that two states share only if they hold the same, to the bit."""
    if isinstance(value, Mapping):
        return tuple((name, key_of(inner)) for name, inner in value.items())
    if isinstance(value, (list, tuple)):
        return tuple(key_of(inner) for inner in value)
    if isinstance(value, np.ndarray):
        return (value.shape, value.dtype.str, value.tobytes())
    if isinstance(value, float):
        return ("float", value.hex(), str(value))  # unlike ==, distinguishes -0.0 from 0.0, and NaN equals NaN
    if is_dataclass(value):
        return (type(value).__name__, *(key_of(getattr(value, field.name)) for field in fields(value)))
    return value


class SameContent:
    """What dataclasses with arrays or NaN inherit: equal when of one type and the same to the bit."""

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and key_of(self) == key_of(other)

    def __hash__(self) -> int:
        return hash(key_of(self))


def same_parts(one: Any, other: object) -> bool:
    """Whether two dataclasses with arrays are of one type and the same to the bit; for their ``__eq__``."""
    names = [field.name for field in fields(one)]
    return type(one) is type(other) and all(_same(getattr(one, name), getattr(other, name)) for name in names)


def _same(one: object, other: object) -> bool:
    if one is None or other is None:
        return one is other
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return key_of(np.asarray(one)) == key_of(np.asarray(other))
    return one == other


def refuse_pickle(kind: str, found: str, remedy: str) -> Callable[..., Any]:
    """A ``__reduce_ex__`` that says why something cannot be pickled, and what to do."""

    def __reduce_ex__(self: object, protocol: object) -> Any:
        raise Error(kind, found, "", remedy)

    return __reduce_ex__
