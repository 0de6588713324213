# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The campaign file: allowed contents, and errors with line and column."""

import pytest

from glidar import Error
from glidar.campaign import loading, plan, spec, variants, yaml_file as yf

BASE = """\
scene: scene.yaml
sensor: camera.yaml
trials: 10
pose:
  position: {shell: {radius_m: [2, 3]}}
  orientation: {look_at: {roll_deg: {uniform: [-180, 180]}}}
"""


def read(folder, text):
    path = folder / "campaign.yaml"
    path.write_text(text, encoding="utf-8")
    return spec.read_spec(path)


def test_missing_keys_have_their_defaults(tmp_path):
    found = read(tmp_path, BASE)
    assert (found.name, found.seed, found.method, found.trials) == ("campaign", 0, "random", 10)
    assert found.outputs.npz.columns == ("range", "intensity", "status")
    assert found.outputs.bop is None and not found.outputs.kitti


def test_all_keys_are_read(tmp_path):
    found = read(tmp_path, """\
name: all of it
seed: 18446744073709551615
sampling: sobol
shard_trials: 7
scene: {choice: [a.yaml, b.yaml], weights: [1, 3]}
sensor: {grid: [VLP-16, camera.yaml]}
pose:
  position: {grid: {min: [0, 0, 1], max: [1, 1, 1], counts: [2, 3, 1]}}
  orientation: uniform
vary:
  sensor.noise[0].sigma_m: {log_uniform: [1e-3, 1e-1]}
  sensor.limits.far_m: {normal: {mean: 10, sigma: 1, min: 9, max: 12}}
  scene.models[rock].scale: {grid: {from: 1, to: 2, count: 5}}
  scene.models[0].pose: {position: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, orientation: uniform}
outputs:
  npz: {columns: [range, xyz], real: f64, compress: true}
  pcd: {columns: [xyz], every: 4}
  mcap: {every: 2}
  ply: true
  kitti: true
  tum: true
  bop: {split: test, depth_scale_mm: 0.5, images: [depth]}
""")
    assert found.trials == 2 * 6 * 5  # one pass over the grids
    assert found.scenes.distribution.weights == (0.25, 0.75)
    assert [v.path for v in found.vary][2] == "scene.models[rock].scale"
    assert found.vary[3].is_pose and not found.vary[0].is_pose
    assert found.outputs.mcap.every == 2 and found.outputs.mcap.columns is None
    assert found.outputs.pcd.every == 4 and found.outputs.bop.images == ("depth",)


@pytest.mark.parametrize("old, new, words", [
    ("trials: 10", "trails: 10", ["3:1", "unknown key 'trails'", "did you mean 'trials'?"]),
    ("trials: 10", "trials: 0", ["3:9", "trials", "0", "from 1"]),
    ("trials: 10", "trials: many", ["3:9", "'many'"]),
    ("trials: 10", "trials: '10'", ["3:9", 'the text "10"']),
    ("trials: 10", "trials: 10\ntrials: 11", ["4:1", "given twice"]),
    ("trials: 10\n", "", ["'trials' is missing", "grid"]),
    ("scene: scene.yaml\n", "", ["the key 'scene' is missing"]),
    ("scene: scene.yaml", "scene: {choice: []}", ["1:17", "an empty list", "a list of 1"]),
    ("scene: scene.yaml", "scene: {choice: [a, b], weights: [0, 0]}", ["all weights are 0"]),
    ("scene: scene.yaml", "scene: {choice: [a, b], weights: [1, -1]}", ["-1", "a number from 0"]),
    ("radius_m: [2, 3]", "radius_m: [3, 2]", ["5:", "[3, 2]", "the second above the first"]),
    ("radius_m: [2, 3]", "radius_m: [2, .inf]", [".inf", "a number from 0"]),
    ("radius_m: [2, 3]", "radius_m: -1", ["-1", "above 0"]),
    ("shell: {", "ball: {", ["unknown key 'ball'", "shell"]),
    ("shell: {radius_m: [2, 3]}", "cone: {axis: [0, 0, 0], half_angle_deg: 1, radius_m: 1}",
     ["length 0"]),
    ("shell: {radius_m: [2, 3]}", "cone: {axis: [0, 0, 1], half_angle_deg: 181, radius_m: 1}",
     ["181", "0 to 180"]),
    ("look_at: {roll_deg: {uniform: [-180, 180]}}", "look_at: {roll_deg: {triangle: 1}}",
     ["unknown key 'triangle'"]),
    ("look_at: {roll_deg: {uniform: [-180, 180]}}", "quaternion: {w: 0, x: 0, y: 0, z: 0}",
     ["length 0"]),
    ("trials: 10", "trials: 10\nsampling: hammersley", ["'hammersley'", "sobol"]),
    ("trials: 10", "trials: 4000000000\nsampling: latin_hypercube",
     ["4:11", "latin_hypercube with 4000000000 trials", "at most 16777216", "sobol and random allow more"]),
    ("trials: 10", "trials: 10\nvary:\n  noise[0]: 1", ["'noise[0]'", "sensor.noise[0].sigma_m"]),
    ("trials: 10", "trials: 10\nvary: {sensor.rate_hz: {log_uniform: [0, 1]}}", ["above 0"]),
    ("trials: 10", "trials: 10\nvary: {sensor.rate_hz: {normal: {mean: 0, sigma: 0}}}", ["above 0"]),
    ("trials: 10", "trials: 10\nvary: {sensor.rate_hz: {normal: {mean: 0, sigma: 1, min: 9}}}",
     ["more than 8 sigma"]),
    ("trials: 10", "trials: 10\noutputs: {}", ["no output is selected"]),
    ("trials: 10", "trials: 10\noutputs: {bop: {images: [rgb]}}", ["'rgb'", "depth, gray"]),
    ("trials: 10", f"trials: {'9' * 5000}", ["3:9", "trials", "999...", "from 1 to 4294967296"]),
    ("trials: 10", f"trials: 10\nseed: {'9' * 20}", ["from 0 to 18446744073709551615"]),
    ("trials: 10", "trials: 10\noutputs: {npz: {columns: [range, rang]}}",
     ["4:34", "columns[1]", "'rang'", "did you mean 'range'?"]),
    ("trials: 10", "trials: 10\noutputs: {pcd: {columns: [ranges]}}", ["'ranges'", "xyz, true_xyz"]),
    ("trials: 10", "trials: 10\noutputs: {kitti: 1}", ["1", "false, true"]),
    ("trials: 10", "trials: [", ["not YAML"]),
    ("camera.yaml", "x" * 4097, ["2:9", "sensor", "at most 4096 bytes"]),
    ("scene: scene.yaml", f"scene: {{grid: [a, {'x' * 4097}]}}", ["1:19", "grid[1]", "at most 4096 bytes"]),
])
def test_errors_state_their_line_and_column(tmp_path, old, new, words):
    assert old in BASE
    with pytest.raises(Error) as caught:
        read(tmp_path, BASE.replace(old, new))
    text = str(caught.value)
    assert text.startswith(str(tmp_path / "campaign.yaml")), text
    for word in words:
        assert word in text, text


@pytest.mark.parametrize("data, words", [
    (b"", "empty"), (b"- 1\n", "a list of 1; allowed: a map"), (b"a: 1\n---\nb: 2\n", "a second document"),
    (b"\xff\xfe", "UTF-8"), (b"name: \0\n", "a zero byte"),
    (b"#" * (3 << 20), "2 MiB")])
def test_files_that_are_not_campaigns_are_rejected(tmp_path, data, words):
    path = tmp_path / "campaign.yaml"
    path.write_bytes(data)
    with pytest.raises(Error, match=words):
        spec.read_spec(path)


@pytest.mark.parametrize("name", ["VLP-61", "x" * 300])  # 255 bytes are the limit of a name in most file systems
def test_an_unknown_sensor_is_rejected_with_the_file_that_names_it(tmp_path, name):
    (tmp_path / "scene.yaml").write_text("models: [{model: 'builtin:box'}]\n")
    with pytest.raises(Error, match="is neither a file nor the name of a sensor") as caught:
        plan.make_plan(read(tmp_path, BASE.replace("camera.yaml", name)))
    assert caught.value.where == f"{tmp_path / 'campaign.yaml'}: sensor"


def test_a_missing_file_is_rejected(tmp_path):
    with pytest.raises(Error, match="cannot be read"):
        spec.read_spec(tmp_path / "none.yaml")


def test_distributions_with_the_same_numbers_are_different_campaigns(tmp_path):
    uniform = plan.spec_record(read(tmp_path, BASE))
    other = plan.spec_record(read(tmp_path, BASE.replace("uniform: [-180, 180]", "grid: [-180, 180]")))
    again = plan.spec_record(read(tmp_path, "# a comment\n" + BASE))
    assert uniform != other and uniform == again


SENSOR = """\
# a comment
optics: {type: pinhole, width: 64, height: 48, fov_deg: 20}
noise:
  - {type: range_gaussian, sigma_m: 0.01}   # another
  - type: dropout
    probability: 0.1
"""


def replaced(path, value, text=SENSOR):
    field = yf.parse(text, "sensor.yaml")
    target = variants.read_target(field, path)
    return variants.replaced(text, field, [(target, value)])


def test_values_are_replaced_in_the_text_and_the_rest_is_unchanged():
    assert replaced("sensor.noise[0].sigma_m", "0.5") == SENSOR.replace("0.01", "0.5")
    assert replaced("sensor.noise[1].probability", "0.25") == SENSOR.replace("0.1\n", "0.25\n")
    assert replaced("sensor.optics.width", "128") == SENSOR.replace("64", "128")


def test_a_changed_scene_is_read_as_its_file(tmp_path, monkeypatch):
    (tmp_path / "rock's.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    text = "models:\n  - {name: rock, model: \"rock's.obj\", scale: 1}\n  - {model: builtin:box}\n"
    path = tmp_path / "scene.yaml"
    target = variants.read_target(yf.parse(text, path), "scene.models[rock].scale")
    monkeypatch.chdir("/")
    scene = loading.load_scene(text, path, [(target, "2")])
    assert scene["rock"].scale == 2 and set(scene._core.files) == {str(path), str(tmp_path / "rock's.obj")}
    with pytest.raises(Error, match=rf"{path}:2:46: .*scale"):
        loading.load_scene(text, path, [(target, "0")])


@pytest.mark.parametrize("path, words", [
    ("sensor.noise[0].sigma", "did you mean 'sigma_m'"), ("sensor.noise[2].sigma_m", "no element [2]"),
    ("sensor.rate_hz", "add it to the file"), ("sensor.noise.sigma_m", "a list of 2"),
    ("sensor.noise[gauss].sigma_m", "no element has the name 'gauss'")])
def test_missing_values_are_reported(path, words):
    with pytest.raises(Error) as caught:
        replaced(path, "1")
    assert words in str(caught.value) and "sensor.yaml:" in str(caught.value)


@pytest.mark.parametrize("old, new", [
    ("'a ''b'' #c'", "1"), (r'"a \" # b"', "1"), ("1e-3", "2"), ("plain words", "'x'"), ("ü", "3")])
def test_one_line_values_are_replaced_whole(old, new):
    text = f"\ufeff# ö\noptics: {{a: ä, width: {old}}}  # end\n"
    assert replaced("sensor.optics.width", new, text) == text.replace(old, new)


@pytest.mark.parametrize("text", [
    "optics:\n  width: [1, 2]\n", "optics:\n  width: {a: 1}\n", "optics:\n  width:\n", "optics:\n  width: |\n    1\n",
    "optics:\n  width: a\n    b\n", "optics:\n  width: 'a\n\n    b'\n"])
def test_other_values_are_not_replaced(text):
    with pytest.raises(Error, match=r"sensor.yaml:2:.*optics.width: .*one line"):
        replaced("sensor.optics.width", "1", text)


def test_anchored_values_are_rejected():
    text = "noise:\n  - {type: range_gaussian, sigma_m: &s 0.01}\n  - {type: dropout, probability: *s}\n"
    with pytest.raises(Error, match="an anchor"):
        replaced("sensor.noise[1].probability", "1", text)


def test_numbers_are_written_without_loss():
    for value in (0.1, 1e-300, 123456789.0, -2.5, 1 / 3):
        assert float(variants.number_text(value)) == value
    assert variants.number_text(128.0) == "128"


def test_aliases_that_expand_to_a_huge_file_are_rejected(tmp_path):
    path = tmp_path / "campaign.yaml"
    levels = "".join(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 10)}]\n" for i in range(40))
    path.write_text(f"a0: &a0 [1]\n{levels}")
    with pytest.raises(Error, match="values with aliases written out; allowed: 1000000 values"):
        spec.read_spec(path)


def test_recursive_aliases_are_rejected(tmp_path):
    path = tmp_path / "campaign.yaml"
    path.write_text("name: x\nvary: &a\n  b: [1, *a]\n")
    with pytest.raises(Error, match="an alias of the value that it is in"):
        spec.read_spec(path)


@pytest.mark.parametrize("text", ["[" * 50_000, "{a: " * 50_000, "- " * 50_000, "a: \"\\U99999999\"", "a: \0",
                                  'scene: "\\ud800"', 'name: "a\\0b"'])
def test_malicious_yaml_raises_an_error(tmp_path, text):
    path = tmp_path / "campaign.yaml"
    path.write_text(text)
    with pytest.raises(Error) as raised:
        spec.read_spec(path)
    assert len(str(raised.value)) < 600


def test_errors_quote_at_most_200_bytes_without_control_characters(tmp_path):
    path = tmp_path / "campaign.yaml"
    for text in (f"{'k' * 100_000}: 1\n", f"seed: {'9' * 100_000}\n", f"sampling: {'w' * 100_000}\n",
                 '"a\\nb\\e[31mred": 1\n'):
        path.write_text(text)
        with pytest.raises(Error) as raised:
            spec.read_spec(path)
        found = raised.value.found + raised.value.where.replace(str(path), "")
        assert len(found) < 500 and "\n" not in found and "\x1b" not in found
