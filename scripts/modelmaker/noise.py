# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers and noise as pure functions of integers: the same for every numpy version."""

import numpy as np


def mix(values):
    """Scrambles uint32 values (Wellons' lowbias32 integer hash)."""
    x = np.asarray(values, dtype=np.uint32).copy()
    x ^= x >> np.uint32(16)
    x *= np.uint32(0x7FEB352D)
    x ^= x >> np.uint32(15)
    x *= np.uint32(0x846CA68B)
    x ^= x >> np.uint32(16)
    return x


def lattice_hash(seed, *coordinates):
    """One uint32 per integer lattice point."""
    state = mix(np.uint32(seed))
    for coordinate in coordinates:
        state = mix(state ^ np.asarray(coordinate).astype(np.int64).astype(np.uint32))
    return state


def uniforms(seed, *shape):
    """Numbers in (0, 1) of the given shape."""
    counters = np.arange(int(np.prod(shape)))
    return ((lattice_hash(seed, counters) + 0.5) / 2.0**32).reshape(shape)


def directions(seed, count):
    """Unit vectors, uniform on the sphere."""
    u = uniforms(seed, count, 2)
    z = 2.0 * u[:, 0] - 1.0
    azimuth = 2.0 * np.pi * u[:, 1]
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=-1)


def gradient_noise(points, seed, period=None):
    """Perlin's gradient noise, about -1..1, at points (..., 3); period in lattice cells."""
    points = np.asarray(points, dtype=np.float64)
    cell = np.floor(points)
    part = points - cell
    cell = cell.astype(np.int64)
    fade = part * part * part * (part * (part * 6.0 - 15.0) + 10.0)
    total = np.zeros(points.shape[:-1])
    for corner in np.ndindex(2, 2, 2):
        where = cell + np.array(corner)
        if period is not None:
            where = where % period
        slopes = lattice_hash(seed, where[..., 0], where[..., 1], where[..., 2])
        offset = part - np.array(corner, dtype=np.float64)
        weight = np.ones(points.shape[:-1])
        for axis in range(3):
            weight = weight * (fade[..., axis] if corner[axis] else 1.0 - fade[..., axis])
        dot = np.zeros(points.shape[:-1])
        for axis in range(3):
            step = (slopes >> np.uint32(8 * axis)) & np.uint32(0xFF)
            dot += (step / 127.5 - 1.0) * offset[..., axis]
        total += weight * dot
    return 1.4 * total


def fractal_noise(points, seed, octaves, gain=0.5, period=None):
    """Sum of gradient noise, each octave at twice the frequency and gain times the height."""
    points = np.asarray(points, dtype=np.float64)
    total = np.zeros(points.shape[:-1])
    for octave in range(octaves):
        scale = 2**octave
        repeat = None if period is None else period * scale
        total += gain**octave * gradient_noise(points * scale, seed + octave, repeat)
    return total
