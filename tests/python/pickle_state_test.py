# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Malformed pickles raise errors; sensors with custom beams survive pickling."""

import numpy as np
import pytest
from conftest import TRAJECTORIES, again

import glidar


def restored(kind, state):
    """What unpickling makes of a state."""
    restored = kind.__new__(kind)
    restored.__setstate__(state)
    return restored


def malformed(state):
    """States with one part missing, of another type, or with another number."""
    for name, value in state.items():
        if name in ("kind", "glidar"):
            continue
        yield {key: inner for key, inner in state.items() if key != name}
        for wrong in (None, 7, "text", b"bytes", [], [None], {}, {"kind": 3}, (1,), np.zeros(3), np.zeros((2, 2), object)):
            yield {**state, name: wrong}
        if isinstance(value, dict):
            for inner in malformed(value):
                yield {**state, name: inner}
        if isinstance(value, list) and value and isinstance(value[0], dict):
            for inner in malformed(value[0]):
                yield {**state, name: [inner, *value[1:]]}
        if isinstance(value, np.ndarray) and value.size:
            yield {**state, name: value[:-1]}
            yield {**state, name: value.astype(complex)}
            yield {**state, name: np.full_like(value, 200 if value.dtype == np.uint8 else np.iinfo(value.dtype).max if value.dtype.kind in "iu" else np.inf)}


def use(value):
    """Uses a restored object like a user."""
    if isinstance(value, glidar.Frame):
        value.cloud()
        value.explain(0)
    if isinstance(value, glidar.Scene):
        glidar.simulate(value, glidar.camera(4, 4))
    if isinstance(value, glidar.Cloud):
        repr(value)
    if isinstance(value, glidar.Trajectory):
        value.pose_at(1.0)


def table_sensor():
    rays = np.array([[[1, 0, 0], [1, 0.1, 0], [np.nan, 0, 0]]])
    optics = {"type": "table", "directions": rays, "times_ns": [[0, 10, 20]], "period_ns": 30.0, "rings": [[2, 1, 0]]}
    return glidar.Sensor.from_dict({"optics": optics, "rate_hz": 1e6})


def samples():
    scene = glidar.Scene()
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], normals=[[0, 0, 1]] * 3)
    pose = glidar.look_at([0.2, 0.2, 3], [0.2, 0.2, 0], [0, 1, 0])
    frame = glidar.simulate(scene, glidar.camera(4, 3, noise=[{"type": "dropout", "probability": 0.1}]), pose, columns="all")
    yield table_sensor()
    yield scene
    yield frame
    yield frame.cloud()
    for make in TRAJECTORIES.values():
        yield make()


@pytest.mark.parametrize("index", range(9))
def test_a_malformed_state_raises_an_error(index):
    value = list(samples())[index]
    tried = refused = 0
    for state in malformed(value.__getstate__()):
        tried += 1
        try:
            use(restored(type(value), state))
        except glidar.Error:
            refused += 1  # any other exception fails the test
    assert tried > 20
    assert refused > tried // 2


def test_a_state_of_another_type_raises_an_error():
    for kind in (glidar.Sensor, glidar.Scene, glidar.Frame, glidar.Cloud, glidar.Trajectory):
        for state in (None, {}, {"kind": "Simulator"}, [1, 2]):
            with pytest.raises(glidar.Error, match=f"pickled {kind.__name__}: the state of another type"):
                restored(kind, state)
    with pytest.raises(glidar.Error, match="malformed state .* of version 0.0.1"):
        restored(glidar.Sensor, {"kind": "Sensor", "glidar": "0.0.1"})


def test_custom_beams_survive_a_round_trip():
    sensor = table_sensor()
    optics = sensor.to_dict()["optics"]
    assert np.array_equal(optics["rings"], [[2, 1, 0]])
    optics["directions"][0, 0] = 7  # a copy
    for back in (again(sensor), glidar.Sensor.from_dict(sensor.to_dict())):
        assert back == sensor
        assert back.ray_directions.tobytes() == sensor.ray_directions.tobytes()
    other = sensor.to_dict()
    other["optics"]["directions"][0, 1, 1] = 0.2
    assert glidar.Sensor.from_dict(other) != sensor


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"directions": [[1, 0, 0]]}, "an array rows x cols x 3"),
        ({"directions": [[[0, 0, 0]]]}, "directions"),
        ({"origins_m": [[[0, 0, 0]]]}, "optics.origins_m: an array 1 x 1 x 3"),
        ({"times_ns": [[0, 20, 10]]}, "times in increasing order"),
        ({"rings": [[0, 1, 70000]]}, "0 to 65535"),
        ({"type": "prism"}, "optics.type: 'prism'"),
        ({"file": "rays.npy"}, "the unknown key 'file'"),
    ],
)
def test_invalid_custom_beams_are_rejected(change, message):
    optics = {"type": "table", "directions": np.ones((1, 3, 3)), **change}
    with pytest.raises(glidar.Error, match=message):
        glidar.Sensor.from_dict({"optics": optics})
