# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""All files that scene and sensor files read, directly or indirectly, belong to the campaign."""

import json
import re
import struct
import subprocess
import zlib

import numpy as np
import pyarrow.parquet as pq
import pytest

from glidar import Error
from glidar.campaign import inputs, loading, plan, run, spec, variants, work, yaml_file as yf

CORNERS = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32)
GLTF = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "buffers": [{"uri": "t.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [-1, -1, 0], "max": [1, 1, 0]}]}
OBJ = "mtllib t.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"
MTL = "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd t.png\n"


def png(grey):
    """A grey image of one pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes([0, grey]))) + chunk(b"IEND", b""))


def write_models(campaign):
    folder = campaign.folder / "shapes"
    folder.mkdir()
    (folder / "t.gltf").write_text(json.dumps(GLTF))
    (folder / "t.bin").write_bytes(CORNERS.tobytes())
    (folder / "t.obj").write_text(OBJ)
    (folder / "t.mtl").write_text(MTL)
    (folder / "t.png").write_bytes(png(200))
    (folder / "noise.png").write_bytes(png(100))
    (folder / "path.tum").write_text("0 0 0 0 0 0 0 1\n1 0 0 1 0 0 0 1\n")
    (folder / "places.csv").write_text("0.5 0 0\n1.5 0 0\n")
    campaign.write("scene.yaml", """models:
  - {model: shapes/t.gltf, name: a}
  - model: shapes/t.obj
    name: b
    materials: {'*': {noise_texture: shapes/noise.png}}
    motion: {trajectory: shapes/path.tum}
  - {model: builtin:box, name: c, poses: shapes/places.csv}
""")
    return folder


def change(path):
    """Other content of the same length."""
    if path.suffix == ".png":
        path.write_bytes(png(50))
    elif path.suffix == ".bin":
        path.write_bytes((CORNERS * 0.5).tobytes())
    else:
        path.write_text(path.read_text().replace("1 0 0 1 ", "1 0 0 2 ").replace("0.5", "0.7"))


NAMES = ["t.gltf", "t.bin", "t.obj", "t.mtl", "t.png", "noise.png", "path.tum", "places.csv"]


@pytest.mark.parametrize("name", NAMES[1:2] + NAMES[3:])
def test_a_changed_input_file_makes_another_campaign_and_is_named(campaign, name):
    folder = write_models(campaign)
    campaign.run("out", "--shard", "0/2")
    campaign.run("out", "--shard", "0/2")
    change(folder / name)
    printed = campaign.run("out", "--shard", "1/2", code=2)
    kind = "files" if name in ("noise.png", "path.tum", "places.csv") else "parts"
    assert f"it contains another campaign: scenes[scene.yaml].{kind}.shapes/{name} was " in printed


def test_a_missing_model_is_reported_as_missing(campaign):
    folder = write_models(campaign)
    campaign.run("out", "--shard", "0/2")
    (folder / "t.obj").unlink()
    printed = campaign.run("out", code=2)
    assert re.search(r"scenes\[scene.yaml\]\.files\.shapes/t\.obj was \"\w+\", is missing", printed)


@pytest.mark.parametrize("name", NAMES)
def test_a_changed_file_stops_the_run_and_fails_no_trial(campaign, name):
    folder = write_models(campaign)

    def execute(a_plan, a_folder, shards, report):
        if name in ("t.gltf", "t.obj"):
            (folder / name).unlink()
        else:
            change(folder / name)
        work.work(a_plan, a_folder, shards, 1, report)

    with pytest.raises(Error, match=f"shapes/{name}: it was changed while the campaign ran; restore it"):
        run.run(campaign.folder / "campaign.yaml", campaign.folder / "out", execute=execute, quiet=True)
    assert not (campaign.folder / "out" / "receipts").exists()


@pytest.mark.parametrize("name", ["noise.png", "t.png"])
def test_a_new_input_file_stops_the_run(campaign, name):
    folder = write_models(campaign)
    (folder / name).rename(folder / "away.png")
    planned = plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml"))
    (folder / "away.png").rename(folder / name)
    with pytest.raises(inputs.InputChanged, match=name):
        inputs.load(planned.scenes[0], loading.load_scene, ())


def test_names_of_model_files_do_not_depend_on_the_machine(campaign):
    folder = write_models(campaign)
    (campaign.folder / "there").mkdir()
    folder.rename(campaign.folder / "there" / "deep")
    (campaign.folder / "shapes").symlink_to(campaign.folder / "there" / "deep")
    record = plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml")).record()
    scene = record["scenes"][0]
    assert scene["files"].keys() | scene["parts"].keys() == {f"shapes/{name}" for name in NAMES}
    assert scene["parts"].keys() == {f"shapes/t.{suffix}" for suffix in ("bin", "mtl", "png")}


def test_models_can_be_shared_by_scenes(campaign):
    folder = write_models(campaign)
    campaign.write("other.yaml", "models: [{model: ./shapes/../shapes/t.obj}]\n")
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "scene: scene.yaml", "scene: {grid: [scene.yaml, other.yaml]}"))
    campaign.run("out", "--shard", "0/2")
    change(folder / "t.mtl")
    assert "t.mtl was" in campaign.run("out", code=2)


def test_unchanged_models_are_measured_by_all_workers(campaign):
    write_models(campaign)
    campaign.run("one", "--workers", "1")
    campaign.run("two", "--workers", "2")
    assert campaign.contents("one") == campaign.contents("two")
    assert sum(pq.read_table(campaign.folder / "one" / "index.parquet")["hits"].to_pylist()) > 0


def path_keys(schema):
    """The keys of a JSON Schema whose values may be paths."""
    for part in schema if isinstance(schema, list) else schema.values():
        if isinstance(part, (dict, list)):
            yield from path_keys(part)
    if isinstance(schema, dict):
        for key, value in schema.get("properties", {}).items():
            may_be_text = {"type": "string", "minLength": 1} in value.get("anyOf", [])
            if value.get("x-allowed") == "a path" or may_be_text:
                yield key


def test_all_keys_with_paths_are_known():
    """The key of a file that scenes or sensors name must be in FILE_KEYS."""
    printed = subprocess.run(["glidar", "schema", "scene"], capture_output=True, check=True, text=True).stdout
    assert variants.FILE_KEYS == set(path_keys(json.loads(printed)))


def test_trajectories_and_their_times_files_are_inputs(campaign):
    row = "1 0 0 {} 0 1 0 0 0 0 1 0\n"
    campaign.write("poses.txt", row.format(0) + row.format(1))
    campaign.write("times.txt", "0\n1\n")
    campaign.write("rays.npy", "")
    np.save(campaign.folder / "rays.npy", np.array([[0, 0, 1.0], [0.01, 0, 1.0]]))
    campaign.write("camera.yaml", "optics: {type: table, file: rays.npy, point_us: 1}\n")
    campaign.write("scene.yaml", """models:
  - {model: builtin:box, motion: {trajectory: {file: poses.txt, times: times.txt}}}
sensor: camera.yaml
""")
    printed = campaign.run("out")
    assert "0 failed" in printed
    listed = json.loads((campaign.folder / "out" / "campaign.json").read_text())["plan"]
    assert listed["scenes"][0]["files"].keys() == {"poses.txt", "times.txt", "camera.yaml"}
    assert listed["sensors"][0]["files"].keys() == {"rays.npy"}


def test_files_behind_aliases_are_inputs(tmp_path):
    text = """models:
  - {model: &m rock.obj, name: a, materials: {'*': &n {noise_texture: t.png}}}
  - {model: *m, name: b, materials: {'*': *n}}
"""
    found = variants.files_of(yf.parse(text, tmp_path / "scene.yaml"))
    assert {path.name for _, _, path in found} == {"rock.obj", "t.png"}


def test_values_with_aliases_cannot_be_varied(tmp_path):
    text = "noise:\n  - &n {type: range_gaussian, sigma_m: 0.1}\n  - *n\n"
    for place in (0, 1):
        with pytest.raises(Error, match="an anchor"):
            field = yf.parse(text, tmp_path / "sensor.yaml")
            target = variants.read_target(field, f"sensor.noise[{place}].sigma_m")
            variants.replaced(text, field, [(target, "1")])


def test_recursive_yaml_is_rejected(campaign):
    campaign.write("scene.yaml", "a: &a\n  b: *a\nmodels: []\n")
    assert "scene.yaml:2:6: an alias of the value that it is in" in campaign.run("out", code=2)


TWICE = [
    ("scene.models[rock].scale: {uniform: [1, 2]}", "scene.models[0].scale: 3"),
    ("scene.models[rock].scale: 2", "scene.models[00].scale: 3"),
    ("sensor.noise[0].sigma_m: 0.1", "sensor.noise[0]: 1"),
    ("scene.models[moon].pose.position[0]: 1",
     "scene.models[1].pose: {position: {point: [0, 0, 0]}, orientation: uniform}"),
    ("scene.models[moon].pose: {position: {point: [0, 0, 1]}, orientation: uniform}",
     "scene.models[1].pose: {position: {point: [0, 0, 0]}, orientation: uniform}")]


@pytest.mark.parametrize("first, second", TWICE)
def test_overlapping_varied_values_are_rejected_with_both_names(campaign, first, second):
    campaign.add(f"vary:\n  {first}\n  {second}\n")
    printed = campaign.run("out", code=2)
    for path in (first.split(":")[0], second.split(":")[0]):
        assert f"vary.{path}" in printed, printed


def test_neighbouring_values_can_be_varied(campaign):
    campaign.add("vary:\n  scene.models[rock].scale: 2\n  scene.models[1].scale: 3\n  sensor.noise[0].sigma_m: 0\n")
    campaign.run("out")


def test_an_index_with_too_many_digits_is_rejected(campaign):
    campaign.add(f"vary:\n  ? scene.models[{'9' * 5000}].scale\n  : 2\n")
    assert "there is no element" in campaign.run("out", code=2)
