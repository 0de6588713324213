#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The hit rule against rational arithmetic, on cases that are hard to decide.

Doubles are dyadic rationals: scaled by a common power of two they are integers, which Python adds and multiplies
exactly. Two comparisons:
- The rule against itself: the sheared corners, computed here once more in doubles, and then everything exactly.
- The rule against the geometry: the shear is exact too. Where the ray is farther from all borders than the rounding of
  the shear, both must agree.
"""

import array
import os
import subprocess
import sys
import unittest
from fractions import Fraction
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from hit_cases import MAKERS, make_cases
from skipping import IN_CTEST, skip

DRIVER = os.environ.get("GLIDAR_HIT_RULE_DRIVER", "")
COUNT = 100_000
ROUNDING = 2.0**-53
TINY = 2.0**-240  # sheared coordinates below it count as zero


def integers(values):
    """The doubles as integers in units of 2^-shift, and the shift."""
    ratios = [x.as_integer_ratio() for x in values]
    shift = max(d.bit_length() for _, d in ratios) - 1
    return [n << (shift + 1 - d.bit_length()) for n, d in ratios], shift


def axes(direction):
    sizes = [abs(x) for x in direction]
    z = sizes.index(max(sizes))
    return (z + 1) % 3, (z + 2) % 3, z


def rounded_shear(origin, direction, corners):
    """The sheared corners as the rule defines them, in doubles."""
    kx, ky, kz = axes(direction)
    sx, sy = direction[kx] / direction[kz], direction[ky] / direction[kz]

    def kept(value):
        return 0.0 if abs(value) < TINY else value

    result = []
    for p in corners:
        z = p[kz] - origin[kz]
        result.append((kept((p[kx] - origin[kx]) - sx * z), kept((p[ky] - origin[ky]) - sy * z), kept(z)))
    return result


def exact_shear(origin, direction, corners):
    """The true sheared corners as integers, all in the same unit, z multiplied like x and y by the direction's."""
    kx, ky, kz = axes(direction)
    (o, d), corners = (origin, direction), list(corners)
    scaled_d, _ = integers(d)
    scaled, _ = integers([*o, *(x for p in corners for x in p)])
    o, corners = scaled[:3], [scaled[3 + 3 * k:6 + 3 * k] for k in range(3)]
    return [((p[kx] - o[kx]) * scaled_d[kz] - scaled_d[kx] * (p[kz] - o[kz]),
             (p[ky] - o[ky]) * scaled_d[kz] - scaled_d[ky] * (p[kz] - o[kz]),
             (p[kz] - o[kz]) * scaled_d[kz]) for p in corners]


def determinants(corners):
    a, b, c = corners
    return (c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0])


def is_crossed(signs):
    """True for the axis in the closed triangle that is not seen edge-on."""
    return (any(s < 0 for s in signs)) != (any(s > 0 for s in signs))


def cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def touching(signs, corners):
    """How far an origin is from a triangle's plane, as parts of what counts as zero for products and for the height;
    None if all corners are on one side, or a sliver's area is itself within rounding."""
    if min(p[2] for p in corners) > 0 or max(p[2] for p in corners) < 0:
        return None
    widths = [abs(p[0]) + abs(p[1]) for p in corners]
    sizes = [width + abs(p[2]) for width, p in zip(widths, corners)]
    room = sum((widths[i] * sizes[j] + widths[j] * sizes[i]) * abs(corners[k][2])
               for i, j, k in ((1, 2, 0), (0, 2, 1), (0, 1, 2)))
    volume = abs(sum(s * p[2] for s, p in zip(signs, corners)))
    a, b, c = corners
    area = sum(abs(x) for x in cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]))
    if volume == 0 or area << 40 <= max(sizes)**2:
        return Fraction(0), Fraction(0)
    return Fraction(volume << 49, room), Fraction(volume << 44, max(sizes) * area)


def depth(signs, corners):
    """z of the triangle at the axis."""
    return Fraction(sum(s * p[2] for s, p in zip(signs, corners)), sum(signs))


class HitRule(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cases = make_cases(COUNT, seed=20260101)
        numbers = array.array("d")
        for origin, direction, corners in cls.cases:
            numbers.extend([*origin, *direction, *(x for p in corners for x in p)])
        done = subprocess.run([DRIVER], input=numbers.tobytes(), capture_output=True, check=True)
        cls.distances = array.array("d", done.stdout)
        assert len(cls.distances) == COUNT

    def test_decides_exactly_about_its_sheared_corners(self):
        hits = [0] * len(MAKERS)
        for i, (case, distance) in enumerate(zip(self.cases, self.distances)):
            sheared = rounded_shear(*case)
            flat, shift = integers([x for p in sheared for x in p])
            corners = [flat[3 * k:3 * k + 3] for k in range(3)]
            signs = determinants(corners)
            if not is_crossed(signs):
                self.assertEqual(distance, 0.0, (i, case))
                continue
            parts = touching(signs, corners)
            if parts is not None and max(parts) < 0.5 and min(parts) > 0:
                self.assertEqual(distance, 0.0, (i, case))
                continue
            if parts is not None and max(parts) < 2:
                continue  # within rounding of what counts as touching
            along = case[1][axes(case[1])[2]]
            expected = depth(signs, corners) / 2**shift / Fraction(along)
            room = Fraction(16 * ROUNDING * max(abs(p[2]) for p in sheared) / abs(along)) + Fraction(TINY)
            if expected > room:
                self.assertGreater(distance, 0.0, (i, case))
            if expected < -room:
                self.assertEqual(distance, 0.0, (i, case))
            if distance > 0.0:
                self.assertLessEqual(abs(Fraction(distance) - expected), room, (i, case))
                hits[i % len(MAKERS)] += 1
        for maker, count in zip(MAKERS, hits):
            self.assertGreater(count, 0, maker.__name__)

    def test_agrees_with_the_geometry_away_from_borders(self):
        clear = 0
        for i, (case, distance) in enumerate(zip(self.cases, self.distances)):
            corners = exact_shear(*case)
            signs = determinants(corners)
            reach = max(abs(x) for p in corners for x in p)
            width = max(abs(x) for p in corners for x in p[:2])
            # eight roundings of each coordinate, and what is taken for zero
            wrong = (reach >> 50) + 1
            if min(abs(s) for s in signs) <= 4 * wrong * (width + wrong) or self.is_tiny(case):
                continue
            ahead = depth(signs, corners) if is_crossed(signs) else 0
            parts = touching(signs, corners)
            if is_crossed(signs) and (abs(ahead) <= wrong or (parts is not None and max(parts) < 4)):
                continue  # the origin is on the triangle
            clear += 1
            self.assertEqual(distance > 0.0, ahead > 0, (i, case))
        self.assertGreater(clear, COUNT // 5)

    @staticmethod
    def is_tiny(case):
        return all(abs(x) < 1e-60 for p in case[2] for x in (*p, *case[0]))


if __name__ == "__main__":
    if not DRIVER:
        skip("GLIDAR_HIT_RULE_DRIVER is not set", IN_CTEST)
    unittest.main()
