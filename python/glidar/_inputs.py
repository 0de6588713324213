# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of arguments, and their conversion to arrays that the extension accepts."""

from __future__ import annotations

import logging
import operator
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, excerpt, shown

FloatArray: TypeAlias = npt.NDArray[np.float64]
MAX_UINT32 = 2**32 - 1
MAX_UINT64 = 2**64 - 1
MAX_TIME_NS = 9_200_000_000_000_000_000
MAX_PATH_LENGTH = 4096
_NOT_ENCODABLE = re.compile("[\0\ud800-\udfff]")

_LOGGER = logging.getLogger("glidar")
_DEFAULT_COLUMNS = ("xyz", "intensity", "range", "normal", "instance", "class")


def log(severity: str, message: str) -> None:
    """Forwards a message of the library to the logger "glidar"."""
    _LOGGER.log(logging.WARNING if severity == "warning" else logging.INFO, message)


def shape_text(shape: Iterable[int | None]) -> str:
    """(3, 4) as "3 x 4", with n for any size."""
    return " x ".join("n" if size is None else str(size) for size in shape)


def _fits(size: int, wanted: int | None) -> bool:
    return size > 0 if wanted is None else size == wanted


def numbers(value: object, where: str, shape: Sequence[int | None], allowed: str = "") -> npt.NDArray[Any]:
    """Converts to an array in native byte order whatever NumPy can convert; errors list the shape, or `allowed`."""
    try:
        array = np.asarray(value)
        return array if array.dtype.isnative else array.astype(array.dtype.newbyteorder("="))
    except (TypeError, ValueError, RuntimeError) as problem:  # ragged, or in the memory of another device
        raise Error(where, f"not an array: {excerpt(problem)}", allowed or f"an array {shape_text(shape)}") from problem


def floats(value: object, where: str, shape: Sequence[int | None]) -> FloatArray:
    """Converts to an array of finite float64 of this shape, in C order; None matches any size from 1."""
    given = np.asarray(value) if type(value) is np.ndarray else numbers(value, where, shape)
    if given.dtype.kind not in "fiu":
        allowed = f"an array {shape_text(shape)} of real numbers" if shape else "a real number"
        raise Error(where, f"an array of {given.dtype}", allowed)
    if len(given.shape) != len(shape) or not all(map(_fits, given.shape, shape)):
        found = shape_text(given.shape) or "of one number"
        raise Error(where, f"an array {found}", f"an array {shape_text(shape)}" if shape else "one number")
    result: FloatArray = np.asarray(given, dtype=np.float64, order="C")
    if not np.isfinite(result).all():
        place = np.argwhere(~np.isfinite(result))[0]
        at = f" at [{', '.join(map(str, place))}]" if len(place) else ""
        raise Error(where, f"{result[tuple(place)]}{at}", "finite numbers" if shape else "a finite number")
    return result


def number_of(value: object, where: str) -> float:
    """A real number, which may be infinite or NaN."""
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        return float(value)
    raise Error(where, shown(value), "a number")


def whole(value: object, where: str, maximum: int) -> int:
    """A whole number from 0 to `maximum`."""
    try:
        number = -1 if isinstance(value, bool) else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        number = -1
    if not 0 <= number <= maximum:
        raise Error(where, shown(value), f"a whole number from 0 to {maximum}")
    return number


def times_ns(value: object, where: str) -> npt.NDArray[np.int64]:
    """Times (N,) in whole nanoseconds."""
    given = numbers(value, where, (None,))
    if given.ndim != 1 or given.size == 0 or given.dtype.kind not in "iu":
        raise Error(where, f"an array {shape_text(given.shape)} of {given.dtype}", "an array n of whole numbers")
    if max(-int(given.min()), int(given.max())) > MAX_TIME_NS:
        raise Error(where, f"{given[np.abs(given.astype(float)).argmax()]}", "nanoseconds from -9.2e18 to 9.2e18")
    return np.ascontiguousarray(given, np.int64)


def whole_numbers(value: object, where: str, count: int, bits: int) -> npt.NDArray[Any]:
    """`count` whole numbers from 0 to 2**bits - 1, given as an array, or as one for all."""
    dtype = np.dtype(f"uint{bits}")
    allowed = f"{count} whole numbers from 0 to {2**bits - 1}, or one for all"
    given = numbers(value, where, (count,), allowed)
    if given.ndim == 0:
        return np.full(count, whole(value, where, 2**bits - 1), dtype)
    if given.shape != (count,) or given.dtype.kind not in "iu":
        raise Error(where, f"an array {shape_text(given.shape)} of {given.dtype}", allowed)
    if count and (int(given.min()) < 0 or int(given.max()) > 2**bits - 1):
        raise Error(where, f"numbers from {given.min()} to {given.max()}", allowed)
    return np.ascontiguousarray(given, dtype=dtype)


def text_of(value: object, where: str) -> str:
    """A string without zero bytes and unpaired surrogates."""
    if isinstance(value, str) and not _NOT_ENCODABLE.search(value):
        return value
    raise Error(where, shown(value), "a string")


def text_list(value: object, where: str) -> list[str]:
    """A list of strings, or one string."""
    if isinstance(value, str):
        return [text_of(value, where)]
    if not isinstance(value, Iterable):
        raise Error(where, shown(value), "a list of strings")
    return [text_of(one, where) for one in value]


def path_of(value: object, where: str) -> str:
    """A name or a path, as a string."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise Error(where, f"a {type(value).__name__}", "a name or a path")
    path = os.fsdecode(value)
    if len(path) > MAX_PATH_LENGTH or _NOT_ENCODABLE.search(path):
        raise Error(where, shown(value), f"at most {MAX_PATH_LENGTH} characters in UTF-8 without zero bytes", "rename the file")
    return path


def one_of(value: str, where: str, words: Sequence[str]) -> str:
    """A string that is in the list of allowed ones."""
    if isinstance(value, str) and value in words:
        return value
    raise Error(where, shown(value), ", ".join(words))


def column_list(columns: str | Iterable[str] | None) -> list[str]:
    """Names of cloud columns: a list, "a,b", "all", or None or "default" for the default columns of files."""
    if columns is None or columns == "default":
        return list(_DEFAULT_COLUMNS)
    if columns == "all":
        return _core.cloud_column_names()
    if not isinstance(columns, Iterable):
        raise Error("columns", shown(columns), "names of columns")
    names = columns.split(",") if isinstance(columns, str) else columns
    return list(dict.fromkeys(text_of(name, "columns") for name in names))
