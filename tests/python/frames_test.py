# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frames, ground truth and clouds as NumPy arrays."""

import gc

import numpy as np
import pytest

import glidar


@pytest.fixture(scope="module")
def frame(asteroid, noisy):
    return glidar.simulate(asteroid, noisy, columns="all")


def test_arrays_are_read_only_views_of_the_frames_memory(frame):
    for name in ("range_m", "intensity", "status"):
        one, other = getattr(frame, name), getattr(frame, name)
        assert one.shape == (48, 64)
        assert one.ctypes.data == other.ctypes.data
        assert not one.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            one[0, 0] = 0
    assert frame.ground_truth.normal.shape == (48, 64, 3)
    assert frame.ground_truth.normal.ctypes.data == frame.ground_truth.normal.ctypes.data


def test_arrays_outlive_their_frame(asteroid, camera):
    frame = glidar.simulate(asteroid, camera)
    kept, copy = frame.ground_truth.range_m, frame.ground_truth.range_m.copy()
    del frame
    gc.collect()
    glidar.simulate(asteroid, camera, glidar.look_at([9, 9, 9], [0, 0, 0]))
    assert kept.tobytes() == copy.tobytes()


def test_status_states_why_a_return_is_missing(frame):
    assert frame.hits == np.isfinite(frame.range_m).sum() == (frame.status == glidar.Status.hit).sum()
    assert (frame.status == glidar.Status.dropped).any()
    assert np.isfinite(frame.ground_truth.range_m[frame.status == glidar.Status.dropped]).all()
    assert np.isnan(frame.ground_truth.range_m[frame.status == glidar.Status.miss]).all()
    assert (frame.return_source[frame.status == glidar.Status.hit] == glidar.ReturnSource.surface).all()
    assert np.allclose(frame.sigma_m[frame.status == glidar.Status.hit], 0.01)


def test_sigma_of_a_sensor_without_noise_is_zero(asteroid, camera):
    sigma = glidar.simulate(asteroid, camera).sigma_m
    assert sigma.shape == (48, 64)
    assert (sigma == 0).all()


def test_ground_truth_of_a_sphere_is_exact():
    scene = glidar.Scene()
    ball = scene.add_model("builtin:sphere", scale=2.0, id=17, class_name="ball")
    frame = glidar.simulate(scene, glidar.camera(33, 33, fov_deg=5.0), glidar.look_at([10, 0, 0], [0, 0, 0]), columns="all")
    assert frame.ground_truth.range_m[16, 16] == pytest.approx(8.0, abs=2e-3)  # 5,120 triangles
    assert frame.ground_truth.normal[16, 16] == pytest.approx([0, 0, -1], abs=0.05)
    assert frame.ground_truth.object_point_m[16, 16] == pytest.approx([1, 0, 0], abs=2e-3)
    assert (frame.ground_truth.instance == 0).all()
    cloud = frame.cloud(["instance", "class"])
    assert (cloud["instance"] == 17).all()
    assert scene.class_names[cloud["class"][0, 0]] == "ball"
    assert ball.triangles == 5120


def test_missing_ground_truth_raises_an_error_with_a_remedy(asteroid, camera):
    frame = glidar.simulate(asteroid, camera)
    with pytest.raises(glidar.Error, match=r"ground_truth.colour: not kept; simulate\(..., columns='all'\)"):
        _ = frame.ground_truth.colour
    with pytest.raises(glidar.Error):
        frame.cloud(["colour"])


def test_arrays_of_clouds_belong_to_the_caller(frame):
    cloud = frame.cloud()
    assert list(cloud) == ["xyz", "intensity", "range", "normal", "instance", "class"]
    assert cloud["xyz"].shape == (48, 64, 3)
    cloud["xyz"][...] = 0.0
    assert np.isfinite(frame.range_m).any()
    assert not (frame.cloud()["xyz"] == 0.0).any()


def test_cloud_of_hits_only_is_flat(frame):
    cloud = frame.cloud(["range"], drop_invalid=True)
    assert cloud.points == frame.hits
    assert cloud["range"].shape == (frame.hits,)
    assert np.array_equal(cloud["range"], frame.range_m[frame.status == 0])


def test_clouds_in_different_coordinate_frames_differ_by_rigid_transforms(frame):
    sensor = frame.cloud(["xyz"], drop_invalid=True)
    world = frame.cloud(["xyz"], frame="world", drop_invalid=True)
    pose = frame.world_from_sensor
    assert world["xyz"] == pytest.approx(sensor["xyz"] @ pose[:3, :3].T + pose[:3, 3], abs=1e-12)
    assert world.world_from_cloud == pytest.approx(np.eye(4), abs=1e-15)
    assert world.frame_id == "world"
    ros = frame.cloud(["xyz"], frame="ros", drop_invalid=True)["xyz"]
    assert ros == pytest.approx(sensor["xyz"][:, [2, 0, 1]] * [1, -1, -1], abs=1e-12)


def test_errors_for_unknown_columns_and_frames_suggest_the_nearest_name(frame):
    with pytest.raises(glidar.Error, match="did you mean 'range'"):
        frame.cloud(["rnage"])
    with pytest.raises(glidar.Error, match="did you mean world"):
        frame.cloud(frame="wrold")
    with pytest.raises(glidar.Error, match="no column 'time'"):
        frame.cloud(["xyz"])["time"]


def test_columns_export_dlpack(frame):
    cloud = frame.cloud()
    for name, column in cloud.items():
        taken = np.from_dlpack(column)
        assert taken.ctypes.data == column.ctypes.data, name
    assert np.array_equal(np.from_dlpack(frame.range_m), frame.range_m, equal_nan=True)


def test_columns_become_tensors_without_a_copy(frame):
    torch = pytest.importorskip("torch")
    xyz = frame.cloud()["xyz"]
    assert torch.from_dlpack(xyz).data_ptr() == xyz.ctypes.data


def test_returns_of_a_lidar_are_stacked_in_rows():
    lidar = glidar.load_sensor("VLP-16")
    assert lidar.kind == "spinning"
    assert lidar.boresight == "x"
    frame = glidar.simulate(glidar.Scene("builtin:box"), lidar, np.eye(4), columns=["xyz", "time", "ring"])
    assert frame.rows == lidar.rows == 16 * lidar.returns
    cloud = frame.cloud(["time", "ring"])
    assert cloud["time"].dtype == np.uint32
    assert set(np.unique(cloud["ring"])) == set(range(16))


def test_trace_of_an_entry_lists_every_random_number(frame):
    index = int(np.flatnonzero(frame.status.ravel() == glidar.Status.hit)[5])
    trace = frame.explain(index)
    assert trace.entry == index
    assert len(trace.steps) == 2
    gaussian, dropout = trace.steps
    truth = frame.ground_truth.range_m.flat[index]
    drawn = gaussian.samples[0]
    assert drawn.distribution == "normal"
    assert gaussian.after.range_m == pytest.approx(truth + 0.01 * drawn.value, abs=1e-9)
    assert dropout.samples[0].probability == pytest.approx(0.1)
    assert dropout.after.range_m == frame.range_m.flat[index]
    assert "noise 1" in str(trace)
    assert frame.explain(row=index // 64, col=index % 64).text == trace.text
    assert frame.explain(5, drop_invalid=True).text == trace.text


def test_explain_rejects_entries_out_of_range(frame):
    for arguments in ({}, {"index": 1, "row": 1}, {"row": 1}, {"index": 48 * 64}, {"row": 48, "col": 0}):
        with pytest.raises(glidar.Error):
            frame.explain(**arguments)
    with pytest.raises(glidar.Error):
        frame.explain(frame.hits, drop_invalid=True)


def test_fisher_information_of_a_plane_has_three_degenerate_directions():
    plane = glidar.Scene("builtin:plane")
    frame = glidar.simulate(plane, glidar.camera(32, 32), glidar.look_at([0, 0, 2], [0, 0, 0], [0, 1, 0]), columns="all")
    information = frame.fisher_information(sigma_m=0.02)
    with pytest.raises(glidar.Error, match="instance: 99"):
        frame.fisher_information(instance=99)
    assert information.matrix.shape == (6, 6)
    assert np.allclose(information.matrix, information.matrix.T)
    assert [d.degenerate for d in information.directions] == [False] * 3 + [True] * 3
    # along the boresight, which is the plane's normal, every range contributes 1 / (sigma cos)^2
    cosines = frame.ground_truth.cos_incidence[frame.status == glidar.Status.hit]
    assert information.matrix[5, 5] == pytest.approx((1.0 / (0.02 * cosines.astype(float)) ** 2).sum(), rel=1e-6)
    assert np.isinf(information.bound).sum() == 3
    assert information.to_dict()["returns"] == information.returns
    assert "translation" in str(information)


def test_verify_passes_on_this_machine():
    found = glidar.verify()
    assert found.passed, str(found)
    assert len(found.rows) > 40
    assert all(row.compared_hits > 0 and row.rays > 0 for row in found.rows)
    assert {row.name for row in found.rows} == {
        "one shape at rest", "several instances", "above a planet", "scanner among bodies",
        "moving sensor and target", "sensor in traffic", "sensor on a vertex", "at vertices and edges", "beside the outline",
        "several tiles", "1,000 instances", "209,088 triangles", "culled back faces", "lens", "lidar equation", "footprint", "measured motion"}
    assert all(row.wrong_ids == 0 and row.range_error_ulp <= 1e-3 for row in found.rows if row.passed)
    assert all(row.known_failure for row in found.rows if row.verdict == "known failure")


def test_verify_marks_rows_that_are_not_applicable_to_a_camera_only_renderer():
    found = glidar.verify(renderer="raster")
    assert found.passed, str(found)
    left_out = {row.name for row in found.rows if row.verdict == "not applicable"}
    assert left_out == {
        "scanner among bodies", "moving sensor and target", "sensor in traffic", "at vertices and edges", "beside the outline",
        "lidar equation", "footprint", "measured motion"}
