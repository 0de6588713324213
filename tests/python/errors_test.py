# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Errors, and what ends long work."""

import _thread
import logging
import pickle
import threading
from itertools import starmap
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, poses_around
from waiting import MAX_WAIT_S, let_time_pass, wait_until

import glidar


def test_error_has_its_four_parts_and_can_be_sent_on():
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
    return np.arange(count, dtype=np.uint64), np.zeros(count, np.uint32), 0


def test_ctrl_c_ends_a_batch_and_all_goes_on(asteroid):
    sensor = glidar.camera(256, 256)
    poses = poses_around(3000)
    core = glidar.Simulator(asteroid, sensor)._core
    fields = glidar._core.fields_for(["xyz"])
    assert completed(core.simulate, glidar._core.constant(poses, "poses"), None, keys(len(poses)), fields) == []
    assert glidar.simulate(asteroid, sensor, poses[0]).hits > 0


def test_ctrl_c_ends_one_long_measurement(asteroid):
    simulator = glidar.Simulator(asteroid, glidar.camera(4000, 4000))
    fields = glidar._core.fields_for(["xyz"])
    assert completed(simulator._core.simulate, simulator._core.usual_motion(), None, keys(1), fields) == []
    glidar.simulate(asteroid, glidar.camera(), poses_around(1)[0])


def test_ctrl_c_ends_the_loading_of_a_model_and_its_process(tmp_path, monkeypatch):
    helper = tmp_path / "helper"
    helper.write_text(f"#!/bin/sh\necho $$ > {tmp_path}/new\nmv {tmp_path}/new {tmp_path}/pid\nexec sleep 3600\n")
    helper.chmod(0o755)
    monkeypatch.setenv("GLIDAR_IMPORT_HELPER", str(helper))
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    interrupted(lambda: glidar.Scene(tmp_path / "a.obj"),
                lambda: wait_until((tmp_path / "pid").exists, "the helper program"))
    process = Path(f"/proc/{int((tmp_path / 'pid').read_text())}")
    assert not process.exists()


def test_ctrl_c_ends_verify():
    assert completed(glidar._core.verify, "embree", 1) == []


def test_what_the_library_tells_goes_to_the_log(caplog, tmp_path):
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd nowhere.png\n")
    with caplog.at_level(logging.INFO, "glidar"):
        glidar.Scene(tmp_path / "a.obj")
    assert any("nowhere.png" in record.message and record.levelname == "WARNING" for record in caplog.records)


def test_models_are_found_whatever_the_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert glidar.Scene(ROOT / "models/satellite/satellite.obj").objects[0].triangles > 0
    assert np.isfinite(glidar.load_sensor("OS1-32").directions).all()
