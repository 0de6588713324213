#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glTF files: each statement is used, named in a note, or refused with its JSON path. The files are made here; their
shape is compared with that which NumPy reads by the standard."""

import base64
import json
import os
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from gltf_files import Gltf, Reader, plate

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
LEVELS = [[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0]]


def info(path):
    """The report of `glidar info`, or the text of its error."""
    done = subprocess.run(["glidar", "info", str(path), "--json", "--no-cache", "--up", "z"], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else done.stderr


def area(triangles):
    return 0.5 * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum()


def with_nodes(nodes, **more):
    made = plate()
    made.json.update(nodes=nodes, **more)
    return made


def positions(kind, normalized=False, stride=0, extension=True):
    made = Gltf()
    made.primitive(made.accessor(LEVELS, kind, stride, normalized=normalized), [0, 1, 2, 0, 2, 3])
    if extension:
        made.json.update(extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    return made


def sparse(indices=(1, 2), base=True):
    made = plate()
    accessor = made.json["accessors"][0]
    if not base:
        del accessor["bufferView"]
    where = made.view(np.array(indices, "<u2").tobytes())
    values = made.view(np.array([[5, 0, 0], [5, 5, 0]][:len(indices)], "<f4").tobytes())
    accessor["sparse"] = {"count": len(indices), "indices": {"bufferView": where, "componentType": 5123},
                          "values": {"bufferView": values}}
    return made


def morphed(mesh_weights=None, node_weights=None):
    made = plate()
    deltas = made.accessor([[0, 0, 0], [1, 0, 0], [1, 0, 2], [0, 0, 2]])
    made.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": deltas}]
    if mesh_weights:
        made.json["meshes"][0]["weights"] = mesh_weights
    if node_weights:
        made.json["nodes"][0]["weights"] = node_weights
    return made


def skinned(bind=None, joints_kind="u1", weights_kind="f4", joints=((0, 1, 0, 0),) * 4, weights=None, nodes=None, inside=False):
    made = plate()
    weights = [[1, 0, 0, 0], [0.5, 0.5, 0, 0], [0.5, 0.5, 0, 0], [1, 0, 0, 0]] if weights is None else weights
    scale = {"f4": 1, "u1": 255, "u2": 65535}[weights_kind]
    attributes = made.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = made.accessor(joints, joints_kind)
    attributes["WEIGHTS_0"] = made.accessor(np.array(weights) * scale, weights_kind, normalized=weights_kind != "f4")
    made.json["nodes"] = nodes or [{"mesh": 0, "skin": 0, "translation": [50, 0, 0]}, {"translation": [0, 0, 1]},
                                   {"translation": [0, 3, 0], "rotation": [0, 0, 0.6, 0.8]}]
    made.json["scenes"] = [{"nodes": [0, 1, 2]}]
    if inside:
        made.json["nodes"][0]["children"], made.json["scenes"] = [1], [{"nodes": [0, 2]}]
    made.json["skins"] = [{"joints": [1, 2]}]
    if bind is not None:
        made.json["skins"][0]["inverseBindMatrices"] = made.accessor(np.array(bind).transpose(0, 2, 1))
    return made


def copies(**attributes):
    made = plate()
    named = {name: made.accessor(values, kind, normalized=kind != "f4") for name, (values, kind) in attributes.items()}
    made.json["nodes"][0].update(translation=[1, 2, 3], extensions={"EXT_mesh_gpu_instancing": {"attributes": named}})
    made.json.update(extensionsUsed=["EXT_mesh_gpu_instancing"], extensionsRequired=["EXT_mesh_gpu_instancing"])
    return made


def drawn(mode, indices):
    made = Gltf()
    made.primitive([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0]], indices, mode=mode)
    return made


def changed(change, base=plate):
    """A sound file after a change of its JSON."""
    made = base()
    change(made.json)
    return made


SCALE = np.diag([0.01, 0.01, 0.01, 1.0])
ROUNDED = np.array([[1, 0, 0, -1], [0, 1, 0, 2], [0, 0, 1, 0], [0, 1e-7, 0, 1 - 1e-6]])
PROJECTION = np.array([[1, 0, 0, -1], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 1e-3, 1.0]])
SHIFT = np.array([[1, 0, 0, -1], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 0, 1.0]])

# Their shape must be that which NumPy reads.
SHAPES = {
    "floats": plate,
    "without indices": lambda: drawn(4, None),
    "indices of 8 bits": lambda: indexed("u1"),
    "indices of 32 bits": lambda: indexed("u4"),
    **{f"positions {kind}{' normalized' * normalized}{f' in {stride} bytes' * bool(stride)}":
       (lambda kind=kind, normalized=normalized, stride=stride: positions(kind, normalized, stride))
       for kind in ("i1", "u1", "i2", "u2") for normalized in (False, True) for stride in (0, 8, 12)},
    "floats in 28 bytes": lambda: positions("f4", stride=28),
    "sparse": sparse,
    "sparse without base": lambda: sparse(base=False),
    "morph at the mesh": lambda: morphed([0.5]),
    "morph at the node": lambda: morphed([0.5], [0.25]),
    "morph of weight 0": morphed,
    "strip": lambda: drawn(5, [0, 1, 2, 3, 4]),
    "strip without indices": lambda: drawn(5, None),
    "fan": lambda: drawn(6, [0, 1, 3, 2, 4]),
    "skin": lambda: skinned([SCALE, SHIFT]),
    "skin without bind matrices": skinned,
    "skin of 16-bit joints": lambda: skinned([SHIFT, SCALE], joints_kind="u2"),
    "skin of 16-bit weights": lambda: skinned(weights_kind="u2", weights=[[1, 0, 0, 0]] * 4),
    "skin of 8-bit weights": lambda: skinned(weights_kind="u1", weights=[[1, 0, 0, 0]] * 4),
    "skin with its joint below the mesh": lambda: skinned([SHIFT, SCALE], inside=True),
    "matrix": lambda: with_nodes([{"mesh": 0, "matrix": [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 3, 0, 5, 6, 7, 1]}]),
    "mirrored": lambda: with_nodes([{"mesh": 0, "scale": [-2, 1, 1]}]),
    "tree": lambda: with_nodes([{"children": [1, 2], "rotation": [0.5, 0.5, 0.5, 0.5]}, {"mesh": 0, "translation": [1, 2, 3]},
                                {"mesh": 0, "scale": [3, 3, 3], "children": [3]}, {"mesh": 0, "translation": [0, 0, 9]}]),
    "second scene": lambda: with_nodes([{"mesh": 0}, {"mesh": 0, "translation": [7, 0, 0]}], scene=1,
                                       scenes=[{"nodes": [0]}, {"nodes": [1]}]),
    "no scene": lambda: changed(lambda json: [json.pop("scene"), json.pop("scenes"), json["nodes"].append({"mesh": 0, "scale": [2, 1, 1]})]),
}


def indexed(kind):
    made = Gltf()
    made.primitive(SQUARE, made.accessor([0, 1, 2, 0, 2, 3], kind))
    return made


def pop_views(json):
    json["accessors"][0].update(bufferView=7)


# What the error must contain.
REFUSED = {
    "index of a vertex": (lambda: drawn(4, [0, 1, 9]), "meshes[0].primitives[0].indices: index 2 names vertex 9 of 5"),
    "cut indices": (lambda: changed(lambda j: j["accessors"][1].update(count=7)), "accessors[1]: 7 elements of 2 bytes"),
    "huge count": (lambda: changed(lambda j: j["accessors"][0].update(count=10**15)), "accessors[0]: 1000000000000000 elements"),
    "huge zeros": (lambda: changed(lambda j: [j["accessors"][0].pop("bufferView"), j["accessors"][0].update(count=10**12)]),
                   "accessors[0]: 1000000000000 elements without data"),
    "view beyond its buffer": (lambda: changed(lambda j: j["bufferViews"][0].update(byteLength=999)), "bufferViews[0]: bytes 0 to 999"),
    "missing view": (lambda: changed(pop_views), "accessors[0].bufferView: there is no bufferViews[7]"),
    "buffer cut off": (lambda: changed(lambda j: j.update(buffers=[{"byteLength": 60, "uri": "data:,short"}])), "buffers[0].byteLength: 60 bytes"),
    "malformed data URI": (lambda: changed(lambda j: j.update(buffers=[{"byteLength": 6, "uri": "data:;base64,@@@"}])), "buffers[0].uri"),
    "buffer on a network": (lambda: changed(lambda j: j.update(buffers=[{"byteLength": 6, "uri": "https://a/b.bin"}])), "on a network"),
    "overlapping elements": (lambda: changed(lambda j: j["bufferViews"][0].update(byteStride=8)), "byteStride is 8"),
    "component type": (lambda: changed(lambda j: j["accessors"][0].update(componentType=5124)), "accessors[0].componentType: 5124"),
    "type": (lambda: changed(lambda j: j["accessors"][0].update(type="VEC2")), "has 2 components, 3 are needed"),
    "normalized floats": (lambda: changed(lambda j: j["accessors"][0].update(normalized=True)), "accessors[0].normalized"),
    "minimum": (lambda: changed(lambda j: j["accessors"][0].update(min=[-1, 0, 0])), "accessors[0].min[0]: -1 is stated, the data has 0"),
    "maximum": (lambda: changed(lambda j: j["accessors"][0].update(max=[1, 0.5, 0])), "accessors[0].max[1]: 0.5 is stated, the data has 1"),
    "sparse order": (lambda: sparse((2, 1)), "accessors[0].sparse.indices: index 1 after 2"),
    "sparse twice": (lambda: sparse((1, 1)), "accessors[0].sparse.indices: index 1 after 1"),
    "sparse beyond": (lambda: sparse((1, 4)), "accessors[0].sparse.indices: index 4 of 4"),
    "cycle": (lambda: with_nodes([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), "nodes[1]: the node is below itself"),
    "own child": (lambda: with_nodes([{"mesh": 0}, {"children": [1]}]), "nodes[1]: the node is below itself"),
    "two parents": (lambda: with_nodes([{"children": [2]}, {"children": [2]}, {"mesh": 0}]), "nodes[1].children[0]: nodes[2] has another parent"),
    "twice a child": (lambda: with_nodes([{"children": [1, 1]}, {"mesh": 0}]), "nodes[0].children[1]"),
    "root with a parent": (lambda: with_nodes([{"mesh": 0}, {"children": [0]}]), "scenes[0].nodes[0]: nodes[0] is no root"),
    "missing node": (lambda: changed(lambda j: j["scenes"][0].update(nodes=[3])), "scenes[0].nodes[0]: there is no nodes[3]"),
    "missing scene": (lambda: changed(lambda j: j.update(scene=2)), "scene: there is no scenes[2]"),
    "missing mesh": (lambda: with_nodes([{"mesh": 4}]), "nodes[0].mesh: there is no meshes[4]"),
    "matrix and scale": (lambda: with_nodes([{"mesh": 0, "matrix": np.eye(4).ravel().tolist(), "scale": [1, 1, 1]}]), "nodes[0].matrix"),
    "projection": (lambda: with_nodes([{"mesh": 0, "matrix": [1, 0, 0, 1] + [0, 1, 0, 0] + [0, 0, 1, 0] + [0, 0, 0, 1]}]), "no affine transform"),
    "bind matrix of a projection": (lambda: skinned([SCALE, PROJECTION]), "skins[0].inverseBindMatrices: the last row of matrix 1 is not 0, 0, 0, 1"),
    "zero rotation": (lambda: with_nodes([{"mesh": 0, "rotation": [0, 0, 0, 0]}]), "nodes[0].rotation"),
    "short translation": (lambda: with_nodes([{"mesh": 0, "translation": [0, 0]}]), "nodes[0].translation: 2 numbers, 3 are needed"),
    "text for a number": (lambda: with_nodes([{"mesh": 0, "scale": ["1", 1, 1]}]), "nodes[0].scale"),
    "negative index": (lambda: with_nodes([{"mesh": -1}]), "nodes[0].mesh: -1"),
    "mode": (lambda: drawn(7, [0, 1, 2]), "meshes[0].primitives[0].mode"),
    "normals of another number": (lambda: plate_with("NORMAL", [[0, 0, 1]] * 3), "attributes.NORMAL: accessors[2] has 3 elements for 4 vertices"),
    "uvs of plain integers": (lambda: plate_with("COLOR_0", [[1, 2, 3]] * 4, "u1"), "accessors[2].componentType"),
    "missing joint": (lambda: skinned(joints=[(0, 5, 0, 0)] * 4), "joint 5 of 2"),
    "vertex without a weight": (lambda: skinned(weights=[[0, 0, 0, 0]] * 4), "vertex 0 has no joint"),
    "few bind matrices": (lambda: skinned([SCALE]), "skins[0].inverseBindMatrices: 1 matrices for 2 joints"),
    "missing weights": (lambda: changed(lambda j: j["meshes"][0]["primitives"][0]["attributes"].pop("WEIGHTS_0"), skinned), "WEIGHTS_0: it is missing"),
    "weights of targets": (lambda: morphed([0.5, 0.5]), "meshes[0].weights: 2 numbers, 1 are needed"),
    "version 1": (lambda: changed(lambda j: j["asset"].update(version="1.0")), "glTF version '1.0': GLIDAR reads version 2"),
    "lists by name": (lambda: changed(lambda j: j.update(meshes={})), "glTF version 1.0"),
    "no version": (lambda: changed(lambda j: j.pop("asset")), "asset: it is missing"),
    "later version": (lambda: changed(lambda j: j["asset"].update(minVersion="2.1")), "asset.minVersion: glTF version '2.1'"),
    "unknown requirement": (lambda: changed(lambda j: j.update(extensionsRequired=["ABC_curved_space"])),
                            "extensionsRequired[0]: it requires the extension 'ABC_curved_space'"),
    "alpha mode": (lambda: material(alphaMode="GLASS"), "materials[0].alphaMode: 'GLASS'"),
    "missing material": (lambda: plate(material=3), "meshes[0].primitives[0].material: there is no materials[3]"),
    "wrapping mode": (lambda: textured({"wrapS": 1}), "samplers[0].wrapS: 1 is no wrapping mode"),
    "copies that differ in number": (lambda: copies(TRANSLATION=([[1, 0, 0]] * 3, "f4"), SCALE=([[1, 1, 1]] * 2, "f4")), "differ in number"),
}


def plate_with(name, values, kind="f4", **more):
    made = plate()
    made.json["meshes"][0]["primitives"][0]["attributes"][name] = made.accessor(values, kind, **more)
    return made


def material(extensions=None, **more):
    made = plate(material=0)
    made.json["materials"] = [{**more, **({"extensions": extensions} if extensions else {})}]
    if extensions:
        made.json["extensionsUsed"] = list(extensions)
    return made


def textured(sampler):
    made = material(pbrMetallicRoughness={"baseColorTexture": {"index": 0}})
    made.json.update(samplers=[sampler], images=[{"uri": "a.png"}], textures=[{"source": 0, "sampler": 0}])
    return made


def points_too(mode):
    made = plate()
    made.primitive(SQUARE, [0, 1, 2, 3], mode=mode)
    return made


# What the notes must contain; the shape is complete.
NOTED = {
    "extension": (lambda: material({"KHR_materials_clearcoat": {}}), "the extension KHR_materials_clearcoat is left out (materials[0])"),
    "extension of the list alone": (lambda: changed(lambda j: j.update(extensionsUsed=["ABC_def"])), "the extension ABC_def is left out"),
    "extension that is not listed": (lambda: changed(lambda j: j["nodes"][0].update(extensions={"ABC_ghi": {}})), "ABC_ghi is left out (nodes[0])"),
    "lights that are required": (lambda: changed(lambda j: j.update(extensionsRequired=["KHR_lights_punctual"], extensionsUsed=["KHR_lights_punctual"])),
                                 "the extension KHR_lights_punctual is left out"),
    "shaders that are required": (lambda: changed(lambda j: j.update(extensionsRequired=["KHR_techniques_webgl"])),
                                  "the extension KHR_techniques_webgl is left out"),
    "rounded matrix of a node": (lambda: with_nodes([{"mesh": 0, "matrix": ROUNDED.T.ravel().tolist()}]),
                                 "nodes[0].matrix: the last row of a matrix is rounded: read as 0, 0, 0, 1"),
    "rounded bind matrix": (lambda: skinned([SCALE, ROUNDED]), "skins[0].inverseBindMatrices: the last row of a matrix is rounded: read as 0, 0, 0, 1"),
    "unknown member": (lambda: changed(lambda j: j["nodes"][0].update(colour=3)), "nodes[0].colour is not part of glTF 2.0"),
    "animations": (lambda: changed(lambda j: j.update(animations=[{}, {}])), "2 animations are left out"),
    "cameras": (lambda: changed(lambda j: j.update(cameras=[{}])), "1 cameras are left out"),
    "points": (lambda: points_too(0), "4 points and lines are left out"),
    "lines": (lambda: points_too(1), "2 points and lines are left out"),
    "line loop": (lambda: points_too(2), "4 points and lines are left out"),
    "line strip": (lambda: points_too(3), "3 points and lines are left out"),
    "other scenes": (lambda: changed(lambda j: j["scenes"].append({})), "scenes[0] of 2 scenes is loaded: it is the default"),
    "no default scene": (lambda: changed(lambda j: [j.pop("scene"), j["scenes"].append({})]), "the file names no default"),
    "limits of indices": (lambda: changed(lambda j: j["accessors"][1].update(min=[0], max=[7])), "accessors[1].max[0]: 7 is stated, the data has 3"),
    "nodes outside": (lambda: changed(lambda j: j["nodes"].append({"mesh": 0})), "1 nodes with meshes are not in the scene"),
    "hidden nodes": (lambda: changed(lambda j: [j["nodes"].append({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}}),
                                                j["scenes"][0].update(nodes=[0, 1])]), "1 nodes are hidden"),
    "emission": (lambda: material(emissiveFactor=[1, 0, 0]), "light that surfaces emit is left out"),
    "replaced surface": (lambda: material({"KHR_materials_pbrSpecularGlossiness": {}}, pbrMetallicRoughness={}), "replaces pbrMetallicRoughness"),
    "occlusion": (lambda: material(occlusionTexture={"index": 0}), "textures of occlusion are left out"),
    "roughness": (lambda: material(pbrMetallicRoughness={"metallicRoughnessTexture": {"index": 0}}), "textures of metal and roughness are left out"),
    "attribute of its own": (lambda: plate_with("_AGE", np.zeros(4)), "attributes are left out: _AGE"),
    "third set of uvs": (lambda: plate_with("TEXCOORD_2", np.zeros((4, 2))), "attributes are left out: TEXCOORD_2"),
    "joints without a skin": (lambda: plate_with("JOINTS_0", np.zeros((4, 4)), "u1"), "joints of a mesh without a skin are left out"),
    "left-over corners": (lambda: drawn_plus(), "1 corners form no triangle"),
    "opacity of vertices": (lambda: plate_with("COLOR_0", [[1, 1, 1, 0.5]] * 4), "the opacity of vertex colours is left out"),
}


def drawn_plus():
    made = Gltf()
    made.primitive(SQUARE, [0, 1, 2, 0, 2, 3, 1])
    return made


class GltfReader(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def read(self, made, name="a.gltf"):
        report = info(made.write(self.folder / name))
        self.assertIsInstance(report, dict, report)
        return report

    def compare(self, report, triangles):
        self.assertEqual(report["triangles"], len(triangles))
        corners = triangles.reshape(-1, 3)
        size = max(1e-30, np.ptp(corners, axis=0).max())
        np.testing.assert_allclose(report["min_m"], corners.min(0), atol=1e-6 * size, rtol=1e-6)
        np.testing.assert_allclose(report["max_m"], corners.max(0), atol=1e-6 * size, rtol=1e-6)
        self.assertLess(abs(report["check"]["area_m2"] - area(triangles)), 1e-5 * max(area(triangles), 1e-30))

    def test_shapes_are_those_of_the_standard(self):
        for name, make in SHAPES.items():
            for suffix in (".gltf", ".glb"):
                with self.subTest(name, suffix=suffix):
                    made = make()
                    self.compare(self.read(made, "a" + suffix), Reader(self.folder / ("a" + suffix)).triangles())

    def test_what_the_document_states_is_loaded(self):
        for name, make in SHAPES.items():
            with self.subTest(name):
                report = self.read(make())
                stated, loaded = report["stated"], report["loaded"]
                self.assertEqual((stated["faces"], stated["instances"]), (loaded["faces"], loaded["instances"]))
                self.assertEqual(stated["vertices"] - loaded["vertices"], 2 if name == "without indices" else 0)  # of 5, no triangle has

    def test_boxes_are_stated_by_the_limits_of_positions_through_the_nodes(self):
        turned = with_nodes([{"mesh": 0, "rotation": [0, 0, 0.6, 0.8]}])
        for name, made, top in (("floats", plate(), 1), ("normalized", positions("u2", True), 100), ("turned", turned, 1), ("morph", morphed([0.5]), 1),
                                *((name, SHAPES[name](), 1) for name in ("matrix", "mirrored", "tree"))):
            with self.subTest(name):
                made.json["accessors"][0].update(min=[0, 0, 0], max=[top, top, 0])
                report = self.read(made)
                if name in ("turned", "morph"):  # the box of a box is larger
                    self.assertIsNone(report["stated"]["min"])
                    continue
                for key in ("min", "max"):
                    np.testing.assert_allclose(report["stated"][key], report["loaded"][key], atol=1e-6)

    def test_vertices_that_no_triangle_has_are_stated_and_not_loaded(self):
        made = Gltf()
        made.primitive([*SQUARE, [9, 9, 9]], [0, 1, 2, 0, 2, 3])
        made.json["accessors"][0].update(min=[0, 0, 0], max=[9, 9, 9])
        report = self.read(made)
        self.assertEqual((report["stated"]["vertices"], report["loaded"]["vertices"]), (5, 4))
        np.testing.assert_allclose(report["stated"]["max"], [9, 9, 9])
        np.testing.assert_allclose(report["loaded"]["max"], [1, 1, 0])

    def test_too_many_copies_of_a_mesh_are_refused(self):
        count = (1 << 20) + 1
        made = copies(TRANSLATION=(np.zeros((count, 3)), "f4"))
        made.json["buffers"] = [{"byteLength": len(made.bytes), "uri": "a.bin"}]
        (self.folder / "a.bin").write_bytes(made.bytes)
        self.assertIn("more than 1048576 meshes, which is the limit", str(info(made.write(self.folder / "a.gltf"))))

    def test_invalid_statements_are_refused_with_their_path(self):
        for name, (make, message) in REFUSED.items():
            with self.subTest(name):
                self.assertIn(message, str(info(make().write(self.folder / "a.gltf"))))

    def test_what_is_not_used_is_noted(self):
        for name, (make, note) in NOTED.items():
            with self.subTest(name):
                report = self.read(make())
                self.assertEqual(report["triangles"], 2)
                self.assertTrue(any(note in one for one in report["notes"]), report["notes"])

    def test_a_sound_file_has_no_notes(self):
        made = plate(material=0)
        made.json["materials"] = [{"name": "paint", "doubleSided": True, "extras": {"any": 1}, "alphaCutoff": 0.5}]
        self.assertEqual(self.read(made)["notes"], [])

    def test_copies_are_placed_by_the_node_and_their_own_transform(self):
        made = copies(TRANSLATION=([[0, 0, 0], [5, 0, 0], [10, 0, 0]], "f4"), ROTATION=([[0, 0, 0, 127]] * 3, "i1"),
                      SCALE=([[1, 1, 1], [1, 1, 1], [2, 2, 2]], "f4"))
        report = self.read(made)
        self.assertEqual(report["triangles"], 6)
        np.testing.assert_allclose(report["min_m"], [1, 2, 3])
        np.testing.assert_allclose(report["max_m"], [13, 4, 3])

    def test_a_byte_order_mark_and_percent_encoded_names_are_read(self):
        made = plate()
        made.json["buffers"] = [{"byteLength": len(made.bytes), "uri": "my%20data%C3%A9.bin"}]
        (self.folder / "my dataé.bin").write_bytes(made.bytes)
        path = made.write(self.folder / "a.gltf")
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
        self.assertEqual(info(path)["triangles"], 2)

    def test_schemes_of_data_uris_are_in_letters_of_any_case(self):
        made = plate()
        uri = "Data:application/octet-stream;BASE64," + base64.b64encode(made.bytes).decode()
        made.json["buffers"] = [{"byteLength": len(made.bytes), "uri": uri}]
        self.assertEqual(self.read(made)["triangles"], 2)

    def test_damaged_containers_are_refused(self):
        sound = plate().write(self.folder / "a.glb").read_bytes()
        cases = {"cut off": (sound[:-8], "its length is"), "version 1": (sound[:4] + b"\1" + sound[5:], "glTF version 1"),
                 "head alone": (sound[:8], "header: it is cut off"), "first chunk": (sound.replace(b"JSON", b"BIN\0", 1), "first one is not of the type JSON")}
        for name, (data, message) in cases.items():
            with self.subTest(name):
                (self.folder / "b.glb").write_bytes(data)
                self.assertIn(message, str(info(self.folder / "b.glb")))
        (self.folder / "c.glb").write_bytes(sound + b"tail")
        self.assertIn("4 bytes after the end of the .glb data are left out", info(self.folder / "c.glb")["notes"])

    def test_malformed_json_is_refused_with_its_place(self):
        for text, message in {'{"asset":\n{"version":"2.0"': "line 2", '{"asset":{"version":"2.0"},"nodes":[],"nodes":[]}': "'nodes' twice",
                              "[" * 100_000: "more than 64 levels", '{"asset":{"version":"2.0"},"scene":1e999}': "a number is too large",
                              "[]": "it is not an object"}.items():
            with self.subTest(text[:40]):
                (self.folder / "a.gltf").write_text(text)
                self.assertIn(message, str(info(self.folder / "a.gltf")))

    def test_materials_keep_their_names_and_textures(self):
        made = textured({"wrapS": 33071, "magFilter": 9728})
        made.json["images"] = [{"uri": " t%20t.ppm"}]
        made.json["materials"][0]["name"] = "paint"
        (self.folder / " t t.ppm").write_bytes(b"P6 1 1 255\nabc")
        report = self.read(made)
        self.assertEqual(report["missing_textures"], [])
        self.assertEqual(report["materials"][0]["name"], "paint")
        self.assertEqual(report["materials"][0]["diffuse_texture"], " t%20t.ppm")

    def test_the_corpus_of_the_fuzzer_is_read_or_refused(self):
        read = 0
        for seed in zipfile.Path(Path(__file__).resolve().parents[2] / "fuzz/corpus/gltf.zip").iterdir():
            with self.subTest(seed.name):
                path = self.folder / "a.gltf"
                path.write_bytes(seed.read_bytes())
                report = info(path)
                self.assertNotIn("the import process", str(report))
                read += isinstance(report, dict)
        self.assertGreater(read, 5)

    def test_models_of_others_have_the_shape_that_numpy_reads(self):
        folders = [Path(__file__).resolve().parents[3] / "models"]
        if "GLIDAR_DATA" in os.environ:
            folders.append(Path(os.environ["GLIDAR_DATA"]) / "textured")
        compared = 0
        for path in sorted(path for folder in folders for suffix in ("gltf", "glb") for path in folder.rglob("*." + suffix)):
            reader = Reader(path)
            if reader.json.get("extensionsRequired") or path.stat().st_size > 5_000_000:
                continue
            triangles = reader.triangles()
            if len(triangles) == 0:
                continue
            with self.subTest(str(path)):
                self.compare(info(path), triangles)
                compared += 1
        self.assertGreater(compared, 0)


if __name__ == "__main__":
    unittest.main()
