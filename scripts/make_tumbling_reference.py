#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes tests/motion/tumbling_reference.csv: attitudes and rates of torque-free bodies.

Euler's equations and the quaternion's are integrated by Taylor series of order 48 in fixed-point
numbers of 512 bits, which shares nothing with the closed form under test. Every row is computed
twice, with steps of unlike length, and refused where the two differ by more than 1e-30.

usage: make_tumbling_reference.py tests/motion/tumbling_reference.csv
"""

import math
import sys
from fractions import Fraction
from multiprocessing import Pool

BITS = 512
ORDER = 48
ONE = 1 << BITS


def fixed(x):
    return int(Fraction(x) * ONE)


def product_term(a, b, k):
    """Coefficient k of the product of two Taylor series."""
    return sum(a[i] * b[k - i] for i in range(k + 1)) >> BITS


def taylor_step(moments, state, step):
    """state: quaternion (w, x, y, z) world from body, and rates; step a Fraction."""
    series = [[value] for value in state]
    qw, qx, qy, qz, x, y, z = series
    ratios = [(moments[(k + 1) % 3] - moments[(k + 2) % 3]) * ONE // moments[k] for k in range(3)]
    for k in range(ORDER):
        p = lambda a, b: product_term(a, b, k)
        slopes = [-(p(qx, x) + p(qy, y) + p(qz, z)) // 2, (p(qw, x) + p(qy, z) - p(qz, y)) // 2,
                  (p(qw, y) + p(qz, x) - p(qx, z)) // 2, (p(qw, z) + p(qx, y) - p(qy, x)) // 2,
                  ratios[0] * p(y, z) >> BITS, ratios[1] * p(z, x) >> BITS, ratios[2] * p(x, y) >> BITS]
        for one, slope in zip(series, slopes):
            one.append(slope // (k + 1))
    h = fixed(step)
    ends = []
    for one in series:
        total = 0
        for coefficient in reversed(one):
            total = coefficient + (total * h >> BITS)
        ends.append(total)
    return ends


def integrate(moments, rates, t_ns, turn_per_step):
    unit = Fraction(2) ** math.frexp(max(abs(rate) for rate in rates))[1]  # of rates and 1 / time
    time = Fraction(t_ns, 10 ** 9) * unit
    steps = max(1, math.ceil(time / Fraction(turn_per_step)))
    state = [ONE, 0, 0, 0] + [fixed(Fraction(rate) / unit) for rate in rates]
    numbers = [fixed(moment) for moment in moments]
    for _ in range(steps):
        state = taylor_step(numbers, state, time / steps)
    return state, unit


def row(case):
    moments, rates, t_ns = case
    (one, unit), (other, _) = (integrate(moments, rates, t_ns, turn) for turn in (0.35, 0.3))
    worst = max(abs(a - b) for a, b in zip(one, other))
    if worst * 10 ** 30 > ONE:
        raise ArithmeticError(f"{case}: the two integrations differ by {float(worst / ONE)}")
    values = [float(Fraction(value, ONE)) for value in one[:4]]
    values += [float(Fraction(value, ONE) * unit) for value in one[4:]]
    return ",".join([*map(repr, moments), *map(repr, rates), str(t_ns), *map(repr, values)])


def sphere(count):
    """Directions of a Fibonacci lattice."""
    for k in range(count):
        z = 1 - (2 * k + 1) / count
        angle = k * math.pi * (3 - math.sqrt(5))
        r = math.sqrt(1 - z * z)
        yield r * math.cos(angle), r * math.sin(angle), z


BODIES = [(1.0, 2.0, 2.5), (10.0, 10.0, 1.0), (1.0, 10.0, 10.0), (2.0, 2.0, 3.0), (1.0, 1.0, 1.0),
          (1.0, 1.0 + 1e-9, 1.0 + 2e-9), (10.0, 10.0 + 1e-6, 1.0), (1.0, 2.0, 3.0)]
OFF_AXIS = [0.0, 6.1e-18, 1e-60, 1e-9, 1e-3]


def cases():
    yield (10.0, 10.0, 1.0), (0.1, 0.0, 6.1e-18), 5 * 10 ** 9
    yield (1.0, 2.0, 2.5), (1e-17, 1.0, 1e-17), 10 ** 8
    for moments in BODIES:  # near every axis
        for axis in range(3):
            for k, off in enumerate(OFF_AXIS):
                rates = [off, off, off]
                rates[axis] = [0.1, 1.0, -3.0][k % 3]
                rates[(axis + 1) % 3] *= [1.0, -1.0, 0.0][k // 2]
                yield moments, tuple(rates), [123456789, 10 ** 9, 2 * 10 ** 9 + 7][(axis + k) % 3]
    for k, direction in enumerate(sphere(24)):  # all directions, rates from tiny to 10 rad/s
        rate = [1e-300, 1e-9, 1e-3, 0.1, 1.0, 10.0][k % 6]
        moments = BODIES[k % len(BODIES)]
        t_s = [100000, 10 ** 9, 3000, 50, 4, 0][k % 6]
        yield moments, tuple(rate * c for c in direction), t_s * 10 ** 9 + 987654321
    for t_ns in (10 ** 10, 9 * 10 ** 10):  # flips, and the separatrix
        yield (1.0, 2.0, 2.5), (1e-17, 1.0, 1e-17), t_ns
        yield (1.0, 2.0, 3.0), (0.3, 0.5, 0.1 * math.sqrt(3.0)), t_ns
    yield (1.0, 2.0, 2.5), (1e-5, 1e-4, 2e-5), 10 ** 15  # a million seconds


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with Pool(2) as pool:
        rows = pool.map(row, list(cases()), chunksize=1)
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write("# made by scripts/make_tumbling_reference.py: moments, rates in rad/s, time in ns;\n"
                   "# then quaternion w, x, y, z from the body at rest with the world at 0, and rates\n")
        file.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
