#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Small models that unfold into much work are refused with little memory. Every file here has less than 400 kB."""

import io
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from gltf_files import Gltf, plate

MAX_PEAK_MIB = 200
TRIANGLE = "0 0 0 1 0 0 0 1 0"


def grid(side):
    """A grid of 2 side^2 triangles with positions of bytes."""
    y, x = np.mgrid[: side + 1, : side + 1]
    at = (y[:side, :side] * (side + 1) + x[:side, :side]).ravel()
    corners = np.stack([at, at + 1, at + side + 2, at, at + side + 2, at + side + 1], axis=1)
    made = Gltf()
    positions = made.accessor(np.stack([x, y, x * 0], axis=-1).reshape(-1, 3), "u1", stride=4)
    made.primitive(positions, made.accessor(corners.ravel(), "u2"))
    made.json.update(extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    return made


def copied(made, count, **accessor):
    """The first node's mesh, placed by EXT_mesh_gpu_instancing."""
    if "bufferView" in accessor:
        accessor["bufferView"] = made.view(bytes(12 * count))
    made.json["accessors"].append({"componentType": 5126, "count": count, "type": "VEC3", **accessor})
    name = "EXT_mesh_gpu_instancing"
    made.json["nodes"][0]["extensions"] = {name: {"attributes": {"TRANSLATION": len(made.json["accessors"]) - 1}}}
    made.json["extensionsUsed"] = made.json.get("extensionsUsed", []) + [name]
    return made


def with_nodes(made, count):
    made.json["nodes"] = [{"mesh": 0}] * count
    made.json["scenes"] = [{"nodes": list(range(count))}]
    return made


def unused_vertices(count):
    """A mesh of one triangle and many vertices."""
    made = Gltf()
    made.primitive(made.accessor(np.zeros((count, 3)), "u1", stride=4), [0, 1, 2])
    made.json.update(extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    return made


def many_primitives(made, count):
    made.json["meshes"][0]["primitives"] *= count
    return made


def meshopt_views(count, blocks):
    """Views of the same compressed bytes, each of blocks * 256 elements of 4 bytes, all 0."""
    packed = b"\xa0" + bytes(16 * blocks) + bytes(32)
    made = Gltf()
    first = made.view(packed)
    size = blocks * 1024
    extension = {"buffer": 0, "byteOffset": 0, "byteLength": len(packed), "byteStride": 4, "mode": "ATTRIBUTES", "count": size // 4}
    del made.json["bufferViews"][first]
    made.json.update(extensionsUsed=["KHR_mesh_quantization", "EXT_meshopt_compression"],
                     extensionsRequired=["KHR_mesh_quantization", "EXT_meshopt_compression"])
    for view in range(count):
        made.json["bufferViews"].append({"buffer": 0, "byteLength": size, "byteStride": 4,
                                         "extensions": {"EXT_meshopt_compression": extension}})
        made.json["accessors"].append({"bufferView": view, "componentType": 5121, "count": 3, "type": "VEC3"})
        made.primitive(view)
    return made


def images_of_one_view(count):
    made = plate()
    view = made.view(b"\x89PNG\r\n\x1a\n" + bytes(200_000))
    textures = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(count)]
    made.json.update(images=[{"bufferView": view, "mimeType": "image/png"}] * count, materials=textures,
                     textures=[{"source": i} for i in range(count)])
    many_primitives(made, count)
    made.json["meshes"][0]["primitives"] = [{**made.json["meshes"][0]["primitives"][0], "material": i} for i in range(count)]
    return made


def fbx(models, connections, triangles=1):
    """ASCII; models are numbered from 10, the mesh is 1, the scene is 0."""
    vertices, indices = ",".join(TRIANGLE.split() * triangles), ",".join(f"{3 * i},{3 * i + 1},{-3 * i - 3}" for i in range(triangles))
    objects = "".join(f'Model: {10 + i}, "Model::m{i}", "Mesh" {{\nVersion: 232\n}}\n' for i in range(models))
    joined = "".join(f'C: "OO",{child},{parent}\n' for child, parent in connections)
    return f"""; FBX 7.4.0 project file
FBXHeaderExtension: {{
FBXHeaderVersion: 1003
FBXVersion: 7400
}}
Objects: {{
Geometry: 1, "Geometry::g", "Mesh" {{
Vertices: *{9 * triangles} {{
a: {vertices}
}}
PolygonVertexIndex: *{3 * triangles} {{
a: {indices}
}}
}}
{objects}}}
Connections: {{
{joined}}}
"""


def chain(models, times=1):
    """Each model in the one before it, as often, the first in the scene and the mesh in the last."""
    pairs = [(10 + i, 10 + i - 1) for i in range(1, models) for _ in range(times)]
    return [(10, 0), *pairs, (1, 10 + models - 1)]


def binary_fbx(levels):
    """An element of that many nested ones."""
    size, end = 27, bytes(13)
    heads = [struct.pack("<III", size * (levels + 1) - len(end) * i, 0, 0) + b"\1a" for i in range(levels)]
    return b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400) + b"".join(heads) + (levels + 1) * end


def doubled_dae(levels):
    node = '<node id="n{}">{}</node>'
    nodes = "".join(node.format(i, 2 * f'<instance_node url="#n{i - 1}"/>') for i in range(1, levels))
    return f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">{TRIANGLE}</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X"
type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries><library_nodes>{node.format(0, '<instance_geometry url="#g"/>')}{nodes}
</library_nodes><library_visual_scenes><visual_scene id="s"><node id="r"><instance_node url="#n{levels - 1}"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def doubled_3mf(levels):
    mesh = '<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>' \
        '<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>'
    objects = "".join(f'<object id="{i + 1}" type="model"><components>{2 * f"<component objectid={chr(34)}{i}{chr(34)}/>"}</components></object>'
                      for i in range(1, levels))
    model = '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>' \
        f'{mesh}{objects}</resources><build><item objectid="{levels}"/></build></model>'
    types = '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType=' \
        '"application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType=' \
        '"application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
    relations = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model"' \
        ' Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in (("[Content_Types].xml", types), ("_rels/.rels", relations), ("3D/3dmodel.model", model)):
            archive.writestr(name, text)
    return packed.getvalue()


# name: (content, a part of the error; None: it may be accepted)
HOSTILE = {
    "copies.glb": (lambda: copied(grid(120), 1000, bufferView=0), "copies of its meshes"),
    "nodes.glb": (lambda: with_nodes(grid(120), 1000), "copies of its meshes"),
    "copies of zeros.glb": (lambda: copied(plate(), 1_000_000), "meshes, which is the limit"),
    "vertices.glb": (lambda: with_nodes(unused_vertices(60_000), 1000), "copies of its meshes"),
    "primitives.glb": (lambda: many_primitives(grid(120), 1000), "numbers in its accessors"),
    "meshopt.glb": (lambda: meshopt_views(300, 4000), "bytes in memory"),
    "images.glb": (lambda: images_of_one_view(500), "bytes in memory"),
    "cycle.fbx": (lambda: fbx(3, [(10, 0), (11, 10), (12, 11), (11, 12), (1, 12)]), ""),
    "doubled.fbx": (lambda: fbx(30, chain(30, 2)), ""),
    "placed often.fbx": (lambda: fbx(2000, [(10 + i, 0) for i in range(2000)] + [(1, 10 + i) for i in range(2000)], 1500), ""),
    "deep.fbx": (lambda: fbx(1, chain(1)) + "a: {\n" * 50_000 + "}\n" * 50_000, None),
    "deep binary.fbx": (lambda: binary_fbx(14_000), ""),
    "long chain.fbx": (lambda: fbx(5000, chain(5000)), None),
    "doubled.dae": (lambda: doubled_dae(40), ""),
    "doubled.3mf": (lambda: doubled_3mf(40), ""),
}


def write(path, content):
    if isinstance(content, Gltf):
        content.write(path)
    else:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


class ImportCost(unittest.TestCase):
    def setUp(self):
        temp = tempfile.TemporaryDirectory()
        self.addCleanup(temp.cleanup)
        self.folder = Path(temp.name)

    def test_small_files_that_unfold_are_refused_with_little_memory(self):
        for name, (content, words) in HOSTILE.items():
            with self.subTest(name):
                path = self.folder / name
                write(path, content())
                self.assertLess(path.stat().st_size, 400_000)
                code, printed, peak_mib = self.info(path)
                self.assertLess(peak_mib, MAX_PEAK_MIB, printed)
                if words is None:
                    self.assertIn(code, (0, 2), printed)
                    continue
                self.assertEqual(code, 2, printed)
                self.assertIn(words, printed)

    def info(self, path):
        """Exit code, output, and the peak memory in MiB of the program or the process that reads the model."""
        printed = self.folder / "printed"
        with printed.open("w", encoding="utf-8") as file:
            process = subprocess.Popen(["glidar", "info", str(path), "--no-cache"], stdout=file, stderr=subprocess.STDOUT)
            _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, printed.read_text(encoding="utf-8"), used.ru_maxrss / 1024


if __name__ == "__main__":
    unittest.main()
