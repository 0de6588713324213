#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Textures that a model names by the path of another machine: without --texture-folder the note states it as the
remedy, with it they are found by their file name. In every format that names textures."""

import json
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

NAMES = ["C:\\art\\wood.png", "C:/art/wood.png", "/home/me/art/wood.png", "\\\\server\\art\\wood.png"]
REMEDY = "not found; name a folder above it with --texture-folder, or copy it into the model's folder"


def png():
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0\x80\x40\x20")) + chunk(b"IEND", b"")


def obj(name):
    shape = "mtllib a.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    return {"a.obj": shape, "a.mtl": f"newmtl paint\nmap_Kd {name}\n"}


def gltf(name):
    buffer = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
    document = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "images": [{"uri": name}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}], "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "buffers": [{"byteLength": 60, "uri": buffer}]}  # fmt: skip
    return {"a.gltf": json.dumps(document)}


def collada(name):
    return {"a.dae": f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_images><image id="i"><init_from>{name}</init_from></image></library_images><library_effects><effect id="e"><profile_COMMON>
<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam><newparam sid="t"><sampler2D><source>f</source>
</sampler2D></newparam><technique sid="x"><lambert><diffuse><texture texture="t" texcoord="c"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects><library_materials><material id="m"><instance_effect url="#e"/></material>
</library_materials><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0
</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1" material="k"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="k" target="#m"/></technique_common>
</bind_material></instance_geometry></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"""}


def fbx(name):
    return {"a.fbx": f"""; FBX 7.4.0 project file
FBXHeaderExtension: {{ FBXHeaderVersion: 1003
FBXVersion: 7400 }}
Objects: {{
Model: 2000, "Model::node", "Mesh" {{ Version: 232 }}
Geometry: 3000, "Geometry::shape", "Mesh" {{ Vertices: *9 {{ a: 0,0,0,1,0,0,0,1,0 }}
PolygonVertexIndex: *3 {{ a: 0,1,-3 }}
GeometryVersion: 124
LayerElementMaterial: 0 {{ Version: 101
Name: ""
MappingInformationType: "AllSame"
ReferenceInformationType: "IndexToDirect"
Materials: *1 {{ a: 0 }} }}
Layer: 0 {{ Version: 100
LayerElement: {{ Type: "LayerElementMaterial"
TypedIndex: 0 }} }} }}
Material: 4000, "Material::paint", "" {{ Version: 102
ShadingModel: "lambert" }}
Texture: 5000, "Texture::t", "" {{ Type: "TextureVideoClip"
Version: 202
FileName: "{name}"
RelativeFilename: "{name}" }} }}
Connections: {{
C: "OO",2000,0
C: "OO",3000,2000
C: "OO",4000,2000
C: "OP",5000,4000, "DiffuseColor" }}
"""}


FORMATS = {"OBJ": obj, "glTF": gltf, "COLLADA": collada, "FBX": fbx}


class TextureNames(unittest.TestCase):
    def info(self, files, *options):
        """The report of a model whose texture is in the folder `art` beside that of the model."""
        with tempfile.TemporaryDirectory() as temp:
            (Path(temp) / "model").mkdir()
            (Path(temp) / "art").mkdir()
            (Path(temp) / "art" / "wood.png").write_bytes(png())
            for name, text in files.items():
                (Path(temp) / "model" / name).write_text(text)
            done = subprocess.run(["glidar", "info", "--json", "--no-cache", f"model/{next(iter(files))}", *options], cwd=temp,
                                  capture_output=True, text=True, check=False)  # fmt: skip
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(done.stdout)

    def test_a_name_of_another_machine_is_reported_with_the_remedy(self):
        for name, make in FORMATS.items():
            for texture in NAMES:
                with self.subTest(name, texture=texture):
                    found = self.info(make(texture))
                    self.assertEqual(found["textures"], [])
                    self.assertEqual([one["reason"] for one in found["missing_textures"]], [REMEDY])

    def test_the_texture_folder_is_searched_for_the_name_of_the_file(self):
        for name, make in FORMATS.items():
            for texture in NAMES:
                with self.subTest(name, texture=texture):
                    found = self.info(make(texture), "--texture-folder", "art")
                    self.assertEqual(found["missing_textures"], [])
                    self.assertEqual(len(found["textures"]), 1)


if __name__ == "__main__":
    unittest.main()
