# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The object models of a BOP data set: ids, meshes in millimetres and sizes."""

import json
import os

import numpy as np

from glidar import Error
from glidar.campaign import files, loading, sensor_files, yaml_file as yf

FOLDER = "bop"
# The keys of a scene file's model that identify an object of BOP, with their defaults.
SHAPE = {"model": "", "unit": "", "up": "", "centre": "false", "size": "", "radius": "", "tube_radius": "",
         "scale": "1"}
# Formats that declare unit and up axis. Files of other formats are in metres by default.
DECLARING = (".dae", ".fbx", ".3mf", ".amf", ".gltf", ".glb")
NUMBERS = ("size", "radius", "tube_radius", "scale")
MM_PER_M = 1000.0
DISTANCES = 1 << 22  # maximum number of distances in memory


def _shape(field):
    """The values of the keys in SHAPE, normalised: different notations of a path or number are equal."""
    found = yf.entries(field)
    shape = {key: _texts(found[key]) if key in found else (default,) for key, default in SHAPE.items()}
    (model,) = shape.pop("model")
    if not model.lower().endswith(DECLARING) and shape["unit"] == ("",):
        shape["unit"] = ("m",)
    if not model.startswith("builtin:"):
        model = os.path.realpath(os.path.join(os.path.dirname(field.file), model))
    for key in NUMBERS:
        shape[key] = tuple(float(text) for text in shape[key] if text)
    if len(set(shape["scale"])) == 1:
        shape["scale"] = shape["scale"][:1]
    return model, *shape.values()


def _texts(field):
    """The text of a scalar, or the texts of a list."""
    return tuple(one.value for one in (field.items() if field.kind == "list" else [field]))


def _shapes(source):
    """The shapes of all models of a scene; empty when the scene cannot be read."""
    if source.error:
        return []
    try:
        models = yf.entries(yf.parse(source.text, source.path)).get("models")
        return [_shape(item) for item in yf.items(models, 0)] if models else []
    except (Error, ValueError):
        return []  # its trials fail and report the error


def object_ids(plan):
    """{shape: id from 1}, in the order in which the scenes list them."""
    ids = {}
    for source in plan.scenes:
        for shape in _shapes(source):
            ids.setdefault(shape, len(ids) + 1)
    return ids


def ids_by_scene(plan):
    """For each scene the ids of its models."""
    ids = object_ids(plan)
    return [[ids[shape] for shape in _shapes(source)] for source in plan.scenes]


def _require_fixed_models(plan):
    for variation in plan.spec.vary:
        if variation.target.of == "scene" and variation.target.steps[-1] in SHAPE:
            raise Error(f"{plan.spec.file}: vary.{variation.path}", "it changes the model, but the "
                        "models of a BOP data set are fixed", "other keys", "remove the key or outputs.bop")


def _camera(plan):
    """camera.json: the first readable sensor. All readable sensors must be pinhole cameras without distortion."""
    cameras, errors = [], []
    for source in (s for s in plan.sensors if not s.error):
        try:
            sensor = sensor_files.load(source)
        except Error as error:
            errors.append(error)  # its trials fail and report the error
            continue
        cameras.append((sensor, loading.intrinsics_of(sensor, source.name)))
    if not cameras:
        raise errors[0]
    sensor, k = cameras[0]
    return {"cx": k[0, 2], "cy": k[1, 2], "fx": k[0, 0], "fy": k[1, 1], "height": sensor.rows,
            "width": sensor.cols, "depth_scale": plan.spec.outputs.bop.depth_scale_mm}


def normals_of(vertices, triangles):
    """Vertex normals: sums of the triangles' normals, weighted by their angles (Thuermer and
    Wuethrich, "Computing vertex normals from polygonal facets", J. Graphics Tools 3, 1998)."""
    corners = vertices[triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    face /= np.maximum(np.linalg.norm(face, axis=1, keepdims=True), np.finfo(float).tiny)
    normals = np.zeros_like(vertices)
    for k in range(3):
        a = corners[:, (k + 1) % 3] - corners[:, k]
        b = corners[:, (k + 2) % 3] - corners[:, k]
        angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1))
        np.add.at(normals, triangles[:, k], angle[:, None] * face)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)


def diameter(points):
    """The maximum distance between two points, computed from the vertices of their convex hull."""
    from scipy.spatial import ConvexHull, QhullError

    if not np.ptp(points, axis=0).any():
        return 0.0
    centred = points - points.mean(axis=0)
    axes = np.linalg.svd(np.cov(centred.T))[0]
    extent = np.ptp(centred @ axes, axis=0)
    flat = centred @ axes[:, extent > 1e-9 * extent.max()]  # points in a plane or line have a hull of lower dimension
    if flat.shape[1] < 2:
        return float(extent.max())
    try:
        return _farthest(flat[ConvexHull(flat).vertices])
    except QhullError:  # the hull is only an optimisation
        return _farthest(flat)


def _farthest(points):
    """The maximum distance between two of the points, in blocks of rows to limit memory."""
    from scipy.spatial.distance import cdist

    step = max(1, DISTANCES // len(points))
    return float(max(cdist(points[i : i + step], points).max() for i in range(0, len(points), step)))


def ply_text(vertices_mm, normals, triangles):
    """ASCII PLY in BOP's format."""
    head = ["ply", "format ascii 1.0", f"element vertex {len(vertices_mm)}"]
    head += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
    head += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(f"{a:.9g}" for a in row) for row in np.concatenate([vertices_mm, normals], axis=1)]
    faces = [f"3 {a} {b} {c}" for a, b, c in triangles]
    return "\n".join(head + rows + faces) + "\n"


def info_of(vertices_mm):
    minimum, maximum = vertices_mm.min(axis=0), vertices_mm.max(axis=0)
    names = [f"{kind}_{axis}" for kind in ("min", "size") for axis in "xyz"]
    return {"diameter": diameter(vertices_mm),
            **dict(zip(names, [float(a) for a in (*minimum, *(maximum - minimum))]))}


def _meshes(plan):
    """(id, vertices in mm, triangles) of every object."""
    done = set()
    for source, ids in zip(plan.scenes, ids_by_scene(plan)):
        if not set(ids) - done:
            continue
        try:
            scene = loading.load_scene(source.text, source.path)
        except Error:
            continue  # its trials fail and report the error
        for index, object_id in enumerate(ids):
            if object_id not in done:
                done.add(object_id)
                instance = scene.objects[index]
                yield object_id, instance.mesh.vertices * np.asarray(instance.scale) * MM_PER_M, instance.mesh.triangles


def _contents(plan):
    """(name, bytes) of the models, models_info.json and camera.json."""
    _require_fixed_models(plan)
    camera, info = _camera(plan), {}
    for object_id, vertices_mm, triangles in _meshes(plan):
        text = ply_text(vertices_mm, normals_of(vertices_mm, triangles), triangles)
        yield f"{FOLDER}/models/obj_{object_id:06}.ply", text.encode()
        info[str(object_id)] = info_of(vertices_mm)
    yield f"{FOLDER}/models/models_info.json", files.json_bytes(info)
    yield f"{FOLDER}/camera.json", json.dumps(camera, indent=1).encode()


def write(plan, folder):
    """Writes the models, models_info.json and camera.json, and their receipt."""
    listed, written = {}, []
    with folder.temp_folder() as temp:
        for name, data in _contents(plan):
            written.append(files.prepare_bytes(temp, folder.place(name), data))
            listed[name] = [files.hash_bytes(data), len(data)]
        files.publish_all(temp, written)
        files.write_json(temp, folder.once("bop"), {"trials": 0, "failed": 0, "files": listed})
