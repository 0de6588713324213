# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The asteroid's surface: metres as a function of a direction from its inside."""

from dataclasses import dataclass

import numpy as np

from .noise import directions, fractal_noise, gradient_noise, uniforms

HALF_AXES_M = np.array([168.0, 104.0, 88.0])
BEND_PER_M = 0.0009
COARSE_CRATERS, FINE_CRATERS = 46, 420
COARSE_BOULDERS, FINE_BOULDERS = 12, 1100
FRESH_CRATERS = (16, 29, 33, 39)  # the ones with bright rays


@dataclass
class Features:
    """Craters or boulders, in the order in which they came to be."""

    centres_m: np.ndarray  # (n, 3) on the smooth body
    radii_m: np.ndarray  # (n)
    right: np.ndarray  # (n, 3) unit vectors of a local frame
    ahead: np.ndarray  # (n, 3)
    character: np.ndarray  # (n) 0..1: depth, tone


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def body_radius_m(direction):
    """A lumpy ellipsoid with a waist."""
    x = direction[..., 0]
    ellipsoid = 1.0 / np.sqrt(np.sum((direction / HALF_AXES_M) ** 2, axis=-1))
    waist = 1.0 - 0.17 * np.exp(-(((x - 0.28) / 0.30) ** 2))
    return ellipsoid * waist * (1.0 + 0.17 * fractal_noise(1.25 * direction + 7.3, 11, 3, 0.45))


def smoothness(direction):
    """0 on rocky ground, 1 where fine regolith has filled the ground."""
    return np.clip(0.3 + 2.4 * fractal_noise(1.3 * direction + 3.1, 23, 2), 0.0, 1.0)


def make_features(seed, count, smallest_m, largest_m, exponent):
    """Radii fall with a power law: number above r ~ r^-exponent."""
    where = unit(directions(seed, count) * HALF_AXES_M)  # as dense at the ends as amidships
    share = uniforms(seed + 1, count)
    low, high = smallest_m**-exponent, largest_m**-exponent
    radii = (low + share * (high - low)) ** (-1.0 / exponent)
    right = unit(np.cross(where, directions(seed + 2, count)))
    return Features(where * body_radius_m(where)[:, None], radii, right, np.cross(where, right),
                    uniforms(seed + 3, count))


def make_craters(coarse):
    if coarse:
        craters = make_features(101, COARSE_CRATERS, 9.0, 46.0, 1.7)
        craters.character[list(FRESH_CRATERS)] = 1.0
        return craters
    return make_features(201, FINE_CRATERS, 1.8, 9.0, 2.0)


def make_boulders(coarse):
    if coarse:
        return make_features(301, COARSE_BOULDERS, 6.5, 11.0, 2.0)
    return make_features(401, FINE_BOULDERS, 1.2, 6.5, 2.2)


def local_frame(features, k, points, reach):
    """Points within reach x radius of feature k: their indices, distance, right and ahead in radii.

    The points are sorted by x, so that only a slice of them is looked at.
    """
    centre, radius = features.centres_m[k], features.radii_m[k]
    first, last = np.searchsorted(points[:, 0], centre[0] + np.array([-reach, reach]) * radius)
    offset = (points[first:last] - centre) / radius
    distance2 = np.sum(offset * offset, axis=-1)
    near = np.nonzero(distance2 < reach * reach)[0]
    offset = offset[near]
    right = np.sum(offset * features.right[k], axis=-1)
    ahead = np.sum(offset * features.ahead[k], axis=-1)
    return first + near, np.sqrt(distance2[near]), right, ahead


def crater_height(x, radius_m, character):
    """Bowl, rim and ejecta blanket (smooth minimum) over x = distance / radius."""
    depth = (0.13 + 0.20 * character) * radius_m
    rim = (0.05 + 0.05 * character) * radius_m
    bowl = -depth + (depth + rim) * np.minimum(x, 1.6) ** 2.2
    blanket = rim * np.maximum(x, 0.5) ** -3.0
    blend = 0.35 * rim
    gap = np.clip(0.5 + 0.5 * (blanket - bowl) / blend, 0.0, 1.0)
    return blanket + (bowl - blanket) * gap - blend * gap * (1.0 - gap)


def rays(x, right, ahead, k):
    """Brightness of ejecta rays around a fresh crater, 0..1."""
    angle = np.arctan2(ahead, right)
    phase = 2.0 * np.pi * uniforms(900 + k, 4)
    streak = np.zeros_like(x)
    for n, (spokes, power) in enumerate(((5, 6), (7, 9), (11, 14), (17, 8))):
        spoke = 0.5 + 0.5 * np.cos(spokes * angle + phase[n] + 0.9 * np.sin(2.0 * angle + phase[0]))
        streak = np.maximum(streak, (1.0 - 0.15 * n) * spoke**power)
    near = np.exp(-(np.maximum(x - 1.0, 0.0) ** 2) / 0.5)
    far = np.maximum(0.0, 1.0 - x / 5.5) ** 1.3
    return np.clip(0.75 * near + far * streak, 0.0, 1.0)


def add_craters(craters, points, height, tone, fresh=()):
    """Digs craters one after another: a later one wipes out what was in its bowl."""
    for k, radius in enumerate(craters.radii_m):
        reach = 5.5 if k in fresh else 3.2
        near, x, right, ahead = local_frame(craters, k, points, reach)
        if near.size == 0:
            continue
        wiped = 0.8 * np.clip(1.25 - x, 0.0, 1.0) ** 0.5
        fade = np.clip(3.2 - x, 0.0, 1.0)
        height[near] = height[near] * (1.0 - wiped)
        height[near] += fade * crater_height(x, radius, craters.character[k])
        tone[near] += 0.05 * (craters.character[k] - 0.4) * np.clip(1.3 - x, 0.0, 1.0)
        if k in fresh:
            tone[near] += 0.20 * rays(x, right, ahead, k)


def add_boulders(boulders, points, height, tone, ground):
    """Angular blocks (a superellipse in plan), half buried where the ground is smooth."""
    for k, radius in enumerate(boulders.radii_m):
        near, _, right, ahead = local_frame(boulders, k, points, 1.5)
        if near.size == 0:
            continue
        stretch = 1.0 + 0.3 * boulders.character[k]
        ragged = 1.0 + 0.35 * gradient_noise(2.2 * points[near] / radius + 5.0, 500 + k)
        x = (np.abs(right * stretch) ** 3 + np.abs(ahead) ** 3) * ragged**3
        shape = np.clip(1.0 - x, 0.0, 1.0) ** 0.8
        bare = 1.0 - 0.85 * ground[near]
        height[near] += 0.62 * radius * bare * shape * (1.0 + 0.35 * right)
        tone[near] += (0.26 * boulders.character[k] - 0.10) * bare * np.clip(4.0 * shape, 0.0, 1.0)


def surface(direction, fine):
    """Points (n, 3) in metres and albedo tone (n) for unit directions (n, 3).

    Without fine, only what the mesh can hold is there: nothing much smaller than its edges.
    """
    radius = body_radius_m(direction)
    order = np.argsort(direction[:, 0] * radius, kind="stable")
    direction, radius = direction[order], radius[order]
    smooth_points = direction * radius[:, None]
    ground = smoothness(direction)
    height, tone = np.zeros(len(direction)), np.zeros(len(direction))
    height += 5.0 * fractal_noise(smooth_points / 60.0, 31, 2)
    add_craters(make_craters(True), smooth_points, height, tone, FRESH_CRATERS)
    add_boulders(make_boulders(True), smooth_points, height, tone, 0.5 * ground)
    height += 0.9 * (1.0 - 0.7 * ground) * fractal_noise(smooth_points / 22.0, 37, 1)
    if fine:
        add_craters(make_craters(False), smooth_points, height, tone)
        add_boulders(make_boulders(False), smooth_points, height, tone, ground)
        rough = fractal_noise(smooth_points / 9.0, 41, 4, 0.55)
        height += (0.75 - 0.45 * ground) * rough
        tone += 0.06 * rough - 0.07 * ground + 0.08 * fractal_noise(smooth_points / 70.0, 53, 3)
    points = direction * (radius + height)[:, None]
    points[:, 1] += BEND_PER_M * points[:, 0] ** 2
    back = np.argsort(order)
    return points[back], tone[back]
