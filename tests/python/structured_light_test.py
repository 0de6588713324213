# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Structured light with NumPy arrays."""

import numpy as np
import pytest

import glidar

SETUP = {
    "camera": {"width": 96, "height": 64, "fx": 150.0, "fy": 150.0, "cx": 48.0, "cy": 32.0},
    "projector": {"width": 200, "height": 120, "fx": 220.0, "fy": 220.0, "cx": 100.0, "cy": 60.0},
    "projector_from_camera": {"position": [0.15, 0.0, 0.02], "rotation_vector": [0.0, -0.2, 0.0]},
    "patterns": {"steps": 5, "period_px": 24},
}


def rotation():
    cosine, sine = np.cos(-0.2), np.sin(-0.2)
    return np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])


def projector_columns():
    """The columns, between pixels, at which the projector sees a plane at an angle; and its depths."""
    v, u = np.mgrid[:64, :96]
    ray = np.stack([(u + 0.5 - 48) / 150, (v + 0.5 - 32) / 150, np.ones(u.shape)], axis=-1)
    depth = 0.9 / (1 + 0.3 * ray[..., 0] - 0.2 * ray[..., 1])  # n p = 0.9
    point = ray * depth[..., None] @ rotation().T + [0.15, 0.0, 0.02]
    return 220 * point[..., 0] / point[..., 2] + 100 - 0.5, depth


def images(patterns, columns, noise=0.0):
    """Linear between the pixels of the patterns, 16 bits."""
    line = patterns[:, 0].astype(float) / 255
    whole = np.clip(np.floor(columns).astype(int), 0, 198)
    share = columns - whole
    light = line[:, whole] * (1 - share) + line[:, whole + 1] * share
    levels = 3000 + 50000 * light + np.random.default_rng(2).normal(0, 1, light.shape) * noise
    return np.clip(levels, 0, 65534).round().astype(np.uint16)


def test_decodes_a_plane():
    scanner = glidar.StructuredLight(SETUP)
    columns, depth = projector_columns()
    found = scanner.decode(images(scanner.patterns(), columns))
    inside = (columns > 1) & (columns < 198)
    assert inside.mean() > 0.5
    assert (found.status[inside] == glidar.FringeStatus.valid).all()
    # patterns have 8 bits, and are linear between pixels: 24 / (2 pi) (1/255 + (2 pi / 24)^2 / 8) px at most
    assert abs(found.coordinate_px - columns)[inside].max() < 0.05
    assert abs(found.depth_m - depth)[inside].max() < 0.05 * 0.9**2 / (150 * 0.15)
    assert np.isnan(found.depth_m[columns < -0.6]).all()


def test_noise_of_the_phase_follows_its_law():
    scanner = glidar.StructuredLight(SETUP)
    columns, _ = projector_columns()
    exact, noisy = (scanner.decode(images(scanner.patterns(), columns, noise)) for noise in (0.0, 400.0))
    inside = (columns > 1) & (columns < 198) & (noisy.status == 0)
    turns = (noisy.phase_rad - exact.phase_rad)[inside] / (2 * np.pi)
    sigma_rad = 2 * np.pi * (turns - np.round(turns)).std()
    law = np.sqrt(2 / 5) * 400 / np.median(exact.modulation[inside])
    assert abs(sigma_rad / law - 1) < 0.05  # 5,000 samples: a standard error of 1 %


def test_explain_agrees_with_the_decoder():
    scanner = glidar.StructuredLight(SETUP)
    columns, _ = projector_columns()
    taken = images(scanner.patterns(), columns, 400.0)
    taken[:, 5, 40] = 3000  # a shadow
    found = scanner.decode(taken)
    for row, column in ((30, 50), (5, 40), (63, 95)):
        trace = scanner.explain(taken, column=column, row=row)
        assert trace.status == found.status[row, column]
        assert np.array_equal(trace.levels, taken[:, row, column])
        assert np.float32(trace.phase_rad) == found.phase_rad[row, column]
        assert np.float32(trace.modulation) == found.modulation[row, column]
        assert [test.name for test in trace.tests] == ["saturated", "low_modulation", "weak_code", "inconsistent", "outside"]
        assert all(test.passed for test in trace.tests) == (trace.status == glidar.FringeStatus.valid)
        if trace.status == glidar.FringeStatus.valid:
            assert np.float32(trace.coordinate_px) == found.coordinate_px[row, column]
    assert "pixel 40,5: low_modulation" in str(scanner.explain(taken, column=40, row=5))
    with pytest.raises(glidar.Error, match="columns 0 to 95"):
        scanner.explain(taken, column=96, row=0)


def test_images_have_any_byte_order():
    scanner = glidar.StructuredLight(SETUP)
    taken = images(scanner.patterns(), projector_columns()[0])
    native, big_endian = scanner.decode(taken), scanner.decode(taken.astype(">u2"))
    assert np.array_equal(native.depth_m, big_endian.depth_m, equal_nan=True)
    assert np.array_equal(native.status, big_endian.status)
    pair = [taken[0].astype(">u2"), np.roll(taken[0], 2).astype(">u2")]
    assert glidar.match_stereo(*pair, glidar.StereoOptions(disparities=32)).disparity_px.shape == taken[0].shape


def test_a_pixel_is_valid_only_if_it_has_a_depth():
    setup = {"camera": {"width": 64, "height": 4, "fx": 60, "fy": 60}, "projector": {"width": 64, "height": 4, "fx": 60, "fy": 60},
             "projector_from_camera": {"position": [1, 0, 0]}, "patterns": {"period_px": 16}}
    scanner = glidar.StructuredLight(setup)
    taken = (np.roll(scanner.patterns(), 2, axis=2) * 0.9).astype(np.uint8)
    found = scanner.decode(taken)
    assert np.array_equal(found.status == glidar.FringeStatus.valid, ~np.isnan(found.depth_m))
    assert (found.status == glidar.FringeStatus.inconsistent).sum() > 200
    assert scanner.explain(taken, column=30, row=1).status == found.status[1, 30]
    with pytest.raises(glidar.Error, match="position of the camera"):
        glidar.StructuredLight({**setup, "projector_from_camera": {"position": [0, 0, 0]}})


def test_files_and_dicts_are_the_same(tmp_path):
    path = tmp_path / "setup.yaml"
    path.write_text(str(SETUP).replace("'", ""), encoding="utf-8")
    assert np.array_equal(glidar.StructuredLight(path).patterns(), glidar.StructuredLight(SETUP).patterns())


def test_errors_name_what_is_wrong():
    with pytest.raises(glidar.Error, match="period_px"):
        glidar.StructuredLight({**SETUP, "patterns": {"period": 3}})
    with pytest.raises(glidar.Error, match="projector"):
        glidar.StructuredLight({key: SETUP[key] for key in ("camera", "projector_from_camera")})
    scanner = glidar.StructuredLight(SETUP)
    with pytest.raises(glidar.Error, match="one for each pattern"):
        scanner.decode(np.zeros((3, 64, 96), np.uint8))
    with pytest.raises(glidar.Error, match="uint8 or uint16"):
        scanner.decode(np.zeros((3, 64, 96)))
    with pytest.raises(glidar.Error, match="as the camera"):
        scanner.decode(np.zeros((len(scanner.patterns()), 4, 4), np.uint8))
