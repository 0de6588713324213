# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Objects can be pickled, copied and compared without loss."""

import copy
import gc
import pickle

import numpy as np
import pytest
from conftest import ROOT, TRAJECTORIES, again, same

import glidar
from glidar._recipe import Recipe

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_sensor_survives_pickling(protocol):
    for sensor in (glidar.load_sensor("VLP-16"), glidar.load_sensor("Kinect-v2"), glidar.camera(64, 48)):
        back = again(sensor, protocol)
        assert back == sensor
        assert hash(back) == hash(sensor)
        assert back.describe() == sensor.describe()
        assert back.ray_directions.tobytes() == sensor.ray_directions.tobytes()


def test_every_preset_survives_pickling_and_conversion_to_a_dict():
    for name in glidar.sensor_names():
        sensor = glidar.load_sensor(name)
        for back in (again(sensor), glidar.Sensor.from_dict(sensor.to_dict())):
            assert back == sensor, name
            assert back.notes == sensor.notes, name
            assert back.describe() == sensor.describe(), name
            assert back.ray_directions.tobytes() == sensor.ray_directions.tobytes(), name


def test_notes_of_every_calibrated_preset_survive_pickling_and_conversion_to_a_dict(tmp_path):
    tried = set()
    for name in glidar.sensor_names():
        sensor = glidar.load_sensor(name)
        if sensor.kind not in ("camera", "spinning"):
            continue
        calibration = tmp_path / ("camera.yaml" if sensor.kind == "camera" else "times.csv")
        if sensor.kind == "camera":
            calibration.write_text("cam0: {camera_model: pinhole, intrinsics: [600, 600, 320, 240], resolution: [640, 480], "
                                   "T_cam_imu: 'a: \"text\" {x}'}\n", encoding="utf-8")
        else:
            channels = len(sensor.to_dict()["optics"]["elevation_deg"])
            loops = len(sensor.to_dict()["optics"].get("firing_loops", [])) or 2
            rows = [",".join([str(i + 1), *["1"] * loops]) for i in range(channels)]
            calibration.write_text("\n".join(["Channel" + ",fire time(us)" * loops, *rows]), encoding="utf-8")
        calibrated = sensor.replace(calibration=calibration)
        tried.add((sensor.kind, len(calibrated.notes)))
        for back in (again(calibrated), glidar.Sensor.from_dict(calibrated.to_dict())):
            assert back.notes == calibrated.notes, name
            assert back == calibrated, name
    assert {("camera", 1), ("spinning", 1)} <= tried


def test_sensors_are_equal_regardless_of_their_notes():
    described = {"optics": {"width": 4, "height": 3, "fov_deg": 20}}
    plain, noted = glidar.Sensor.from_dict(described), glidar.Sensor.from_dict({**described, "notes": ["a: b"]})
    assert (plain.notes, noted.notes) == ([], ["a: b"])
    assert plain == noted
    assert hash(plain) == hash(noted)
    assert "notes" not in plain.to_dict()


def test_sensors_that_differ_in_one_number_are_not_equal():
    near = glidar.camera(8, 8, fov_deg=20.0)
    assert near == glidar.camera(8, 8, fov_deg=20.0)
    assert near != glidar.camera(8, 8, fov_deg=np.nextafter(20.0, 21.0))
    assert near != glidar.camera(8, 8, fov_deg=20.0, name="other")
    assert near != "camera"
    assert len({near, glidar.camera(8, 8, fov_deg=20.0), near.ground_truth()}) == 1  # a camera without noise is ideal


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_scene_survives_pickling(built, protocol):
    back = again(built, protocol)
    assert back == built
    assert [o.name for o in back] == [o.name for o in built]
    assert back.class_names == built.class_names
    for one, other in zip(back, built, strict=True):
        assert one.mesh == other.mesh
        assert (one.id, one.class_name, one.scale, one.source) == (other.id, other.class_name, other.scale, other.source)
        assert one.pose.tobytes() == other.pose.tobytes()
        assert one.materials == other.materials


def test_unpickled_scenes_and_sensors_give_bit_identical_frames(built, noisy):
    scene, sensor = again((built, noisy))
    pose = glidar.look_at([6, 3, 2], [0, 0, 0])
    one = glidar.simulate(built, noisy, pose, seed=5, columns="all")
    other = glidar.simulate(scene, sensor, pose, seed=5, columns="all")
    assert one.hits > 100
    assert same(one, other)
    assert one == other


def test_a_scene_with_a_rig_and_motion_survives_pickling(tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_text(
        """models:
  - {model: "builtin:sphere", name: ball, pose: {position: [5, 0, 0]}, motion: {spin: {rate_deg_s: [0, 0, 70]}}}
  - {model: "builtin:box", name: box, pose: {position: [0, 5, 0]}}
sensors:
  - {name: front, sensor: VLP-16, pose: {position: [0, 0, 0.2]}}
  - {name: top, sensor: {optics: {width: 16, height: 16, fov_deg: 60}}}
rig_pose: {position: [0.2, 0, 0]}
rig_motion: {twist: {velocity_m_s: [0.5, 0, 0]}}
"""
    )
    scene = glidar.Scene(path)
    scene["box"].pose = glidar.pose([0, 6, 0])
    back = again(scene)
    assert back == scene
    assert back.rig == scene.rig
    for name, frame in glidar.simulate_rig(scene, seed=3).items():
        assert frame == glidar.simulate_rig(back, seed=3)[name]


def test_a_scene_from_a_dict_can_be_unpickled_in_another_folder(tmp_path, monkeypatch):
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    scene = glidar.Scene.from_dict({"models": [{"model": "models/satellite/satellite.obj"}]})
    stored = pickle.dumps(scene)
    monkeypatch.chdir("/")
    assert pickle.loads(stored) == scene
    relative = pickle.dumps(scene.objects[0])
    assert pickle.loads(relative).mesh == scene.objects[0].mesh


def test_unpickling_reports_a_changed_file(tmp_path):
    model = tmp_path / "one.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    stored = pickle.dumps(glidar.Scene(model))
    assert len(pickle.loads(stored)) == 1
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")
    with pytest.raises(glidar.Error, match="one.obj: the file has changed since the scene was pickled"):
        pickle.loads(stored)
    model.unlink()
    with pytest.raises(glidar.Error, match="one.obj: the pickled scene was read from this file, which is missing"):
        pickle.loads(stored)


def test_pickling_reports_a_file_that_changed_before(tmp_path):
    model = tmp_path / "one.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = glidar.Scene(model)
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")
    with pytest.raises(glidar.Error, match="another scene than the one that was pickled"):
        again(scene)
    model.unlink()
    with pytest.raises(glidar.Error, match="which is missing now"):
        pickle.dumps(scene)


def test_the_pickle_does_not_grow_when_an_object_moves_often(built):
    scene = copy.copy(built)
    scene["first"].pose = glidar.pose([0, 0, 1])
    before = len(pickle.dumps(scene))
    for k in range(1000):
        scene["first"].pose = glidar.pose([0, 0, 1 + k])
    assert abs(len(pickle.dumps(scene)) - before) < 100


def test_a_copy_of_a_scene_is_independent(built):
    for copied in (copy.copy(built), copy.deepcopy(built)):
        assert copied == built
        copied["first"].pose = glidar.pose([0, 0, 9])
        assert copied != built
        assert built["first"].pose[2, 3] == -1e7
        copied["first"].pose = built["first"].pose
        assert copied == built
    with pytest.raises(TypeError):
        hash(built)


def test_equality_of_scenes_depends_on_their_contents_only():
    one, other = glidar.Scene(), glidar.Scene()
    one.add_model("builtin:box", name="a", pose=glidar.pose([1, 2, 3]))
    box = other.add_model("builtin:box", name="b")
    assert one != other
    box.pose = glidar.pose([1, 2, 3])
    box.name = "a"
    assert one == other
    box.set_materials({"*": {"diffuse": [0.1, 0.1, 0.1]}})
    assert one != other


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize("kind", TRAJECTORIES)
def test_a_trajectory_survives_pickling(kind, protocol):
    one = TRAJECTORIES[kind]()
    back = again(one, protocol)
    times = np.linspace(-5, 50, 333)
    assert back == one
    assert hash(back) == hash(one)
    assert back.poses_at(times).tobytes() == one.poses_at(times).tobytes()
    assert one != TRAJECTORIES["spin" if kind != "spin" else "constant"]()
    assert copy.copy(one) is one
    assert copy.deepcopy(one) is one


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_frame_survives_pickling_with_all_its_functions(built, noisy, tmp_path, protocol):
    frame = glidar.simulate(built, noisy, seed=9, frame=4, columns="all", sensor_id=2)
    back = again(frame, protocol)
    assert back == frame
    assert hash(back) == hash(frame)
    assert (back.seed, back.number, back.sensor_id, back.stamp_ns) == (9, 4, 2, frame.stamp_ns)
    assert back.ground_truth.normal.tobytes() == frame.ground_truth.normal.tobytes()
    assert back.cloud("all", frame="world") == frame.cloud("all", frame="world")
    assert str(back.explain(100)) == str(frame.explain(100))
    assert np.array_equal(back.fisher_information().matrix, frame.fisher_information().matrix)
    for one, name in ((frame, "one.npz"), (back, "two.npz")):
        one.save(tmp_path / name, columns="all", sidecar=False)
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


def test_a_frame_with_motion_survives_pickling(asteroid):
    drive = glidar.Trajectory.timed([0, 1], np.stack([glidar.pose([-4, 0, 0]), glidar.pose([-3, 0, 0])]))
    spin = glidar.Trajectory.spin(np.eye(4), [0, 0, 2])
    frame = glidar.simulate(asteroid, "VLP-16", drive, objects=[spin], columns="all")
    back = again(frame)
    assert back == frame
    assert back.cloud(["xyz"], deskew=True) == frame.cloud(["xyz"], deskew=True)
    assert str(back.explain(0, drop_invalid=True)) == str(frame.explain(0, drop_invalid=True))


def test_a_frame_with_pointing_errors_survives_pickling(asteroid):
    jitter = {"type": "pointing_jitter", "sigma_azimuth_deg": 1.0, "sigma_elevation_deg": 1.0}
    frame = glidar.simulate(asteroid, glidar.camera(32, 24, fov_deg=30.0, noise=[jitter]), columns="all")
    back = again(frame)
    assert back == frame
    assert back.cloud(["xyz", "true_xyz"]) == frame.cloud(["xyz", "true_xyz"])


def test_an_unpickled_frame_reads_its_scene_on_first_use(tmp_path, camera):
    model = tmp_path / "one.obj"
    model.write_text("v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n")
    frame = glidar.simulate(glidar.Scene(model), camera, glidar.look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]))
    stored = pickle.dumps(frame)
    model.unlink()
    back = pickle.loads(stored)
    assert np.array_equal(back.range_m, frame.range_m, equal_nan=True)
    with pytest.raises(glidar.Error, match="which is missing"):
        back.cloud()


def test_an_unpickled_frame_needs_its_renderer_only_for_explain(asteroid, camera, tmp_path, monkeypatch):
    frame = glidar.simulate(asteroid, camera, columns="all")
    expected = frame.cloud("all"), str(frame.explain(1000))
    frame.save(tmp_path / "one.pcd")
    back = again(frame)
    with monkeypatch.context() as patch:

        def no_graphics(*_):
            raise glidar.Error("renderer", "no graphics device")

        patch.setattr(glidar._core, "make_simulator", no_graphics)
        assert back.cloud("all") == expected[0]
        back.save(tmp_path / "two.pcd")
        with pytest.raises(glidar.Error, match="no graphics device"):
            back.explain(1000)
    assert (tmp_path / "one.pcd").read_bytes() == (tmp_path / "two.pcd").read_bytes()
    sidecars = [(tmp_path / f"{name}.glidar.json").read_text().replace(f"{name}.pcd", "") for name in ("one", "two")]
    assert sidecars[0] == sidecars[1]
    assert str(back.explain(1000)) == expected[1]
    assert back.cloud("all") == expected[0]
    assert str(again(frame).explain(1000)) == expected[1]


def test_unpickled_frames_of_one_scene_restore_it_once(camera, monkeypatch):
    scene = glidar.Scene()
    scene.add_model("builtin:box", name="a box of this test alone")
    pickles = [pickle.dumps(glidar.simulate(scene, camera, seed=seed)) for seed in (1, 2, 3)]
    calls = []
    restored = Recipe.restored
    monkeypatch.setattr(Recipe, "restored", lambda state: (calls.append(state), restored(state))[1])
    for pickled in pickles:
        pickle.loads(pickled).cloud()
        gc.collect()
    assert len(calls) == 1


def test_a_pickled_frame_contains_the_scene_as_it_was_measured(built, camera):
    scene = copy.copy(built)
    frames = []
    for k in range(3):
        scene["sphere"].pose = glidar.pose([3, 0, 0.1 * k])
        frames.append(glidar.simulate(scene, camera, glidar.look_at([9, 0, 1], [3, 0, 0]), columns="all"))
    scene["sphere"].class_name = "late"
    stored = [pickle.dumps(frame) for frame in frames]
    for frame, text in zip(frames, stored, strict=True):
        back = pickle.loads(text)
        assert back.cloud("all", frame="world") == frame.cloud("all", frame="world")
        assert str(back.explain(1000)) == str(frame.explain(1000))


def test_frames_that_differ_in_one_number_are_not_equal(asteroid, noisy):
    pose = glidar.look_at([5, 0, 0], [0, 0, 0])
    frame = glidar.simulate(asteroid, noisy, pose, seed=1)
    assert frame == glidar.simulate(asteroid, noisy, pose, seed=1)
    assert frame != glidar.simulate(asteroid, noisy, pose, seed=2)
    assert frame != glidar.simulate(asteroid, noisy, pose, seed=1, columns=["xyz"])
    assert copy.copy(frame) is frame
    assert copy.deepcopy(frame) is frame


@pytest.mark.parametrize("drop_invalid", [False, True])
def test_a_cloud_survives_pickling(asteroid, camera, drop_invalid):
    cloud = glidar.simulate(asteroid, camera).cloud(["xyz", "intensity", "status"], drop_invalid=drop_invalid, frame="world")
    for protocol in PROTOCOLS:
        back = again(cloud, protocol)
        assert back == cloud
        assert list(back) == list(cloud)
        assert (back.frame_id, back.points) == (cloud.frame_id, cloud.points)
    shallow, deep = copy.copy(cloud), copy.deepcopy(cloud)
    assert np.shares_memory(shallow["xyz"], cloud["xyz"])
    deep["intensity"][0] = 7
    assert deep != cloud
    assert back == cloud


def test_large_arrays_are_pickled_out_of_band(asteroid, noisy):
    frame = glidar.simulate(asteroid, noisy, columns="all")
    for value in (frame, frame.cloud("all")):
        buffers = []
        stored = pickle.dumps(value, protocol=5, buffer_callback=buffers.append)
        outside = sum(len(b.raw()) for b in buffers)
        assert outside > 10 * noisy.rows * noisy.cols
        back = pickle.loads(stored, buffers=[bytes(b.raw()) for b in buffers])
        assert back == value
        if isinstance(back, glidar.Cloud):
            back["intensity"][0] = 7  # writable, even when the pickle's buffers are not


def test_small_types_survive_pickling(built, camera):
    frame = glidar.simulate(built, camera)
    mesh = built["first"].mesh
    assert again(mesh) == mesh
    assert mesh != built["sphere"].mesh
    with pytest.raises(TypeError):
        hash(mesh)
    assert np.array_equal(again(frame.ground_truth).range_m, frame.ground_truth.range_m, equal_nan=True)
    for value in (frame.explain(5), frame.fisher_information()):
        for back in (again(value), copy.copy(value), copy.deepcopy(value)):
            assert back == value
            assert hash(back) == hash(value)
            assert str(back) == str(value)
    assert frame.explain(5) != frame.explain(6)
    assert frame.fisher_information() != frame.fisher_information(sigma_m=0.02)
    assert again(frame.fisher_information()).to_dict() == frame.fisher_information().to_dict()
    assert again(glidar.Status.hit) is glidar.Status.hit
    first = built["first"]
    assert first == built["first"]
    assert first != built["second"]
    assert hash(first) == hash(built["first"])
    moved = copy.deepcopy(first)
    assert moved.name == "first"
    assert moved != first


def test_pickling_a_simulator_raises_an_error_with_a_remedy(asteroid, camera):
    simulator = glidar.Simulator(asteroid, camera)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        with pytest.raises(glidar.Error, match="cannot be pickled; pickle its scene and its sensor"):
            pickle.dumps(simulator, protocol)
    assert copy.copy(simulator) is simulator
    assert copy.deepcopy(simulator) is simulator
