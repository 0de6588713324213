# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pickling, copying and comparison, shared by several types."""

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
    """Base of immutable types, whose copies are the object itself."""

    __slots__ = ()

    def __copy__(self: _Self) -> _Self:
        return self

    def __deepcopy__(self: _Self, memo: dict[int, Any]) -> _Self:
        return self


def make_state(kind: str, **parts: Any) -> dict[str, Any]:
    """The state of a pickled object: its type, the version that wrote it, and its parts."""
    return {"glidar": _core.version(), "kind": kind, **parts}


def part(state: Mapping[str, Any], name: str, kind: type[_Part]) -> _Part:
    """A part of a state, after checking its type."""
    value = state[name]
    if not isinstance(value, kind):
        raise TypeError(f"'{name}' is a {type(value).__name__} instead of a {kind.__name__}")
    return value


@contextmanager
def restoring(kind: str, state: object) -> Iterator[None]:
    """Converts any exception caused by a malformed state to a glidar.Error."""
    where = f"pickled {kind}"
    remedy = "pickle it again with this version of glidar"
    if not isinstance(state, dict) or state.get("kind") != kind:
        raise Error(where, "the state of another type", f"the state of a {kind}", remedy)
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
    """A hashable value that is equal for bit-identical states."""
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
    """Base of dataclasses with arrays or NaN: equal when they have the same type and bit-identical fields."""

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and key_of(self) == key_of(other)

    def __hash__(self) -> int:
        return hash(key_of(self))


def has_same_fields(one: Any, other: object) -> bool:
    """Whether two dataclasses with arrays have the same type and bit-identical fields; for their ``__eq__``."""
    names = [field.name for field in fields(one)]
    return type(one) is type(other) and all(_same(getattr(one, name), getattr(other, name)) for name in names)


def _same(one: object, other: object) -> bool:
    if one is None or other is None:
        return one is other
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return key_of(np.asarray(one)) == key_of(np.asarray(other))
    return one == other


def refuse_pickle(kind: str, found: str, remedy: str) -> Callable[..., Any]:
    """A ``__reduce_ex__`` that raises an error with a remedy, for types that cannot be pickled."""

    def __reduce_ex__(self: object, protocol: object) -> Any:
        raise Error(kind, found, "", remedy)

    return __reduce_ex__
