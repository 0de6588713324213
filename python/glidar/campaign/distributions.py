# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Distributions of single numbers and choices.

A distribution transforms `dims` numbers that are uniform between 0 and 1 by its inverse distribution function, or
enumerates `cells` values. Hence random numbers, Sobol sequences and Latin hypercubes all work with every distribution.
"""

from dataclasses import dataclass

import numpy as np

from glidar.campaign import yaml_file as yf
from glidar.campaign.portable import exp, log, ndtr, ndtri


@dataclass(frozen=True)
class Constant:
    value: float
    dims = 0
    cells = 1

    def sample(self, u, cell):
        return np.full(len(u), self.value)


@dataclass(frozen=True)
class Uniform:
    min: float
    max: float
    dims = 1
    cells = 1

    def sample(self, u, cell):
        return self.min + (self.max - self.min) * u[:, 0]


@dataclass(frozen=True)
class LogUniform:
    min: float
    max: float
    dims = 1
    cells = 1

    def sample(self, u, cell):
        return self.min * exp(log(self.max / self.min) * u[:, 0])


@dataclass(frozen=True)
class Normal:
    """A normal distribution, truncated to [min, max]: its inverse between the probabilities of the bounds."""

    mean: float
    sigma: float
    min: float
    max: float
    dims = 1
    cells = 1

    def sample(self, u, cell):
        # Probabilities near 1 have low resolution: above the mean, sample the mirrored lower tail.
        sigma = -self.sigma if self.min > self.mean else self.sigma
        begin, end = (ndtr((x - self.mean) / sigma) for x in (self.min, self.max))
        sample = self.mean + sigma * ndtri(begin + (end - begin) * u[:, 0])
        return np.clip(sample, self.min, self.max)


@dataclass(frozen=True)
class Choice:
    """One of the values, with weights that add up to 1."""

    values: tuple
    weights: tuple
    dims = 1
    cells = 1

    def indices(self, u, cell):
        edges = np.cumsum(self.weights)[:-1]
        return np.searchsorted(edges, u[:, 0], side="right")

    def sample(self, u, cell):
        return np.asarray(self.values)[self.indices(u, cell)]


@dataclass(frozen=True)
class Grid:
    """The values one after the other."""

    values: tuple
    dims = 0

    @property
    def cells(self):
        return len(self.values)

    def indices(self, u, cell):
        return np.asarray(cell, np.int64)

    def sample(self, u, cell):
        return np.asarray(self.values)[self.indices(u, cell)]


KINDS = ["uniform", "log_uniform", "normal", "choice", "grid"]


def _normal(field, rule):
    found = yf.require_keys(field, ["mean", "sigma", "min", "max"])
    mean = yf.number(yf.need(field, found, "mean"))
    sigma = yf.number(yf.need(field, found, "sigma"), yf.ABOVE_ZERO)
    low = yf.optional(found, "min", lambda f: yf.number(f, rule), rule.min)
    high = yf.optional(found, "max", lambda f: yf.number(f, rule), rule.max)
    if not low < high:
        yf.reject(field, f"min {low:g}, max {high:g}", "min below max")
    if low > mean + 8 * sigma or high < mean - 8 * sigma:
        yf.reject(field, f"[{low:g}, {high:g}] is more than 8 sigma from the mean {mean:g}",
                  "bounds that the distribution reaches")
    return Normal(mean, sigma, low, high)


def read_choice(field, read):
    """{choice: [..]}, or {choice: [..], weights: [..]}; `read` reads one of the values."""
    found = yf.require_keys(field, ["choice", "weights"])
    values = tuple(read(item) for item in yf.items(yf.need(field, found, "choice")))
    weights = np.ones(len(values))
    if "weights" in found:
        weights = np.array(yf.numbers(found["weights"], len(values), yf.FROM_ZERO))
        if not weights.sum() > 0:
            yf.reject(found["weights"], "all weights are 0", "at least one weight above 0")
    return Choice(values, tuple(weights / weights.sum()))


def read_grid(field, rule):
    """A list of values, or {from: , to: , count: }."""
    if field.kind == "list":
        return Grid(tuple(yf.number(item, rule) for item in yf.items(field)))
    found = yf.require_keys(field, ["from", "to", "count"])
    first, last = (yf.number(yf.need(field, found, key), rule) for key in ("from", "to"))
    count = yf.whole(yf.need(field, found, "count"), 1, 1 << 20)
    return Grid(tuple(float(x) for x in np.linspace(first, last, count)))


def read_distribution(field, rule=yf.ANY):
    """A number, or a map that describes a distribution; all its values must satisfy the rule."""
    if field.is_number():
        return Constant(yf.number(field, rule))
    if not yf.is_map(field):
        yf.reject(field, field.description, f"{rule.allowed}, or a map with one of {', '.join(KINDS)}")
    if "choice" in yf.entries(field):
        return read_choice(field, lambda item: yf.number(item, rule))
    kind, value = yf.only_key(field, KINDS)
    if kind == "uniform":
        return Uniform(*yf.span(value, rule))
    if kind == "log_uniform":
        positive = yf.Rule(max(rule.min, 0.0), rule.max, True, "a number above 0")
        return LogUniform(*yf.span(value, positive))
    if kind == "normal":
        return _normal(value, rule)
    return read_grid(value, rule)
