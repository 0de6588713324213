# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""LAS files, read by laspy."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

import glidar

laspy = pytest.importorskip("laspy")

STREET = Path(__file__).parents[2] / "examples" / "street.yaml"
HALF_STEP_M = 0.5e-4  # coordinates are multiples of 0.1 mm
ROUNDING_M = 1e-9  # of double, for the largest coordinates here
LEAP_SECONDS = 18
GPS_EPOCH_S = 315964800


@pytest.fixture(scope="module")
def frame():
    sensor = glidar.load_sensor("VLP-16", returns=["strongest", "last"])
    return glidar.simulate(glidar.Scene(STREET), sensor, pose=glidar.pose([0, 0, 2.0]), columns="all")


def written(measured, folder, **options):
    path = folder / "scan.las"
    measured.save(path, **options)
    return path, laspy.read(path)


def hits(frame, *columns):
    """Columns of the points that have a return."""
    cloud = frame.cloud(columns=["xyz", *columns])
    xyz = np.asarray(cloud["xyz"]).reshape(-1, 3)
    is_hit = np.isfinite(xyz).all(1)
    return [np.asarray(cloud[name]).reshape(len(xyz), -1).squeeze()[is_hit] for name in ("xyz", *columns)]


def test_coordinates_times_and_classes_are_those_of_the_cloud(frame, tmp_path):
    _, las = written(frame, tmp_path, columns=["xyz", "ring", "range", "normal"])
    xyz, stamp, classes, ring, normal = hits(frame, "stamp", "class", "ring", "normal")
    assert str(las.header.version) == "1.4" and las.header.point_format.id == 6
    assert len(las.points) == len(xyz) > 1000
    assert np.abs(np.asarray(las.xyz) - xyz).max() <= HALF_STEP_M + ROUNDING_M
    assert np.allclose(las.gps_time, stamp * 1e-9, rtol=0, atol=1e-9)  # of a simulation that starts at 0
    assert (np.asarray(las["class"]) == classes).all() and len(set(classes)) > 1
    assert (np.asarray(las.ring) == ring).all()
    assert (np.asarray(las.normal_z) == normal[:, 2]).all()
    assert not las.header.global_encoding.gps_time_type.value
    assert las.header.global_encoding.wkt


def test_classifications_are_the_codes_of_asprs_or_user_definable(frame, tmp_path):
    """LAS 1.4 R15, table 17; laspy's `class` has GLIDAR's own ids."""
    names = glidar.Scene(STREET).class_names
    _, las = written(frame, tmp_path)
    found = {names[own]: code for own, code in zip(np.asarray(las["class"]), np.asarray(las.classification))}
    standard = {"road": 11, "pavement": 2, "building": 6, "tree": 5}
    assert set(standard) <= set(found)
    for name, code in found.items():
        assert code == standard.get(name, 63 + names.index(name)), name


def test_points_without_a_class_are_unclassified(tmp_path):
    frame = glidar.simulate(glidar.Scene("builtin:box"), glidar.camera(8, 8, fov_deg=20.0), pose=glidar.look_at([5, 0, 0], [0, 0, 0]))
    _, las = written(frame, tmp_path)
    assert set(np.asarray(las.classification)) == {1} and set(np.asarray(las["class"])) == {0}


@pytest.mark.parametrize("size_m", [1e-2, 2e-4, 1e-7])
def test_small_objects_keep_their_shape(size_m, tmp_path):
    scene = tmp_path / "scene.yaml"
    scene.write_text(f"models: [{{model: 'builtin:sphere', scale: {size_m}}}]\n")
    frame = glidar.simulate(glidar.Scene(scene), glidar.camera(32, 32, fov_deg=20.0),
                            pose=glidar.look_at([5 * size_m, 0, 0], [0, 0, 0]))  # fmt: skip
    _, las = written(frame, tmp_path)
    xyz = np.asarray(frame.cloud(columns=["xyz"], drop_invalid=True)["xyz"]).reshape(-1, 3)
    assert len(xyz) > 100
    assert np.abs(np.asarray(las.xyz) - xyz).max() <= 1e-6 * np.ptp(xyz, axis=0).max()


def test_a_cloud_that_32_bits_store_coarsely_is_written_with_a_warning(tmp_path):
    (tmp_path / "scene.yaml").write_text("models: [{model: 'builtin:plane', scale: 4.0e+6}]\nsensor_pose: {look_at: {eye: [0, 0, 3.0e+6], target: [0, 0, 0]}}\n")
    done = subprocess.run(["glidar", "render", "scene.yaml", "-o", "a.las"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "glidar: warning: a.las: LAS stores coordinates in 32 bits" in done.stderr
    las = laspy.read(tmp_path / "a.las")
    step_m = las.header.scales[0]
    assert step_m > 1e-4 and f"in steps of {step_m:g} m" in done.stderr


def test_bounds_and_counts_of_the_header_are_those_of_the_points(frame, tmp_path):
    _, las = written(frame, tmp_path)
    assert np.allclose(las.header.mins, las.xyz.min(0), rtol=0, atol=ROUNDING_M)
    assert np.allclose(las.header.maxs, las.xyz.max(0), rtol=0, atol=ROUNDING_M)
    counts = np.bincount(np.asarray(las.return_number), minlength=16)[1:16]
    assert (np.asarray(las.header.number_of_points_by_return) == counts).all()


def test_returns_are_counted_by_range_within_their_pulse(frame, tmp_path):
    _, las = written(frame, tmp_path)
    row, column = np.asarray(las.row), np.asarray(las.col)
    pulse = (row % 16).astype(int) * 10000 + column  # 16 rows for each of the two returns
    number, total, ranges = (np.asarray(x) for x in (las.return_number, las.number_of_returns, las["range"]))
    two = 0
    for one in np.unique(pulse):
        of_pulse = np.flatnonzero(pulse == one)
        of_pulse = of_pulse[np.argsort(ranges[of_pulse], kind="stable")]
        assert list(number[of_pulse]) == list(range(1, len(of_pulse) + 1))
        assert (total[of_pulse] == len(of_pulse)).all()
        two += len(of_pulse) == 2
    assert two > 0


def test_intensities_are_those_of_kitti_files(frame, tmp_path):
    _, las = written(frame, tmp_path)
    frame.save(tmp_path / "scan.bin")
    kitti = np.fromfile(tmp_path / "scan.bin", np.float32).reshape(-1, 4)[:, 3]
    assert np.abs(np.asarray(las.intensity) / 65535 - kitti).max() <= 0.5 / 65535 + 1e-7


def test_dates_are_adjusted_standard_gps_time(tmp_path):
    at_s = 1_780_000_000
    sensor = glidar.camera(8, 8, fov_deg=20.0).replace(rate_hz=0.5)
    frame = glidar.simulate(glidar.Scene("builtin:box"), sensor, pose=glidar.look_at([5, 0, 0], [0, 0, 0]), frame=at_s // 2)
    _, las = written(frame, tmp_path)
    assert las.header.global_encoding.gps_time_type.value
    assert abs(las.gps_time[0] - (at_s - GPS_EPOCH_S + LEAP_SECONDS - 1e9)) < 1e-6


@pytest.mark.parametrize("place_m", [1e5, 1e9])
def test_far_coordinates_have_an_offset_and_keep_their_resolution(place_m, tmp_path):
    scene = tmp_path / "scene.yaml"
    scene.write_text(f"models: [{{model: 'builtin:sphere', pose: {{position: [{place_m}, 0, 0]}}}}]\n")
    frame = glidar.simulate(glidar.Scene(scene), glidar.camera(32, 32, fov_deg=20.0),
                            pose=glidar.look_at([place_m + 5, 0, 0], [place_m, 0, 0]))  # fmt: skip
    _, las = written(frame, tmp_path, frame="world")
    cloud = frame.cloud(columns=["xyz"], frame="world", drop_invalid=True)
    assert las.header.offsets[0] == pytest.approx(place_m, abs=2.0)
    extent_m = np.ptp(np.asarray(cloud["xyz"]).reshape(-1, 3), axis=0).max()
    assert np.allclose(las.header.scales, 10.0 ** np.floor(np.log10(extent_m * 1e-6)), rtol=1e-12, atol=0)
    double_m = np.spacing(place_m)
    assert np.abs(np.asarray(las.xyz) - np.asarray(cloud["xyz"]).reshape(-1, 3)).max() <= HALF_STEP_M + double_m


def test_a_frame_without_returns_is_a_file_without_points(tmp_path):
    frame = glidar.simulate(glidar.Scene("builtin:box"), glidar.camera(8, 8, fov_deg=20.0), pose=glidar.look_at([5, 0, 0], [9, 0, 0]))
    _, las = written(frame, tmp_path)
    assert len(las.points) == 0


def test_laspy_converts_it_to_laz(frame, tmp_path):
    pytest.importorskip("lazrs")
    path, las = written(frame, tmp_path)
    las.write(tmp_path / "scan.laz")
    again = laspy.read(tmp_path / "scan.laz")
    assert (again.points.array == las.points.array).all()
    assert (tmp_path / "scan.laz").stat().st_size < path.stat().st_size


def test_the_same_cloud_has_the_same_bytes(frame, tmp_path):
    frame.save(tmp_path / "a.las")
    frame.save(tmp_path / "b.las")
    assert (tmp_path / "a.las").read_bytes() == (tmp_path / "b.las").read_bytes()
