# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""BOP data sets, read by an independent reader that follows the format's documentation (thodan/bop_toolkit,
docs/bop_datasets_format.md), and by the official toolkit where it is installed."""

import json
import os
import subprocess

import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image
from campaign_support import Campaign
from scipy.spatial import QhullError
from scipy.spatial.distance import pdist

import glidar
from glidar.campaign import bop_models, measure
from glidar.campaign.plan import make_plan
from glidar.campaign.spec import read_spec
from glidar.campaign.trials import draw_trials

# A box in front of a larger one, off-centre; a camera without noise.
SCENE = """models:
  - {name: near, model: builtin:box, scale: 0.5, pose: {position: [0.3, 0, 0]}}
  - {name: far, model: builtin:box, scale: 1.5, pose: {position: [-3, 0.2, 0.1], euler_deg: {yaw: 30}}}
  - {name: copy, model: builtin:box, scale: 0.5, pose: {position: [0, 4, 0]}}
"""
CAMERA = """optics: {type: pinhole, width: 64, height: 48, fx: 80, fy: 90, cx: 30, cy: 25, pixel_centre: 0.5}
"""
CAMPAIGN = """scene: scene.yaml
sensor: camera.yaml
trials: 6
shard_trials: 3
pose:
  position: {cone: {axis: [1, 0, 0], half_angle_deg: 25, radius_m: [3, 4]}}
  orientation: {look_at: {max_offset_deg: 8, roll_deg: {uniform: [-180, 180]}}}
outputs: {bop: {depth_scale_mm: 0.25, split: val}}
"""
STEP_MM = 0.25


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    made = Campaign(tmp_path_factory.mktemp("bop"))
    made.write("scene.yaml", SCENE)
    made.write("camera.yaml", CAMERA)
    made.write("campaign.yaml", CAMPAIGN)
    made.run("out")
    return made.folder / "out" / "bop"


def read_ply(path):
    """An independent reader of the ASCII PLY that BOP requires."""
    lines = path.read_text().splitlines()
    vertices = int(next(line for line in lines if line.startswith("element vertex")).split()[-1])
    start = lines.index("end_header") + 1
    rows = np.array([[float(x) for x in line.split()] for line in lines[start : start + vertices]])
    faces = np.array([[int(x) for x in line.split()] for line in lines[start + vertices :]])
    assert (faces[:, 0] == 3).all()
    return rows[:, :3], rows[:, 3:], faces[:, 1:]


def images(dataset):
    """(scene folder, image id, camera, objects, infos, depth in mm)."""
    for scene in sorted((dataset / "val").iterdir()):
        camera, truth, info = (json.loads((scene / f"{name}.json").read_text())
                               for name in ("scene_camera", "scene_gt", "scene_gt_info"))
        assert camera.keys() == truth.keys() == info.keys()
        for key in camera:
            image = Image.open(scene / "depth" / f"{int(key):06}.png")
            assert image.mode == "I;16"
            depth = np.asarray(image).astype(float) * camera[key]["depth_scale"]
            yield scene, int(key), camera[key], truth[key], info[key], depth


def matrix(entry, rotation, translation):
    return np.array(entry[rotation]).reshape(3, 3), np.array(entry[translation])


def mask(scene, kind, image, place):
    pixels = np.asarray(Image.open(scene / kind / f"{image:06}_{place:06}.png"))
    assert set(np.unique(pixels)) <= {0, 255}
    return pixels > 0


def test_models_are_in_millimetres_with_outward_normals_and_correct_sizes(dataset):
    info = json.loads((dataset / "models" / "models_info.json").read_text())
    assert sorted(info) == ["1", "2"]  # the second model is identical to the near box
    for key, side in (("1", 1000.0), ("2", 3000.0)):
        vertices, normals, _ = read_ply(dataset / "models" / f"obj_{int(key):06}.ply")
        assert np.ptp(vertices, axis=0) == pytest.approx([side] * 3)
        assert info[key]["diameter"] == pytest.approx(np.sqrt(3) * side)
        assert info[key]["diameter"] == pytest.approx(pdist(vertices).max())
        assert info[key]["min_x"] == pytest.approx(-side / 2)
        assert info[key]["size_z"] == pytest.approx(side)
        assert (np.abs(np.linalg.norm(normals, axis=1) - 1) < 1e-6).all()
        assert ((normals * vertices).sum(axis=1) > 0).all()


def test_boxes_are_those_of_the_models_in_the_poses_of_the_objects(dataset):
    models = json.loads((dataset / "models" / "models_info.json").read_text())
    hidden = 0
    for scene, key, _, truth, info, _ in images(dataset):
        boxes = json.loads((scene / "scene_boxes.json").read_text())[str(key)]
        assert len(boxes) == len(truth)
        for box, entry, counts in zip(boxes, truth, info):
            assert box["obj_id"] == entry["obj_id"]
            model = models[str(box["obj_id"])]
            assert box["size"] == pytest.approx([model[f"size_{axis}"] for axis in "xyz"], abs=1e-3)
            (turn, place), (box_turn, box_place) = matrix(entry, "cam_R_m2c", "cam_t_m2c"), matrix(box, "cam_R_b2c", "cam_t_b2c")
            np.testing.assert_allclose(box_turn, turn, atol=1e-9)
            middle = np.array([model[f"min_{axis}"] + model[f"size_{axis}"] / 2 for axis in "xyz"])
            np.testing.assert_allclose(box_place, turn @ middle + place, atol=1e-2)  # mm
            assert box["px_count_visib"] == counts["px_count_visib"]
            assert box["px_count_visib"] <= box["px_count_image"] <= counts["px_count_all"]
            hidden += box["px_count_image"] - box["px_count_visib"]
            if box["px_count_image"]:
                assert box["occlusion"] == pytest.approx(1 - box["px_count_visib"] / box["px_count_image"])
    assert hidden > 0


def test_camera_matrices_have_pixel_centres_at_integers(dataset):
    camera = json.loads((dataset / "camera.json").read_text())
    assert (camera["width"], camera["height"]) == (64, 48)
    assert [camera[name] for name in ("fx", "fy", "cx", "cy")] == pytest.approx([80, 90, 29.5, 24.5])
    for _, _, entry, *_ in images(dataset):
        assert np.array(entry["cam_K"]) == pytest.approx([80, 0, 29.5, 0, 90, 24.5, 0, 0, 1])


def test_reprojected_depth_is_on_the_models(dataset):
    halves = {1: 500.0, 2: 1500.0}
    tested = 0
    for scene, image, camera, objects, _, depth in images(dataset):
        k = np.array(camera["cam_K"]).reshape(3, 3)
        for place, entry in enumerate(objects):
            rotation, translation = matrix(entry, "cam_R_m2c", "cam_t_m2c")
            v, u = np.nonzero(mask(scene, "mask_visib", image, place))
            pixel = np.stack([u, v, np.ones(len(u))])
            point = np.linalg.inv(k) @ pixel * depth[v, u]
            in_model = rotation.T @ (point - translation[:, None])
            # On the box's surface, except for half a step of depth along the ray.
            error = np.abs(np.abs(in_model).max(axis=0) - halves[entry["obj_id"]])
            assert (error <= STEP_MM).all()
            tested += len(u)
    assert tested > 1000


def test_world_poses_agree_with_object_poses(dataset):
    for _, _, camera, objects, _, _ in images(dataset):
        rotation, translation = matrix(camera, "cam_R_w2c", "cam_t_w2c")
        near = objects[0]  # in the world at (0.3, 0, 0) m, not rotated
        model_rotation, model_translation = matrix(near, "cam_R_m2c", "cam_t_m2c")
        assert np.abs(model_rotation - rotation).max() < 1e-12
        assert np.abs(rotation @ [300, 0, 0] + translation - model_translation).max() < 1e-6


def silhouette_area(vertices, k, rotation, translation):
    """Pixels within the convex hull of the projected corners of a box: its exact silhouette."""
    from scipy.spatial import Delaunay

    camera = rotation @ vertices.T + translation[:, None]
    if camera[2].min() <= 0:
        return None
    u, v = (k @ camera)[:2] / camera[2]
    grid = np.stack(np.meshgrid(np.arange(-64, 128), np.arange(-48, 96)), axis=-1).reshape(-1, 2)
    inside = Delaunay(np.stack([u, v], axis=1)).find_simplex(grid) >= 0
    return inside.reshape(144, 192)


def test_masks_and_pixel_counts_match_the_projected_boxes(dataset):
    truncated = occluded = 0
    for scene, image, camera, objects, infos, depth in images(dataset):
        k = np.array(camera["cam_K"]).reshape(3, 3)
        for place, (entry, info) in enumerate(zip(objects, infos)):
            vertices, _, _ = read_ply(dataset / "models" / f"obj_{entry['obj_id']:06}.ply")
            whole = silhouette_area(vertices, k, *matrix(entry, "cam_R_m2c", "cam_t_m2c"))
            if whole is None:
                continue
            full, seen = mask(scene, "mask", image, place), mask(scene, "mask_visib", image, place)
            assert not (seen & ~full).any()
            edge = 0.02 * whole.sum() + 4  # pixels on the border
            assert np.abs(whole[48:96, 64:128].astype(int) - full).sum() <= edge
            assert abs(info["px_count_all"] - whole.sum()) <= edge
            assert info["px_count_visib"] == seen.sum()
            assert info["px_count_valid"] == (full & (depth > 0)).sum()
            if info["px_count_all"]:
                assert info["visib_fract"] == pytest.approx(seen.sum() / info["px_count_all"])
            if seen.any():
                ys, xs = np.nonzero(seen)
                assert info["bbox_visib"] == [xs.min(), ys.min(), np.ptp(xs), np.ptp(ys)]
                ys, xs = np.nonzero(whole)
                box = [xs.min() - 64, ys.min() - 48, np.ptp(xs), np.ptp(ys)]
                assert np.abs(np.array(box) - info["bbox_obj"]).max() <= 1
            truncated += info["px_count_all"] > full.sum()
            occluded += full.sum() > seen.sum()
    assert truncated > 0 and occluded > 0


def test_the_bop_toolkit_reads_the_data_set(dataset):
    inout = pytest.importorskip("bop_toolkit_lib.inout", reason="bop_toolkit is not installed; install it from its repository")
    scene = dataset / "val" / "000000"
    camera = inout.load_scene_camera(str(scene / "scene_camera.json"))
    truth = inout.load_scene_gt(str(scene / "scene_gt.json"))
    assert sorted(camera) == sorted(truth) == [0, 1, 2]
    assert inout.load_ply(str(dataset / "models" / "obj_000001.ply"))["pts"].shape[1] == 3
    assert inout.load_depth(str(scene / "depth" / "000000.png")).shape == (48, 64)


def test_vertex_normals_are_weighted_by_angle():
    # A corner of three unit squares, one of them cut into two triangles: this does not change the result.
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]])
    triangles = np.array([[0, 1, 4], [0, 4, 2], [0, 2, 3], [0, 3, 1]])
    assert bop_models.normals_of(vertices, triangles)[0] == pytest.approx(np.ones(3) / np.sqrt(3))


@pytest.mark.parametrize("points, expected", [
    (np.random.default_rng(1).normal(size=(500, 3)), None),
    (np.random.default_rng(2).normal(size=(500, 3)) * [1, 1, 0], None),
    (np.linspace(0, 1, 9)[:, None] * [1.0, 2.0, 2.0], 3.0),
    (np.array([[1e7, 2.0, 3.0]]), 0.0), (np.full((5, 3), 0.1), 0.0)])
def test_diameters_are_exact_also_for_planes_lines_and_points(points, expected):
    assert bop_models.diameter(points) == pytest.approx(pdist(points).max() if expected is None else expected)


def test_diameters_are_computed_in_blocks_without_a_hull(monkeypatch):
    points = np.random.default_rng(3).normal(size=(300, 3))
    exact = pdist(points).max()
    monkeypatch.setattr(bop_models, "DISTANCES", 1000)
    assert bop_models.diameter(points) == pytest.approx(exact, rel=1e-12)

    def fails(points):
        raise QhullError("no hull")

    monkeypatch.setattr("scipy.spatial.ConvexHull", fails)
    assert bop_models.diameter(points) == pytest.approx(exact, rel=1e-12)


def test_a_model_of_one_point_is_written_and_measured(campaign):
    point = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    point += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    campaign.write("point.ply", point + 3 * "1e7 1e7 1e7\n" + "3 0 1 2\n")
    campaign.add("outputs: {bop: {depth_scale_mm: 1}}\n")
    campaign.write("scene.yaml", SCENE + "  - {name: point, model: point.ply}\n")
    assert "40 trials, 0 failed" in campaign.run("out", "--workers", "1")
    info = json.loads((campaign.folder / "out" / "bop" / "models" / "models_info.json").read_text())
    assert info["3"]["diameter"] == 0.0 and info["3"]["min_x"] == 1e10


@pytest.mark.parametrize("change, words", [
    (lambda c: c.add("vary:\n  scene.models[near].scale: {uniform: [1, 2]}\n"), "models of a BOP"),
    (lambda c: c.write("camera.yaml", "optics: {type: pinhole, width: 64, height: 48, fov_deg: 40, "
                       "distortion: {model: radial_tangential, k1: 0.1}}\n"), "distortion"),
    (lambda c: c.write("campaign.yaml", CAMPAIGN.replace("camera.yaml", "VLP-16")), "a spinning")])
def test_scenes_that_bop_cannot_represent_are_rejected(campaign, change, words):
    campaign.write("scene.yaml", SCENE)
    campaign.write("camera.yaml", CAMERA)
    campaign.write("campaign.yaml", CAMPAIGN)
    change(campaign)
    assert words in campaign.run("out", code=2)


def bop_campaign(campaign, text):
    campaign.write("scene.yaml", SCENE)
    campaign.write("camera.yaml", CAMERA)
    campaign.write("campaign.yaml", text)
    return campaign.folder / "out"


def test_trials_with_too_large_depths_fail_alone(campaign):
    # From 3, 26.5 and 50 m along +x, where 16 bits hold 32.8 m.
    deep = CAMPAIGN.replace("{cone: {axis: [1, 0, 0], half_angle_deg: 25, radius_m: [3, 4]}}",
                            "{grid: {min: [3, 0, 0], max: [50, 0, 0], counts: [3, 1, 1]}}")
    deep = deep.replace("0.25", "0.5").replace("outputs: {", "outputs: {npz: true, ply: true, ")
    out = bop_campaign(campaign, deep)
    assert "6 trials, 2 failed" in campaign.run("out", code=1)
    table = pq.read_table(out / "index.parquet").to_pydict()
    assert table["ok"] == [True, True, False] * 2 and np.isnan(table["range_min_m"][2])
    assert "does not fit in 16 bits" in table["error"][2] and "at least" in table["error"][2]
    cameras = json.loads((out / "bop" / "val" / "000000" / "scene_camera.json").read_text())
    assert list(cameras) == ["0", "1"]
    assert sorted(p.stem for p in (out / "bop" / "val" / "000000" / "depth").iterdir()) == ["000000", "000001"]
    assert np.load(next((out / "npz").glob("shard-000000-*")))["trial"].tolist() == [0, 1]
    assert len(list((out / "ply").iterdir())) == 4


def test_trials_with_an_unreadable_or_distorted_camera_fail_alone(campaign):
    out = bop_campaign(campaign, CAMPAIGN.replace("sensor: camera.yaml", "sensor: {grid: [bad.yaml, camera.yaml]}")
                       + "vary: {sensor.optics.distortion.k1: {grid: [0, 0.1]}}\n")
    bends = CAMERA.replace("}", ", distortion: {model: radial_tangential, k1: 0}}")
    campaign.write("camera.yaml", bends)
    campaign.write("bad.yaml", bends.replace("width: 64", "width: -1"))
    campaign.run("out", code=1)
    table = pq.read_table(out / "index.parquet").to_pydict()
    assert table["ok"] == [False, True, False, False, False, True]
    assert "width" in table["error"][0] and "a camera with distortion" in table["error"][3]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may mount a small disk; run it as root")
@pytest.mark.parametrize("model, models_fit", [("builtin:box", True), ("builtin:asteroid", False)])
def test_a_full_disk_is_reported_for_images_and_models(campaign, model, models_fit):
    out = campaign.folder / "disk" / "out"
    out.parent.mkdir()
    bop_campaign(campaign, CAMPAIGN.replace("trials: 6", "trials: 60"))
    campaign.write("scene.yaml", SCENE.replace("builtin:box", model))
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", out.parent],
                             capture_output=True, check=False)
    if mounted.returncode != 0:
        pytest.skip("mount is not allowed here; run it outside of a container")
    try:
        printed = campaign.run("disk/out", "--workers", "1", code=2)
        assert "No space left on device" in printed and "make room" in printed and "Traceback" not in printed
        assert not (out / "tmp").exists()
        assert (out / "receipts" / "once-bop.json").exists() == models_fit
        subprocess.run(["mount", "-o", "remount,size=32m", out.parent], check=True)
        campaign.run("disk/out", "--workers", "1")
        campaign.run("whole", "--workers", "1")
        assert campaign.contents("disk/out") == campaign.contents("whole")
    finally:
        subprocess.run(["umount", out.parent], check=True)


def test_object_ids_depend_on_values_and_not_on_notation(campaign):
    out = bop_campaign(campaign, CAMPAIGN.replace(
        "scene: scene.yaml", "scene: {grid: [scene.yaml, sub/scene.yaml, bad.yaml]}"))
    (campaign.folder / "sub").mkdir()
    for folder, far in (("", 1), ("sub/", 2)):
        campaign.write(folder + "a.obj", f"v 0 0 0\nv {far} 0 0\nv 0 1 0\nf 1 2 3\n")
    campaign.write("scene.yaml", """models:
  - {name: a, model: a.obj, scale: 0.5}
  - {name: b, model: ./sub/../a.obj, scale: 0.50, unit: m}
  - {name: c, model: a.obj, scale: 5e-1, unit: cm}
""")
    campaign.write("sub/scene.yaml", """models:
  - {name: a, model: a.obj, scale: 0.5}
  - {name: b, model: ../a.obj, scale: 0.5}
  - {name: c, model: a.obj}
  - {name: d, model: a.obj, scale: 1.0}
""")
    campaign.write("bad.yaml", "models:\n  - {model: a.obj, scale: [1, 2]}\n")
    campaign.run("out", code=1)
    truth = json.loads((out / "bop" / "val" / "000000" / "scene_gt.json").read_text())
    ids = [[entry["obj_id"] for entry in truth[image]] for image in "01"]
    assert ids == [[1, 1, 2], [3, 1, 4, 4]]
    info = json.loads((out / "bop" / "models" / "models_info.json").read_text())
    assert [info[key]["size_x"] for key in "1234"] == pytest.approx([500, 5, 1000, 2000])


@pytest.mark.parametrize("threads", [1, 2])
def test_silhouettes_use_the_threads_of_their_worker(campaign, monkeypatch, threads):
    bop_campaign(campaign, CAMPAIGN)
    made, simulator = [], glidar.Simulator

    def record(*arguments, **more):
        made.append(more)
        return simulator(*arguments, **more)

    monkeypatch.setattr(glidar, "Simulator", record)
    plan = make_plan(read_spec(campaign.folder / "campaign.yaml"))
    for _, frames, _ in measure.Measurer(plan, threads).measure(draw_trials(plan, 0, 3)):
        frames[0].silhouettes()
    assert made == 2 * [{"threads": threads}]
