# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Errors, and interruption of long computations."""

import _thread
import logging
import os
import pickle
import signal
import threading
from itertools import starmap
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, poses_around
from waiting import MAX_WAIT_S, let_time_pass, wait_until

import glidar


def test_error_has_four_parts_and_can_be_pickled():
    with pytest.raises(glidar.Error) as caught:
        glidar.camera(fov_deg=200)
    error = caught.value
    assert error.where == "sensor: optics.fov_deg"
    assert error.found == "200"
    assert error.allowed == "degrees above 0 and below 180"
    assert error.remedy == ""
    assert str(error) == "sensor: optics.fov_deg: 200; allowed: degrees above 0 and below 180"
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.where) == (str(error), error.where)


def test_errors_are_one_printable_line():
    hostile = "a\x1b]0;T\x07\n\x9b\u202e\udcff"
    error = glidar.Error(hostile, hostile, hostile, hostile)
    for text in (error.where, error.found, error.allowed, error.remedy, str(error), repr(error)):
        assert text.isprintable() and "a?]0;T??" in text
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error)


def test_notes_are_one_printable_line(tmp_path, caplog):
    (tmp_path / "m.obj").write_text("mtllib \x1b[31m\u202e.mtl\no m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\x1b[2J\nf 1 2 3\n")
    with caplog.at_level(logging.INFO):
        glidar.Scene(tmp_path / "m.obj")
    assert caplog.messages and all(message.isprintable() for message in caplog.messages)


def interrupted(work, wait=lambda: let_time_pass(0.1)):
    """Does work until Ctrl-C, pressed once it has begun and `wait` returned, ends it."""
    begun = threading.Event()

    def press():
        begun.wait(MAX_WAIT_S)
        wait()
        _thread.interrupt_main()

    thread = threading.Thread(target=press)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        begun.set()
        work()
    thread.join()


def completed(function, *arguments):
    """What a function of the library returns, as a list, until Ctrl-C: nothing, if the call itself was ended. No code in
    Python runs between the end of the call and its result's place in the list, where Ctrl-C would be seen too."""
    results = []
    interrupted(lambda: results.extend(starmap(function, [arguments])))
    return results


def keys(count):
    return np.arange(count, dtype=np.uint64), np.zeros(count, np.uint32), 0, None


def test_ctrl_c_stops_a_batch_and_leaves_the_simulator_usable(asteroid):
    sensor = glidar.camera(256, 256)
    poses = poses_around(3000)
    core = glidar.Simulator(asteroid, sensor)._core
    hit_columns = glidar._core.hit_columns_for(["xyz"])
    assert completed(core.simulate, glidar._core.constant(poses, "poses"), None, keys(len(poses)), hit_columns) == []
    assert glidar.simulate(asteroid, sensor, poses[0]).hits > 0


def test_ctrl_c_stops_one_long_measurement(asteroid):
    simulator = glidar.Simulator(asteroid, glidar.camera(4000, 4000))
    hit_columns = glidar._core.hit_columns_for(["xyz"])
    assert completed(simulator._core.simulate, simulator._core.usual_motion(), None, keys(1), hit_columns) == []
    glidar.simulate(asteroid, glidar.camera(), poses_around(1)[0])


def test_a_signal_handler_measures_other_scenes_but_not_the_one_that_it_interrupts(asteroid):
    core = glidar.Simulator(asteroid, glidar.camera(256, 256))._core
    poses = glidar._core.constant(poses_around(3000), "poses")
    hit_columns = glidar._core.hit_columns_for(["xyz"])
    box, camera = glidar.Scene("builtin:box"), glidar.camera(8, 8)
    errors, hits = [], []

    def handle(_signal, _frame):
        try:
            glidar.simulate(asteroid, camera)
        except glidar.Error as error:  # else it runs between two measurements
            errors.append(str(error))
            hits.append(glidar.simulate(box, camera).hits)
            raise KeyboardInterrupt from None

    def press():
        while not errors:
            os.kill(os.getpid(), signal.SIGUSR1)
            let_time_pass(0.05)

    before = signal.signal(signal.SIGUSR1, handle)
    thread = threading.Thread(target=press)
    try:
        with pytest.raises(KeyboardInterrupt):
            thread.start()
            while True:
                core.simulate(poses, None, keys(3000), hit_columns)
        thread.join()
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert errors == ["scene: a signal handler uses the scene whose measurement it interrupts; allowed: another scene, or "
                      "this one after the measurement; set a flag in the handler, and act on it after the measurement"]
    assert hits[0] > 0
    assert glidar.simulate(asteroid, camera).hits > 0


def test_ctrl_c_stops_the_import_of_a_model_and_its_process(tmp_path, monkeypatch):
    helper = tmp_path / "helper"
    helper.write_text(f"#!/bin/sh\necho $$ > {tmp_path}/new\nmv {tmp_path}/new {tmp_path}/pid\nexec sleep 3600\n")
    helper.chmod(0o755)
    monkeypatch.setenv("GLIDAR_IMPORT_HELPER", str(helper))
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    interrupted(lambda: glidar.Scene(tmp_path / "a.obj"),
                lambda: wait_until((tmp_path / "pid").exists, "the helper program"))
    process = Path(f"/proc/{int((tmp_path / 'pid').read_text())}")
    assert not process.exists()


def test_ctrl_c_stops_verify():
    assert completed(glidar._core.verify, "rays", 1) == []


def test_messages_of_the_library_are_logged(caplog, tmp_path):
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd nowhere.png\n")
    with caplog.at_level(logging.INFO, "glidar"):
        glidar.Scene(tmp_path / "a.obj")
    assert any("nowhere.png" in record.message and record.levelname == "WARNING" for record in caplog.records)


def test_models_are_found_from_any_working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert glidar.Scene(ROOT / "models/satellite/satellite.obj").objects[0].triangles > 0
    assert np.isfinite(glidar.load_sensor("OS1-32").ray_directions).all()


ODD = [10**30, -1, 2**64, float("nan"), float("inf"), -0.5, "x", "\ud800", "a\0b", b"\xff", [], {}, [[1, 2], [3]], object(), 1e308,
       10**5000, "x" * 100_000, np.array([1 + 2j]), np.array(["a"]), (), "/dev/zero", "."]
SCENE, CAMERA = glidar.load_scene("builtin:box"), glidar.camera(8, 6)
EYE = np.eye(4)[None]
USES = {
    "load_scene": glidar.load_scene, "load_sensor": glidar.load_sensor, "sensor_file": glidar.sensor_file,
    "width": lambda v: glidar.camera(v, 4), "noise": lambda v: glidar.camera(4, 4, noise=v),
    "from_dict": glidar.Sensor.from_dict, "scene from_dict": glidar.Scene.from_dict,
    "key": lambda v: glidar.Sensor.from_dict({v: 1} if isinstance(v, (str, int, float)) else v),
    "pose": lambda v: glidar.simulate(SCENE, CAMERA, v), "seed": lambda v: glidar.simulate(SCENE, CAMERA, seed=v),
    "frame": lambda v: glidar.simulate(SCENE, CAMERA, frame=v), "columns": lambda v: glidar.simulate(SCENE, CAMERA, columns=v),
    "objects": lambda v: glidar.simulate(SCENE, CAMERA, objects=v), "threads": lambda v: SCENE.simulator(CAMERA, threads=v),
    "renderer": lambda v: SCENE.simulator(CAMERA, renderer=v), "scene": lambda v: glidar.simulate(v, CAMERA),
    "sensor": lambda v: glidar.simulate(SCENE, v), "simulator": lambda v: glidar.Simulator(SCENE, v),
    "seeds": lambda v: glidar.simulate_batch(SCENE, CAMERA, EYE, v), "frames": lambda v: glidar.simulate_batch(SCENE, CAMERA, EYE, frames=v),
    "iter seeds": lambda v: list(glidar.simulate_iter(SCENE, CAMERA, EYE, v)), "poses": lambda v: glidar.simulate_batch(SCENE, CAMERA, v),
    "batch": lambda v: list(glidar.simulate_iter(SCENE, CAMERA, EYE, batch=v)), "add_instance": SCENE.add_instance, "add_model": SCENE.add_model,
    "add_parts": SCENE.add_parts, "parts": lambda v: SCENE.add_parts("builtin:box", parts=v), "list_parts": glidar.list_parts,
    "split": lambda v: SCENE.add_parts("builtin:box", split=v), "visible_to": lambda v: setattr(SCENE.objects[0], "visible_to", v),
    "returns": lambda v: glidar.sensor("VLP-16", returns=v), "rate": lambda v: glidar.sensor("VLP-16", rate_hz=v),
    "name": lambda v: setattr(SCENE.objects[0], "name", v), "id": lambda v: setattr(SCENE.objects[0], "id", v),
    "trajectory": glidar.Trajectory.load, "kitti rate": lambda v: glidar.Trajectory.load(__file__, rate_hz=v),
    "open3d": glidar.from_open3d, "trimesh": glidar.from_trimesh, "look_at": lambda v: glidar.look_at(v, v),
    "quaternion": lambda v: glidar.quaternion(np.eye(3), v), "explain": lambda v: glidar.simulate(SCENE, CAMERA).explain(v),
}


@pytest.mark.parametrize("use", USES)
def test_every_invalid_value_raises_an_error_with_a_short_excerpt(use):
    for value in ODD:
        try:
            USES[use](value)
        except glidar.Error as error:
            assert len(str(error)) < 1200 and "\0" not in str(error)


def test_names_that_are_not_utf8_raise_a_printable_error(tmp_path):
    name = str(tmp_path).encode() + b"/\xff.yaml"
    Path(name.decode("utf-8", "surrogateescape")).write_text("optics: 3\n")
    for use in (glidar.load_sensor, glidar.load_scene):
        with pytest.raises(glidar.Error) as caught:
            use(name)
        assert "UTF-8" in str(caught.value)


def test_files_that_are_not_utf8_raise_an_error(tmp_path):
    (tmp_path / "s.yaml").write_bytes(b"name: caf\xe9\n")
    (tmp_path / "t.csv").write_bytes(b"\xff\xfe 1 2\n")
    (tmp_path / "c.yaml").write_bytes(b"optics: {type: table, file: t.csv}\n")
    for use, name in ((glidar.load_sensor, "s.yaml"), (glidar.load_scene, "s.yaml"), (glidar.load_sensor, "c.yaml"),
                      (glidar.Trajectory.load, "t.csv")):
        with pytest.raises(glidar.Error) as caught:
            use(tmp_path / name)
        assert str(caught.value)
