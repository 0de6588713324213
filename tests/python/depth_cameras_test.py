# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth cameras that are simulated from raw images: their arrays, pickles, dicts, errors, and traces of pixels."""

import copy

import numpy as np
import pytest
from conftest import again

import glidar

FOCAL_PX, BASELINE_M = 150.0, 0.05
WIDTH, HEIGHT = 160, 96
CAUSES = {"image_border", "no_texture", "ambiguous_match", "left_right_mismatch", "outside_search", "occluded",
          "projector_shadow"}
CAMERAS = {
    "active_stereo": {
        "baseline_m": BASELINE_M, "sub_rays": 2, "projector": {"origin_m": [0.025, 0, 0], "dots": 6000, "dot_width_deg": 0.5},
        "matcher": {"disparities": 48, "box_px": 7, "uniqueness_percent": 20}},
    "time_of_flight": {
        "signal_electrons": 200000, "ambient_electrons": 1000, "read_noise_electrons": 10, "sub_rays": 2, "bounce_rays": 4,
        "electrons_per_level": 4,
        "decoder": {"frequencies_hz": [50e6, 60e6], "taps": 4, "min_amplitude": 5, "edge_test": {}}},
}
OPTIONS = glidar.TofOptions(frequencies_hz=[50e6, 60e6], min_amplitude=5, edge_test=glidar.TofEdgeTest())


def camera(kind, **changes):
    return glidar.Sensor.from_dict({
        "optics": {"width": WIDTH, "height": HEIGHT, "fx": FOCAL_PX, "fy": FOCAL_PX}, "wavelength_nm": 850,
        "depth_model": "physical", "depth_camera": {"type": kind, **CAMERAS[kind], **changes}})


@pytest.fixture(scope="module")
def room():
    scene = glidar.Scene()
    scene.add_model("builtin:box:size=0.3", name="near", pose=glidar.pose([0.052, 0, 1.15]))
    scene.add_model("builtin:box:size=8,8,0.2", name="wall", pose=glidar.pose([0, 0, 1.6]))
    return scene


@pytest.fixture(scope="module")
def frames(room):
    return {kind: glidar.simulate(room, camera(kind), np.eye(4), seed=3, columns="all") for kind in CAMERAS}


def test_a_stereo_frame_has_its_images_and_disparities(frames):
    frame = frames["active_stereo"]
    assert list(frame.raw_images) == ["ir_left", "ir_right"]
    for image in frame.raw_images.values():
        assert (image.grey.shape, image.grey.dtype) == ((HEIGHT, WIDTH), np.uint8)
        assert (image.electrons.shape, image.electrons.dtype) == ((HEIGHT, WIDTH), np.float32)
        assert (image.electrons >= 0).all()
        # exposed to 0.21 of the full well on the left; noise, speckle and clipping move the mean grey a little
        assert image.grey.mean() == pytest.approx(0.21 * 255, rel=0.1)
    hit = frame.status == glidar.Status.hit
    assert 0.6 < hit.mean() < 1
    depth_m = frame.range_m * (frame.cloud(columns=["depth"])["depth"].reshape(HEIGHT, WIDTH) / frame.range_m)
    expected_m = np.floor(FOCAL_PX * BASELINE_M / frame.disparity_px.astype(np.float64) * 1000 + 0.5) / 1000
    assert np.abs(depth_m - expected_m)[hit].max() < 1e-6  # the column is a float
    assert np.isnan(frame.disparity_px[~hit & (frame.status >= glidar.Status.image_border)]).all()
    assert {glidar.Status(s).name for s in np.unique(frame.status[~hit])} <= CAUSES
    assert frame.tof is None


def test_the_images_matched_alone_have_the_disparities_of_the_frame(frames):
    frame = frames["active_stereo"]
    left, right = (frame.raw_images[name].grey for name in ("ir_left", "ir_right"))
    match = glidar.match_stereo(left, right, glidar.StereoOptions(disparities=48, box_px=7, uniqueness_percent=20))
    assert match.disparity_px.tobytes() == frame.disparity_px.tobytes()


def test_the_raw_images_decoded_alone_have_the_ranges_of_the_frame(room, frames):
    frame = frames["time_of_flight"]
    assert frame.tof.images.shape == (2, 4, HEIGHT, WIDTH)
    directions = camera("time_of_flight").ray_directions
    decoded = glidar.decode_tof(frame.tof.images, OPTIONS, depth_per_range=directions[..., 2].astype(np.float32))
    hit = frame.status == glidar.Status.hit
    assert (hit == (decoded.status == glidar.TofStatus.valid)).all()
    assert 0.8 < hit.mean() < 1  # without pixels at the edges of the near box
    assert np.unique(frame.status[~hit]).tolist() == [glidar.Status.filtered_edge]
    assert frame.range_m.tobytes() == decoded.range_m.tobytes()
    assert np.allclose(frame.tof.amplitude, decoded.amplitude.mean(axis=0), rtol=1e-6)
    assert ((frame.tof.bounced_share >= 0) & (frame.tof.bounced_share < 0.5)).all()
    assert frame.raw_images == {} and frame.disparity_px is None


@pytest.mark.parametrize("kind", CAMERAS)
def test_frames_survive_pickling_and_copying(frames, kind):
    frame = frames[kind]
    for back in (again(frame), copy.deepcopy(frame)):
        assert back == frame
        assert list(back.raw_images) == list(frame.raw_images)
        for name, image in frame.raw_images.items():
            assert back.raw_images[name].grey.tobytes() == image.grey.tobytes()
            assert back.raw_images[name].electrons.tobytes() == image.electrons.tobytes()
        if kind == "active_stereo":
            assert back.disparity_px.tobytes() == frame.disparity_px.tobytes()
        else:
            for name in ("images", "amplitude", "bounced_share"):
                assert getattr(back.tof, name).tobytes() == getattr(frame.tof, name).tobytes()
    assert str(again(frame).explain(row=48, col=60)) == str(frame.explain(row=48, col=60))


@pytest.mark.parametrize("kind", CAMERAS)
def test_sensors_survive_pickling_and_conversion_to_a_dict(room, frames, kind):
    sensor = camera(kind)
    for back in (again(sensor), glidar.Sensor.from_dict(sensor.to_dict())):
        assert back == sensor
        assert back.to_dict() == sensor.to_dict()
        assert glidar.simulate(room, back, np.eye(4), seed=3, columns="all") == frames[kind]
    assert sensor != camera(kind, sub_rays=3)
    described = sensor.to_dict()["depth_camera"]
    assert described["type"] == kind and described["sub_rays"] == 2


@pytest.mark.parametrize("kind", CAMERAS)
def test_threads_and_renderers_do_not_change_the_frame_and_seeds_do(room, frames, kind):
    for threads in (1, 2, 7):
        for renderer in ("rays", "auto"):
            simulator = glidar.Simulator(room, camera(kind), renderer=renderer, threads=threads)
            assert simulator.simulate(np.eye(4), seed=3, columns="all") == frames[kind], (threads, renderer)
    other = glidar.simulate(room, camera(kind), np.eye(4), seed=4, columns="all")
    assert other != frames[kind]
    assert other.ground_truth.range_m.tobytes() == frames[kind].ground_truth.range_m.tobytes()


@pytest.mark.parametrize("kind", CAMERAS)
def test_batches_have_the_frames_of_single_simulations(room, kind):
    sensor = camera(kind)
    poses = np.stack([np.eye(4), glidar.pose([0.02, 0, 0.1])])
    for k, frame in enumerate(glidar.simulate_batch(room, sensor, poses, [5, 6])):
        assert frame == glidar.simulate(room, sensor, poses[k], seed=5 + k)


def test_a_stereo_pixel_is_explained_with_the_numbers_of_the_frame(frames):
    frame = frames["active_stereo"]
    row, col = np.argwhere(frame.status == glidar.Status.hit)[3000]
    trace = frame.explain(row=int(row), col=int(col))
    assert trace.measured.status == glidar.Status.hit
    assert trace.measured.range_m == frame.range_m[row, col]
    assert f"grey {frame.raw_images['ir_left'].grey[row, col]}\n" in trace.text
    left, right = (frame.raw_images[name].grey for name in ("ir_left", "ir_right"))
    options = glidar.StereoOptions(disparities=48, box_px=7, uniqueness_percent=20)
    own = str(glidar.explain_stereo(left, right, options, column=int(col), row=int(row)))
    printed = "\n".join(line[10:] for line in trace.text.splitlines())
    assert own.strip() in printed


def test_a_hole_of_a_stereo_camera_is_explained_by_its_cause(frames):
    frame = frames["active_stereo"]
    row, col = np.argwhere(frame.status == glidar.Status.image_border)[0]
    trace = frame.explain(row=int(row), col=int(col))
    assert trace.measured.status == glidar.Status.image_border and np.isnan(trace.measured.range_m)
    assert "failed  border" in trace.text


def test_a_time_of_flight_pixel_is_explained_with_the_numbers_of_the_frame(frames):
    frame = frames["time_of_flight"]
    depth_per_range = camera("time_of_flight").ray_directions[..., 2].astype(np.float32)
    for status in (glidar.Status.hit, glidar.Status.filtered_edge):
        row, col = (int(i) for i in np.argwhere(frame.status == status)[40])
        trace = frame.explain(row=row, col=col)
        assert trace.measured.status == status
        np.testing.assert_equal(trace.measured.range_m, frame.range_m[row, col])
        own = glidar.explain_tof(frame.tof.images, OPTIONS, column=col, row=row, depth_per_range=depth_per_range)
        printed = "\n".join(line[10:] for line in trace.text.splitlines())
        assert str(own).strip() in printed
        assert f"{100 * frame.tof.bounced_share[row, col]:.2f} % of the illuminator's light" in trace.text


@pytest.mark.parametrize(("kind", "key", "value", "allowed"), [
    ("active_stereo", "baseline_m", 0.0, "metres above 0 and below 10"),
    ("active_stereo", "baseline_m", float("nan"), "metres above 0 and below 10"),
    ("active_stereo", "depth_unit_m", -0.001, "a finite number from 0"),
    ("active_stereo", "sub_rays", 17, "a whole number from 1 to 16"),
    ("active_stereo", "projector", {"power_w": float("inf")}, "a number from 0 to 1e6"),
    ("active_stereo", "projector", {"fov_x_deg": 171}, "degrees from 0.1 to 170"),
    ("active_stereo", "imager", {"bits": 17}, "a whole number from 8 to 16"),
    ("active_stereo", "imager", {"quantum_efficiency": 1.01}, "a number from 0 to 1"),
    ("active_stereo", "illumination", {"sun_direction": [0, 0, float("nan")]}, "a number from -1e6 to 1e6"),
    ("active_stereo", "matcher", {"a_factor": 0.2}, "a number from -0.15 to 0.15"),
    ("time_of_flight", "signal_electrons", 0, "a finite number above 0"),
    ("time_of_flight", "signal_electrons", float("nan"), "a finite number above 0"),
    ("time_of_flight", "contrast", [0.5], "one for each frequency, or none"),
    ("time_of_flight", "contrast", [0.5, 1.1], "a number above 0, up to 1"),
    ("time_of_flight", "bounces", 33, "a whole number from 0 to 32"),
    ("time_of_flight", "bounce_rays", 0, "a whole number from 1 to 4096"),
    ("time_of_flight", "waveform", "saw", "sine, triangle"),
    ("time_of_flight", "decoder", {"frequencies_hz": []}, "1 to 8 frequencies"),
    ("time_of_flight", "decoder", {"frequencies_hz": [0.5]}, "hertz from 1 to 1e12"),
    ("time_of_flight", "decoder", {"frequencies_hz": [1e6], "taps": 17}, "a whole number from 3 to 16"),
])
def test_values_out_of_bounds_are_refused_with_what_is_allowed(kind, key, value, allowed):
    with pytest.raises(glidar.Error) as refused:
        camera(kind, **{key: value})
    inner = next(iter(value)) if isinstance(value, dict) and len(value) == 1 else key
    assert inner in str(refused.value)
    assert allowed in str(refused.value)


@pytest.mark.parametrize(("kind", "wrong", "nearest"), [
    ("active_stereo", {"basline_m": 0.1}, "baseline_m"), ("active_stereo", {"matcher": {"disparites": 9}}, "disparities"),
    ("active_stereo", {"imager": {"auto_exposure": {"targt": 0.1}}}, "target"),
    ("time_of_flight", {"bounce_filter": 1}, "bounce_filter_px"),
    ("time_of_flight", {"decoder": {"frequencies_hz": [1e6], "edge_tst": {}}}, "edge_test"),
])
def test_unknown_keys_name_the_nearest_one(kind, wrong, nearest):
    with pytest.raises(glidar.Error, match=f"did you mean '{nearest}'"):
        camera(kind, **wrong)
