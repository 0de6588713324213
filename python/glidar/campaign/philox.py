# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers that are a pure function of (campaign seed, trial, purpose).

Philox4x32-10 of Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3", SC'11, as
in glidar/math/random.cpp, vectorised over counters. Hence any trial can be sampled independently, in any order, on any
machine.
"""

import hashlib

import numpy as np

_ROUNDS = 10
_MULTIPLIERS = (np.uint64(0xD2511F53), np.uint64(0xCD9E8D57))
_WEYL = (0x9E3779B9, 0xBB67AE85)
_LOW = np.uint64(0xFFFFFFFF)
_SHIFT = np.uint64(32)


def philox4x32(counter, key):
    """Four words (N x 4, uint32) for each of N counters (N x 4) under one key (two words)."""
    c0, c1, c2, c3 = (np.asarray(counter)[:, i].astype(np.uint64) for i in range(4))
    k0, k1 = (int(word) & 0xFFFFFFFF for word in key)
    for _ in range(_ROUNDS):
        first, second = _MULTIPLIERS[0] * c0, _MULTIPLIERS[1] * c2
        c0, c1, c2, c3 = ((second >> _SHIFT) ^ c1 ^ np.uint64(k0), second & _LOW,
                          (first >> _SHIFT) ^ c3 ^ np.uint64(k1), first & _LOW)
        k0, k1 = (k0 + _WEYL[0]) & 0xFFFFFFFF, (k1 + _WEYL[1]) & 0xFFFFFFFF
    return np.stack([c0, c1, c2, c3], axis=1).astype(np.uint32)


def purpose_word(purpose):
    """32 bits of a hash of the purpose's name, so that purposes have different random numbers."""
    return int.from_bytes(hashlib.blake2s(purpose.encode(), digest_size=4).digest(), "little")


def words(seed, trials, purpose, block=0):
    """Four words for each trial: counter (trial low, trial high, purpose, block), key: the seed."""
    trials = np.asarray(trials, np.uint64)
    counter = np.empty((len(trials), 4), np.uint64)
    counter[:, 0] = trials & _LOW
    counter[:, 1] = trials >> _SHIFT
    counter[:, 2] = purpose_word(purpose)
    counter[:, 3] = block
    return philox4x32(counter, (seed & 0xFFFFFFFF, seed >> 32))


def uniforms(seed, trials, purpose, count):
    """N x count doubles strictly between 0 and 1, of 52 bits each: two words per number."""
    columns = []
    for block in range((count + 1) // 2):
        w = words(seed, trials, purpose, block).astype(np.uint64)
        for high, low in ((w[:, 0], w[:, 1]), (w[:, 2], w[:, 3])):
            bits = ((high >> np.uint64(6)) << np.uint64(26)) | (low >> np.uint64(6))
            columns.append((bits.astype(np.float64) + 0.5) * 2.0**-52)
    if not columns:
        return np.empty((len(trials), 0))
    return np.stack(columns[:count], axis=1)


def seeds(seed, trials):
    """The 64-bit seed of each trial's frame."""
    w = words(seed, trials, "frame seed").astype(np.uint64)
    return w[:, 0] | (w[:, 1] << _SHIFT)
