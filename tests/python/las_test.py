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
    """Columns of the points that have a return, in the order of time, in the world."""
    names = list(dict.fromkeys(["xyz", *columns, "stamp", "row", "col", "range"]))
    cloud = frame.cloud(columns=names, frame="world", deskew=True)
    values = {name: np.asarray(cloud[name]).reshape(cloud["xyz"].shape[0] * cloud["xyz"].shape[1], -1) for name in names}
    is_hit = np.isfinite(values["xyz"]).all(1)
    values = {name: value[is_hit].squeeze() for name, value in values.items()}
    pulse = values["row"].astype(np.int64) % 16 * 100000 + values["col"]
    order = np.lexsort((values["range"], pulse, values["stamp"]))
    return [values[name][order] for name in ("xyz", *columns)]


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
    xyz = np.asarray(frame.cloud(columns=["xyz"], frame="world", drop_invalid=True)["xyz"]).reshape(-1, 3)
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
    kitti = np.sort(np.fromfile(tmp_path / "scan.bin", np.float32).reshape(-1, 4)[:, 3])
    assert np.abs(np.sort(np.asarray(las.intensity)) / 65535 - kitti).max() <= 0.5 / 65535 + 1e-7


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


def sensor_of(folder, text):
    (folder / "sensor.yaml").write_text(text)
    return glidar.load_sensor(folder / "sensor.yaml")


def ground():
    scene = glidar.Scene()
    scene.add_model("builtin:plane", scale=1000.0)
    return scene


def survey(folder, bidirectional=False, yaw_deg=0.0):
    """A line scanner 100 m above the ground that looks down; the upper side of the sensor is ahead."""
    sensor = sensor_of(folder, "{rate_hz: 10, optics: {type: line_scan, azimuth_deg: {from: -30, to: 30, count: 61}, "
                       f"elevation_deg: [0, 1], point_us: 1, bidirectional: {str(bidirectional).lower()}}}}}")  # fmt: skip
    yaw = np.radians(yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    pose = np.eye(4)
    pose[:3, :3] = turn @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])  # x down, y left, z ahead
    pose[:3, 3] = [3.0, 4.0, 100.0]
    scene = ground()
    return glidar.simulate(scene, sensor, pose=pose, columns="all"), turn


def expected_angles(las, eye, turn):
    ahead = turn @ np.array([1.0, 0, 0])
    right = np.cross(ahead, [0, 0, 1.0])
    ray = np.asarray(las.xyz) - eye
    return np.degrees(np.arctan2(ray @ right, -ray[:, 2]))


def test_points_are_in_the_order_of_time(frame, tmp_path):
    _, las = written(frame, tmp_path)
    assert (np.diff(np.asarray(las.gps_time)) >= 0).all() and len(set(np.asarray(las.gps_time))) > 1000


@pytest.mark.parametrize("yaw_deg", [0.0, 130.0])
def test_scan_angles_are_around_the_direction_of_flight(yaw_deg, tmp_path):
    measured, turn = survey(tmp_path, yaw_deg=yaw_deg)
    _, las = written(measured, tmp_path)
    angles = np.asarray(las.scan_angle) * 0.006
    assert len(angles) == 122 and np.abs(angles - expected_angles(las, [3.0, 4.0, 100.0], turn)).max() <= 0.0031
    assert angles.min() == pytest.approx(-30, abs=0.01) and angles.max() == pytest.approx(30, abs=0.01)


def test_the_last_points_of_lines_are_edges_and_directions_change_with_the_mirror(tmp_path):
    for bidirectional in (False, True):
        measured, _ = survey(tmp_path, bidirectional=bidirectional)
        _, las = written(measured, tmp_path)
        edge = np.asarray(las.edge_of_flight_line)
        assert list(np.flatnonzero(edge)) == [60, 121]
        # azimuths grow to the left, so scan angles fall
        direction = np.asarray(las.scan_direction_flag)
        assert set(direction[:61]) == {0} and set(direction[61:]) == {int(bidirectional)}


def test_scan_angles_follow_the_motion_of_the_sensor(tmp_path):
    """Level flight to the north of a spinning sensor: east is to the right."""
    sensor = sensor_of(tmp_path, "{rate_hz: 10, optics: {type: spinning, elevation_deg: [-30], columns_per_turn: 360}}")
    start = np.eye(4)
    start[:3, 3] = [0, 0, 10.0]
    motion = glidar.Trajectory.twist(start, linear_m_s=[0, 20.0, 0])
    frame = glidar.simulate(ground(), sensor, pose=motion, columns="all")
    _, las = written(frame, tmp_path, columns=["xyz", "sensor_pose"])
    place = np.array([np.asarray(las[name]) for name in ("sensor_pose_x", "sensor_pose_y", "sensor_pose_z")]).T
    ray = np.asarray(las.xyz) - place
    assert np.allclose(np.asarray(las.scan_angle) * 0.006, np.degrees(np.arctan2(ray[:, 0], -ray[:, 2])), rtol=0, atol=0.01)
    assert np.ptp(place[:, 1]) == pytest.approx(20.0 * 0.1 * 359 / 360, abs=1e-6)
    assert np.abs(np.asarray(las.z)).max() < 1e-3  # on the ground


def test_cameras_have_angles_but_no_scan_lines(tmp_path):
    frame = glidar.simulate(glidar.Scene("builtin:box"), glidar.camera(8, 8, fov_deg=20.0), pose=glidar.look_at([5, 0, 0], [0, 0, 0]))
    _, las = written(frame, tmp_path)
    assert not np.asarray(las.edge_of_flight_line).any() and len(set(np.asarray(las.scan_angle))) > 8


def crs_of(las):
    return next(vlr.string for vlr in las.header.vlrs if vlr.record_id == 2112)


@pytest.mark.parametrize(("code", "zone", "meridian"), [
    (32601, "WGS 84 / UTM zone 1N", -177), (32633, "WGS 84 / UTM zone 33N", 15), (32760, "WGS 84 / UTM zone 60S", 177),
    (25832, "ETRS89 / UTM zone 32N", 9), (26910, "NAD83 / UTM zone 10N", -123),
])  # fmt: skip
def test_codes_of_utm_zones_are_stored_as_well_known_text(code, zone, meridian, tmp_path):
    measured, _ = survey(tmp_path)
    _, las = written(measured, tmp_path, crs=f"EPSG:{code}")
    text = crs_of(las)
    assert text.startswith(f'PROJCS["{zone}",') and f'PARAMETER["central_meridian",{meridian}]' in text
    pyproj = pytest.importorskip("pyproj")
    crs = pyproj.CRS.from_wkt(text)
    assert crs.to_epsg() == code and crs.equals(pyproj.CRS.from_epsg(code), ignore_axis_order=True)


def test_well_known_text_and_files_with_it_are_stored(tmp_path):
    measured, _ = survey(tmp_path)
    text = 'LOCAL_CS["site",UNIT["metre",1]]'
    (tmp_path / "site.wkt").write_text(text.replace(",", ",\n    ") + "\n")
    _, las = written(measured, tmp_path, crs=text)
    assert crs_of(las) == text
    _, las = written(measured, tmp_path, crs=tmp_path / "site.wkt")
    assert crs_of(las).replace(" ", "") == text


@pytest.mark.parametrize(("crs", "message"), [
    ("EPSG:2154", "EPSG:2154 is not a UTM zone"), ("EPSG:32661", "EPSG:32661"), ("EPSG:", "'EPSG:'"),
    ("EPSG:32633x", "EPSG:32633x"), ('GEOGCS["WGS 84"]', "GEOGCS"), ('LOCAL_CS["a",UNIT["metre",1]', "brackets"),
    ('PROJCS["a",UNIT["foot",0.3048]]', "the unit"), ("no_such_file.wkt", "no_such_file.wkt"),
])  # fmt: skip
def test_other_coordinate_systems_are_refused_before_anything_is_written(crs, message, tmp_path):
    measured, _ = survey(tmp_path)
    with pytest.raises(glidar.Error, match=message):
        measured.save(tmp_path / "a.las", crs=crs)
    assert not (tmp_path / "a.las").exists()


def test_coordinates_of_the_sensor_have_no_coordinate_system_of_the_earth(tmp_path):
    measured, _ = survey(tmp_path)
    with pytest.raises(glidar.Error, match="leave the frame out"):
        measured.save(tmp_path / "a.las", crs="EPSG:32633", frame="sensor")
    done = subprocess.run(["glidar", "render", "builtin:box", "-o", "a.pcd", "--crs", "EPSG:32633"], cwd=tmp_path,
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 2 and "--crs" in done.stderr and not (tmp_path / "a.pcd").exists()


@pytest.mark.parametrize("scene", [str(STREET), "builtin:box:size=20,20,9"])
def test_explain_finds_a_point_by_its_number_in_the_file(scene, tmp_path):
    command = ["glidar", "render", scene, "--sensor", "VLP-16", "--eye", "0,0,2", "-o", "a.las", "--columns", "all", "--ground-truth"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    las = laspy.read(tmp_path / "a.las")
    index = len(las.points) // 3
    done = subprocess.run(["glidar", "explain", "a.las", "--index", str(index)], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert f"row {las.row[index]}, col {las.col[index]}," in done.stdout
