# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Rays and triangles that are hard to decide, for hit_rule_test.py: (origin, direction, corners a, b, c)."""

import math
import random
import struct


def to_float(value):
    """The nearest float32, as a double."""
    return struct.unpack("f", struct.pack("f", value))[0]


def point(rng, half):
    return [rng.uniform(-half, half) for _ in range(3)]


def corner(rng, half):
    return [to_float(x) for x in point(rng, half)]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v] if length > 0.0 else [1.0, 0.0, 0.0]


def minus(p, q):
    return [a - b for a, b in zip(p, q)]


def along(p, q, part):
    return [a + part * (b - a) for a, b in zip(p, q)]


def towards(origin, target):
    largest = max(abs(x) for x in minus(target, origin))
    return unit([x / largest for x in minus(target, origin)]) if largest > 0.0 else [0.0, 0.0, 1.0]


def random_case(rng):
    corners = [corner(rng, 1.0) for _ in range(3)]
    inside = [sum(c[k] for c in corners) / 3.0 + rng.uniform(-0.3, 0.3) for k in range(3)]
    origin = point(rng, 5.0)
    return origin, towards(origin, inside), corners


def at_vertex(rng):
    origin, _, corners = random_case(rng)
    return origin, towards(origin, rng.choice(corners)), corners


def at_edge(rng):
    origin, _, corners = random_case(rng)
    return origin, towards(origin, along(corners[0], corners[1], rng.random())), corners


def edge_on(rng):
    _, _, corners = random_case(rng)
    in_plane = along(along(corners[0], corners[1], rng.uniform(-3, 3)), corners[2], rng.uniform(-3, 3))
    return in_plane, towards(in_plane, along(corners[1], corners[2], rng.random())), corners


def far_away(rng):
    origin, direction, corners = random_case(rng)
    target = [sum(c[k] for c in corners) / 3.0 for k in range(3)]
    distance = 10.0 ** rng.uniform(3, 60)
    direction = unit(point(rng, 1.0))
    origin = [t - distance * d for t, d in zip(target, direction)]
    return origin, direction, corners


def of_any_scale(rng, low=-44, high=38, maker=None):
    origin, direction, corners = (maker or rng.choice([random_case, at_vertex, at_edge]))(rng)
    scale = 10.0 ** rng.uniform(low, high)
    corners = [[to_float(scale * x) for x in c] for c in corners]
    origin = [scale * x for x in origin]
    return origin, towards(origin, rng.choice(corners)) if rng.random() < 0.5 else direction, corners


def denormal(rng):
    """Vertices among the smallest floats; the origin may be smaller still."""
    corners = [[rng.randint(-8, 8) * 2.0**-149 for _ in range(3)] for _ in range(3)]
    origin = [rng.randint(-8, 8) * 2.0 ** rng.choice([-149, -150, -400, -1074]) for _ in range(3)]
    return origin, unit([rng.randint(-3, 3) for _ in range(3)]), corners


def needle(rng):
    """A triangle without area, or nearly."""
    a, b = corner(rng, 1.0), corner(rng, 1.0)
    c = [to_float(x) for x in along(a, b, rng.random())]
    k = rng.randrange(3)
    c[k] = to_float(c[k] * (1.0 + rng.choice([0.0, 1e-7, -1e-7, 1e-6])))
    if rng.random() < 0.1:
        c = list(b)
    origin = point(rng, 2.0)
    return origin, towards(origin, along(a, b, rng.random())), rng.sample([a, b, c], 3)


def lattice(rng):
    """Small integers: exact zeros of every kind, and of both signs."""
    number = lambda: rng.choice([-2.0, -1.0, -0.0, 0.0, 1.0, 2.0])  # noqa: E731
    corners = [[number() for _ in range(3)] for _ in range(3)]
    direction = [number() for _ in range(3)]
    if not any(direction):
        direction[rng.randrange(3)] = 1.0
    return [number() for _ in range(3)], direction, corners


def on_the_triangle(rng):
    """The origin is a vertex, or on an edge, or within the triangle."""
    _, _, corners = random_case(rng)
    origin = along(corners[0], corners[1], rng.choice([0.0, rng.random()]))
    origin = along(origin, corners[2], rng.choice([0.0, rng.random()]))
    return origin, unit(point(rng, 1.0)), corners


def slanted(rng):
    """Directions with components that are tiny, or equal."""
    origin, _, corners = random_case(rng)
    direction = [rng.choice([1.0, -1.0, 1e-300, -5e-324, 1e-17, 0.0]) for _ in range(3)]
    direction[rng.randrange(3)] = rng.choice([1.0, -1.0])
    k = rng.randrange(3)
    target = along(corners[k], corners[(k + 1) % 3], rng.choice([0.0, 0.5, rng.random()]))
    return [t - 4.0 * d for t, d in zip(target, direction)] if rng.random() < 0.8 else origin, direction, corners


MAKERS = [random_case, at_vertex, at_edge, edge_on, far_away, of_any_scale, denormal, needle, lattice, on_the_triangle,
          slanted]


def make_cases(count, seed):
    """`count` cases of all kinds in turn, always the same."""
    rng = random.Random(seed)
    return [MAKERS[i % len(MAKERS)](rng) for i in range(count)]
