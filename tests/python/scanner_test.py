# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Structured-light cameras with NumPy arrays."""

import pickle

import numpy as np
import pytest

import glidar

KEYS = {
    "name": "scanner",
    "wavelength_nm": 460,
    "optics": {"type": "pinhole", "width": 64, "height": 48, "fov_x_deg": 20},
    "noise": [{"type": "range_gaussian", "sigma_m": 0.001}],
    "depth_model": "physical",
    "depth_camera": {
        "type": "structured_light",
        "projector": {"width": 128, "height": 80, "fov_x_deg": 24},
        "projector_from_camera": {"position": [-0.19403, 0, 0.04851], "rotation_vector": [0, 0.245, 0]},
        "patterns": {"steps": 4, "period_px": 16},
        "imager": {"focal_length_mm": 12, "f_number": 4, "auto_exposure": {"target": 0.3, "max_time_ms": 1000}},
    },
}


def changed(**keys):
    return glidar.Sensor.from_dict({**KEYS, "depth_camera": {**KEYS["depth_camera"], **keys}})


@pytest.fixture(scope="module", name="sensor")
def sensor_fixture():
    return glidar.Sensor.from_dict(KEYS)


@pytest.fixture(scope="module", name="frame")
def frame_fixture(sensor):
    return glidar.simulate(glidar.Scene("builtin:sphere:radius=0.1"), sensor, glidar.pose((0.0, 0.0, -0.8)))


def test_a_frame_has_an_image_of_each_pattern(frame):
    assert list(frame.raw_images) == [f"pattern_{i:02}" for i in range(12)]
    for image in frame.raw_images.values():
        assert image.grey.dtype == np.uint8
        assert image.grey.shape == image.electrons.shape == (48, 64)
    hit = frame.status == glidar.Status.hit
    assert hit.sum() > 300
    assert (frame.projector_px[hit] >= -0.5).all() and (frame.projector_px[hit] <= 127.5).all()


def test_the_electrons_of_a_code_and_its_inverse_add_up_to_white(frame):
    electrons = np.array([image.electrons for image in frame.raw_images.values()])
    sums = electrons[4::2] + electrons[5::2]
    assert np.allclose(sums, sums[0], rtol=1e-5)  # blur is linear, and sums are float


def test_decoding_the_images_gives_the_frame(frame, sensor):
    images = np.array([image.grey for image in frame.raw_images.values()])
    for setup in (sensor.to_dict(), KEYS):
        found = glidar.StructuredLight(setup).decode(images)
        assert np.array_equal(found.coordinate_px, frame.projector_px, equal_nan=True)
        hit = frame.status == glidar.Status.hit
        depth = frame.range_m * sensor.ray_directions[..., 2]
        assert np.allclose(found.depth_m[hit], depth[hit], rtol=1e-6)


def test_depths_are_true_within_their_noise(frame):
    surface = (frame.status == glidar.Status.hit) & (frame.return_source == glidar.ReturnSource.surface)
    error = (frame.range_m - frame.ground_truth.range_m)[surface]
    images = np.array([image.electrons for image in frame.raw_images.values()])[:4, surface]
    amplitude = np.abs(np.fft.fft(images, axis=0)[1]) / 2
    sigma_rad = np.sqrt(2 / 4) * np.sqrt(images.mean(axis=0) + 10**2) / amplitude
    projector_focal = 64 / np.tan(np.radians(12))
    sigma_m = 0.7**2 / (projector_focal * 0.2) * 16 / (2 * np.pi) * sigma_rad  # of parallel axes at the front of the sphere
    assert 0.7 < np.median(np.abs(error)) / (0.6745 * np.median(sigma_m)) < 1.6  # the sphere is from 0.7 to 0.77 m, and tilted


def test_causes_of_holes_are_named(frame):
    assert frame.status[0, 0] == glidar.Status.miss
    shadowed = frame.status == glidar.Status.projector_shadow
    assert np.isnan(frame.range_m[shadowed]).all()
    strict = glidar.simulate(glidar.Scene("builtin:sphere:radius=0.1"), changed(decoding={"min_modulation": 1000}),
                             glidar.pose((0.0, 0.0, -0.8)))
    assert strict.status[24, 32] == glidar.Status.low_modulation


def test_frames_and_sensors_are_restored_from_pickles(frame, sensor):
    copy = pickle.loads(pickle.dumps(frame))
    assert copy == frame
    assert list(copy.raw_images) == list(frame.raw_images)
    assert np.array_equal(copy.raw_images["pattern_07"].grey, frame.raw_images["pattern_07"].grey)
    assert np.array_equal(copy.projector_px, frame.projector_px, equal_nan=True)
    assert pickle.loads(pickle.dumps(sensor)) == sensor
    assert glidar.Sensor.from_dict(sensor.to_dict()).to_dict() == sensor.to_dict()


def test_explain_states_the_images_of_a_pixel(frame):
    text = str(frame.explain(row=24, col=32))
    levels = [image.grey[24, 32] for image in frame.raw_images.values()]
    assert "fringes: grey levels " + " ".join(map(str, levels[:4])) in text
    assert "passed  inconsistent" in text


def test_files_have_the_images(frame, tmp_path):
    frame.save(tmp_path / "a.patterns.npy")
    stored = np.load(tmp_path / "a.patterns.npy")
    assert stored.dtype == np.uint8
    assert np.array_equal(stored, [image.grey for image in frame.raw_images.values()])


def test_other_models_and_sensors_have_no_patterns():
    scene = glidar.Scene("builtin:sphere:radius=0.1")
    by_law = glidar.simulate(scene, glidar.Sensor.from_dict({**KEYS, "depth_model": "law"}), glidar.pose((0.0, 0.0, -0.8)))
    assert by_law.raw_images == {}
    assert by_law.projector_px is None


def test_errors_name_what_is_wrong(frame, tmp_path):
    with pytest.raises(glidar.Error, match="position of the camera"):
        changed(projector_from_camera={"position": [0, 0, 0]})
    with pytest.raises(glidar.Error, match="0, or 3 to 64"):
        changed(patterns={"steps": 1})
    with pytest.raises(glidar.Error, match=r"without the raw image 'ir_left'; allowed: \.patterns\.npy; "):
        frame.save(tmp_path / "a.ir_left.png")
    assert list(tmp_path.iterdir()) == []
