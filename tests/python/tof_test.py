# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The time-of-flight decoder with NumPy arrays, against formulas in NumPy."""

from dataclasses import replace

import numpy as np
import pytest

import glidar

LIGHT_M_PER_S = 299792458.0
FREQUENCIES_HZ = np.array([80e6, 16e6, 120e6])
KINECT = glidar.TofOptions.kinect_v2()


@pytest.fixture(scope="module")
def sample():
    return glidar.sample_tof_images()


def phasors(raw, gain=1.0):
    taps = raw.shape[1]
    turn = np.exp(2j * np.pi * np.arange(taps) / taps)
    return 2 / taps * np.einsum("k,fkyx->fyx", turn, raw.astype(np.float64)) * np.reshape(gain, (-1, 1, 1))


def smoothed(z, min_amplitude, weight):
    """The joint bilateral filter of 3x3 pixels by its definition, and its sum of phase changes; inner pixels."""
    offsets = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dy, dx) != (0, 0)]
    own = z[:, 1:-1, 1:-1]
    bright = np.abs(own) >= min_amplitude
    total, weights, changes = own.copy(), np.ones(own.shape), np.zeros(own.shape)
    for dy, dx in offsets:
        other = z[:, 1 + dy:z.shape[1] - 1 + dy, 1 + dx:z.shape[2] - 1 + dx]
        norm = np.maximum(np.abs(own) * np.abs(other), 1e-300)
        change = np.where(bright, 0.5 - 0.5 * (own * other.conj()).real / norm, 0.0)
        counts = (np.abs(other) >= np.where(bright, min_amplitude, 0.0)) & (np.abs(other) > 0)
        part = np.where(counts, np.exp(-(dy * dy + dx * dx) / 18 - weight * change), 0.0)
        total += part * other
        weights += part
        changes += np.where(counts, change, 0.0)
    return total / weights, changes.max(axis=0)


def kinect_range_m(z):
    """libfreenect2's unwrapping as a sequence of roundings, in units of 1/30 of the unambiguous range."""
    turns = np.mod(np.angle(z) / (2 * np.pi), 1.0)
    fine, coarse, finest = 3 * turns[0], 15 * turns[1], 2 * turns[2]
    fine = fine + 3 * np.floor((coarse - fine) / 3 + 0.5)
    parity = 2 * np.mod(np.abs(fine - finest) / 2, 1.0)
    late = (parity > 0.5) & (parity < 1.5)
    fine, coarse = fine + 15 * late, coarse + 15 * late
    finest = finest + 2 * np.floor((fine - finest) / 2 + 0.5)
    unwrapped = np.stack([fine / 3, coarse / 15, finest / 2])
    direction = FREQUENCIES_HZ / np.linalg.norm(FREQUENCIES_HZ)
    misfit = 2 * np.pi * np.linalg.norm(np.cross(unwrapped, direction, axisa=0), axis=-1)
    return unwrapped.mean(axis=0) * LIGHT_M_PER_S / (2 * FREQUENCIES_HZ.mean()), misfit


def test_the_kinect_decoder_equals_its_definition_in_numpy(sample):
    raw, depth_per_range, _ = sample
    measured = glidar.decode_tof(raw, KINECT, depth_per_range=depth_per_range)
    clean = np.where(np.isfinite(raw), raw, 0.0)
    saturated = ~np.isfinite(raw).all(axis=1)
    z = np.where(saturated, 0.0, phasors(clean, KINECT.amplitude_gain))
    z, changes = smoothed(z, 3.0, KINECT.filter.phase_weight)
    amplitude = np.abs(z)
    range_m, misfit = kinect_range_m(z)
    with np.errstate(divide="ignore"):
        limit = np.clip(12.8866 * amplitude.max(axis=0)**-0.5330578, 0.3490659, 0.6108653)
    depth_m = range_m * depth_per_range[1:-1, 1:-1]
    fits = (amplitude.min(axis=0) >= 3) & (amplitude.sum(axis=0) >= 10) & (misfit <= limit) & (range_m >= 0)
    before_edges = fits & (depth_m >= 0.5) & (depth_m <= 4.5) & ~saturated.any(axis=0)[1:-1, 1:-1] & (changes < 2.5)
    inner = measured.status[1:-1, 1:-1]
    valid = inner == glidar.TofStatus.valid
    assert valid.mean() > 0.6
    assert not (valid & ~before_edges).any()
    assert (before_edges & ~valid).mean() < 0.05  # those that fail the test of depth steps
    assert set(np.unique(inner[before_edges & ~valid])) == {glidar.TofStatus.edge}
    assert np.abs(measured.range_m[1:-1, 1:-1] - range_m)[valid].max() < 1e-9
    assert np.abs(measured.misfit_rad[1:-1, 1:-1] - misfit)[valid].max() < 1e-6


def test_edges_are_those_of_the_documented_steps(sample):
    raw, depth_per_range, _ = sample
    untested = glidar.decode_tof(raw, replace(KINECT, edge_test=None, near_m=0.0, far_m=np.inf),
                                 depth_per_range=depth_per_range)
    tested = glidar.decode_tof(raw, replace(KINECT, near_m=0.0, far_m=np.inf), depth_per_range=depth_per_range)
    found = [(y, x) for y, x in np.argwhere((tested.status == 7) & (untested.status == 0))]
    assert len(found) > 20
    sums = untested.amplitude.astype(np.float64).sum(axis=0)
    for y, x in found:
        window = np.s_[y - 1:y + 2, x - 1:x + 2]
        deviation = sums[window].std() / max(sums[window].mean(), 50.0)
        assert deviation >= 0.05
    for y, x in np.argwhere(tested.status == 0)[::97]:
        if 0 < y < 119 and 0 < x < 159:
            trace = glidar.explain_tof(raw, KINECT, column=int(x), row=int(y), depth_per_range=depth_per_range)
            assert trace.tests[-1].name == "edge" and trace.tests[-1].passed


@pytest.mark.parametrize("taps", [3, 4, 5, 8])
def test_any_number_of_steps_gives_the_range(taps):
    ranges_m = np.linspace(0.1, 14.0, 400).reshape(1, -1)
    frequencies_hz = [50e6, 40e6]
    phase = 4 * np.pi * np.reshape(frequencies_hz, (2, 1, 1, 1)) * ranges_m / LIGHT_M_PER_S
    steps = 2 * np.pi * np.arange(taps).reshape(1, -1, 1, 1) / taps
    raw = 70.0 + 100.0 * np.cos(phase - steps)
    measured = glidar.decode_tof(raw, glidar.TofOptions(frequencies_hz=frequencies_hz, taps=taps))
    assert np.abs(measured.range_m - ranges_m).max() < 1e-5
    assert np.allclose(measured.amplitude, 100.0, rtol=1e-5)


def test_integers_and_strides_are_accepted(sample):
    raw, depth_per_range, _ = sample
    whole = np.where(np.isfinite(raw), raw, 32767.0).astype(np.int16)
    first = glidar.decode_tof(raw, KINECT)
    second = glidar.decode_tof(np.asfortranarray(whole), KINECT, threads=3)
    assert first.status.tobytes() == second.status.tobytes()
    assert first.range_m.tobytes() == second.range_m.tobytes()


def test_explain_reports_the_failed_test(sample):
    raw, depth_per_range, is_illuminated = sample
    trace = glidar.explain_tof(raw, KINECT, column=48, row=97, depth_per_range=depth_per_range,
                               is_illuminated=is_illuminated)
    assert trace.status is glidar.TofStatus.low_signal
    assert [test.name for test in trace.tests if not test.passed][0] == "low_signal"
    assert trace.levels.shape == (3, 3) and len(trace.candidates) == 15
    assert str(trace).startswith("pixel 48,97: low_signal\nrange ")


def test_arguments_of_other_kinds_are_errors(sample):
    raw, _, _ = sample
    for arguments, message in (((raw[0], KINECT), "raw images: an array 3 x 120 x 160 of float32"),
                               ((raw.astype(complex), KINECT), "raw images: an array 3 x 3 x 120 x 160 of complex128"),
                               ((raw, {"taps": 3}), "options"),
                               ((raw, replace(KINECT, taps=4)), "there are 3 frequencies with 3 phase steps"),
                               ((raw, replace(KINECT, unwrapping="crt")), "time-of-flight option unwrapping"),
                               ((raw, replace(KINECT, filter=3)), "time-of-flight option filter: 3"),
                               ((raw, replace(KINECT, min_amplitude=-1)), "min_amplitude: is -1")):
        with pytest.raises(glidar.Error, match=message):
            glidar.decode_tof(*arguments)
    with pytest.raises(glidar.Error, match="depth_per_range: an array 3 of float64; allowed: an array 120 x 160"):
        glidar.decode_tof(raw, KINECT, depth_per_range=np.ones(3))
    with pytest.raises(glidar.Error, match="160,3 is outside the image"):
        glidar.explain_tof(raw, KINECT, column=160, row=3)
