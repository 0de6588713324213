#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""COLLADA and 3MF: a sound shape is not refused for its decorations, and what is left out is noted or refused.
Formats that GLIDAR does not read are named."""

import io
import json
import subprocess
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

SQUARE = "0 0 0 1 0 0 1 1 0 0 1 0"
TWO = '<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles>'


def dae(primitives=TWO, more="", inside="", controller="", instance='<instance_geometry url="#g"/>', sources=""):
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>{more}
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">{SQUARE}</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>{sources}
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{primitives}</mesh></geometry></library_geometries>{controller}
<library_visual_scenes><visual_scene id="s">{inside}<node id="n">{instance}</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


CAMERAS = '<library_cameras>' + 2 * '<camera id="c" name="c"><optics><technique_common><perspective><xfov>1</xfov><znear>1</znear>' \
    '<zfar>2</zfar></perspective></technique_common></optics></camera>' + '</library_cameras>'
EFFECT = '<library_images>{image}</library_images><library_effects><effect id="e"><profile_COMMON><newparam sid="f"><surface type="2D">' \
    '<init_from>i</init_from></surface></newparam><newparam sid="t"><sampler2D><source>f</source></sampler2D></newparam>' \
    '<technique sid="x"><lambert><diffuse>{diffuse}</diffuse></lambert></technique></profile_COMMON></effect></library_effects>' \
    '<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>'
TANGENTS = '<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="{}" source="#p" offset="1"/>' \
    '<p>0 0 1 1 2 2 0 0 2 2 3 3</p></triangles>'

# name: document, what a note must contain ("": there is none)
SOUND = {
    "plain": (dae(), ""),
    "cameras of one name": (dae(more=CAMERAS, inside=2 * '<node><instance_camera url="#c"/></node>'), "left out: library_cameras"),
    "lights": (dae(more="<library_lights><light id='l'/></library_lights>", inside='<node><instance_light url="#l"/></node>'), "library_lights"),
    "image without a file": (dae(more=EFFECT.format(image='<image id="i"><init_from/></image>', diffuse='<texture texture="t"/>')),
                             "a texture without a file is left out: 't'"),
    "texture without an image": (dae(more=EFFECT.format(image="", diffuse='<texture texture="t"/>')), "a texture without a file"),
    "colours after white space": (dae(more=EFFECT.format(image="", diffuse="<color>\n  0 0.5 0 1 </color>")), ""),
    "colours of three numbers": (dae(more=EFFECT.format(image="", diffuse="<color>0 0.5 0</color>")), ""),
    "parameters without names": (dae().replace(' name="X"', "").replace(' name="Y"', "").replace(' name="Z"', ""), "read in their order"),
    "tangents without binormals": (dae(TANGENTS.format("TEXTANGENT")), ""),
    "binormals without tangents": (dae(TANGENTS.format("TEXBINORMAL")), ""),
    "inputs of its own": (dae(TANGENTS.format("SPEED")), "inputs are left out: SPEED"),
    "strip": (dae('<tristrips count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 3 2</p></tristrips>'), ""),
    "fan": (dae('<trifans count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 3</p></trifans>'), ""),
    "spline": (dae().replace("</geometry>", "</geometry><geometry id='k'><spline/></geometry>"), "geometries are <spline>: left out"),
    "prefixed names": (dae().replace("xmlns=", "xmlns:d=").replace("<COLLADA", "<d:COLLADA").replace("</COLLADA", "</d:COLLADA"), ""),
}
REFUSED = {
    "holes": (dae('<polygons count="1"><input semantic="VERTEX" source="#v" offset="0"/><ph><p>0 1 2 3</p><h>0 1 2</h></ph></polygons>'),
              "polygons with holes"),
    "skewed nodes": (dae(inside="<node><skew>30 1 0 0 0 1 0</skew></node>"), "skewed nodes"),
    "other documents": (dae(instance='<instance_geometry url="b.dae#g"/>'), "refers to 'b.dae#g', another document"),
    "cut off": (dae()[:400], "its XML cannot be read"),
    "cameras only": (dae(instance="").replace(TWO, ""), "no triangles"),
}

SKIN = """<library_controllers><controller id="k"><skin source="#g"><bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</bind_shape_matrix>
<source id="j"><Name_array id="ja" count="1">bone</Name_array><technique_common><accessor source="#ja" count="1" stride="1">
<param name="JOINT" type="Name"/></accessor></technique_common></source>
<source id="b"><float_array id="ba" count="16">1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>
<accessor source="#ba" count="1" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
<source id="w"><float_array id="wa" count="1">1</float_array><technique_common><accessor source="#wa" count="1" stride="1">
<param name="WEIGHT" type="float"/></accessor></technique_common></source>
<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
<vertex_weights count="4"><input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>1 1 1 1</vcount><v>0 0 0 0 0 0 0 0</v></vertex_weights></skin></controller></library_controllers>"""

MODEL = """<?xml version="1.0"?><model unit="meter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"{names}><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="1" y="1" z="0"/>
<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3"/></triangles></mesh></object>
</resources><build>{item}</build></model>"""
RELATIONS = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" ' \
    'Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
TYPES = '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>'


def threemf(names="", item='<item objectid="1"/>', pictures=(), encoding="utf-8", zip64=False, change=str):
    data = io.BytesIO()
    model = change(MODEL.format(names=names, item=item)).encode(encoding)
    files = {"[Content_Types].xml": TYPES, "_rels/.rels": RELATIONS, "3D/3dmodel.model": model, **dict.fromkeys(pictures, b"\x89PNG no picture")}
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            with archive.open(name, "w", force_zip64=zip64) as file:
                file.write(content if isinstance(content, bytes) else content.encode())
    return data.getvalue()


def damaged(package):
    """With another byte in the compressed data of the model, which its checksum shows."""
    at = package.index(b"3D/3dmodel.model") + len("3D/3dmodel.model") + 100
    return package[:at] + bytes([package[at] ^ 1]) + package[at + 1:]


def zae():
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("manifest.xml", "<dae_root>./in/a.dae</dae_root>")
        archive.writestr("in/a.dae", SOUND["cameras of one name"][0])
    return data.getvalue()


PRODUCTION = ' xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
PACKAGES = {"plain.3mf": threemf(), "thumbnail.3mf": threemf(pictures=["Metadata/thumbnail.png", "Auxiliaries/.thumbnails/a.jpg"]),
            "zip64.3mf": threemf(zip64=True), "production.3mf": threemf(PRODUCTION + ' requiredextensions="p"', '<item objectid="1" p:UUID="1"/>'), "utf16.3mf": threemf(encoding="utf-16"), "manifest.zae": zae(),
            "utf16le.dae": dae().replace("utf-8", "utf-16").encode("utf-16"), "utf16be.dae": b"\xfe\xff" + dae().replace("utf-8", "utf-16").encode("utf-16-be")}
SLICES = ' xmlns:s="http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"'
BAD_PACKAGES = {"parts elsewhere": (threemf(PRODUCTION, '<item objectid="1" p:path="/3D/b.model"/>'), "production extension"),
                "required": (threemf(SLICES + ' requiredextensions="s"'), "requires the extension"),
                "too many items": (threemf(item=20001 * '<item objectid="1"/>'), "'build' places more than 20000 objects"),
                "damaged": (damaged(threemf()), "its archive is damaged: '3D/3dmodel.model'")}

UNREAD = {  # file name, first bytes, the name in the message
    "a.wrl": (b"#VRML V2.0 utf8\n", "VRML"), "a.obj": (b"#VRML V1.0 ascii\n", "VRML"), "b.wrl": (b"Separator {}", "VRML"),
    "a.x3d": (b"<?xml version='1.0'?><X3D/>", "X3D"), "b.xml": (b"<?xml version='1.0'?>\n<X3D profile='Full'>", "X3D"),
    "a.x3dv": (b"#X3D V3.3 utf8\n", "X3D (classic encoding)"), "a.step": (b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));", "STEP"),
    "a.stp": (b"ISO-10303-21;", "STEP"), "a.igs": (b" " * 72 + b"S      1\n", "IGES"), "a.iges": (b"x", "IGES"), "a.usda": (b"#usda 1.0\n", "USD (text)"),
    "a.usd": (b"PXR-USDC\0", "USD (binary)"), "a.usdz": (b"PK\3\4" + bytes(22) + b"\5\0\0\0a.usd", "USD"), "a.blend": (b"BLENDER-v300", "Blender"),
    "a.3dm": (b"3D Geometry File Format ", "Rhino"), "a.las": (b"LASF", "LAS"), "a.pcd": (b"# .PCD v0.7", "PCD"), "a.urdf": (b"<robot/>", "URDF"),
    "a.stl": (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"), "a.ply": (b"<!DOCTYPE html>", "HTML"), "a.zip": (b"PK\3\4", "ZIP"),
    "a.vtk": (b"# vtk DataFile Version 3.0", "VTK"), "a.sldprt": (b"\xd0\xcf\x11\xe0", "SolidWorks"), "a.dwg": (b"AC1032", "AutoCAD drawing"),
}


class DecoratedModels(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def info(self, name, data):
        path = self.folder / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        done = subprocess.run(["glidar", "info", str(path), "--json", "--no-cache"], capture_output=True, text=True)
        return json.loads(done.stdout) if done.returncode == 0 else done.stderr

    def expect_square(self, report, size=1.0, corner=(0, 0, 0)):
        self.assertIsInstance(report, dict, report)
        self.assertEqual(report["triangles"], 2)
        np.testing.assert_allclose(report["min_m"], corner, atol=1e-6)
        np.testing.assert_allclose(report["size_m"], [size, size, 0], atol=1e-6)
        self.assertAlmostEqual(report["check"]["area_m2"], size * size, 5)

    def test_sound_shapes_are_read(self):
        for name, (document, note) in SOUND.items():
            with self.subTest(name):
                report = self.info("a.dae", document)
                self.expect_square(report)
                self.assertEqual([one for one in report["notes"] if note not in one], [])
                self.assertEqual(bool(note), bool(report["notes"]), report["notes"])

    def test_what_would_be_wrong_is_refused(self):
        for name, (document, message) in REFUSED.items():
            with self.subTest(name):
                self.assertIn(message, str(self.info("a.dae", document)))

    def test_packages_and_encodings_are_read(self):
        for name, data in PACKAGES.items():
            with self.subTest(name):
                self.expect_square(self.info(name, data))

    def test_triangles_of_3mf_have_their_own_materials(self):
        paints = '<basematerials id="7"><base name="red" displaycolor="#FF0000"/><base name="blue" displaycolor="#0000FF"/></basematerials><object'
        package = threemf(change=lambda text: text.replace("<object", paints, 1).replace('v3="2"', 'v3="2" pid="7" p1="0"')
                          .replace('v3="3"', 'v3="3" pid="7" p1="1"'))
        report = self.info("a.3mf", package)
        self.expect_square(report)
        self.assertEqual([(one["name"][-4:], one["triangles"]) for one in report["materials"]], [("_red", 1), ("blue", 1)])

    def test_packages_with_parts_elsewhere_are_refused(self):
        for name, (data, message) in BAD_PACKAGES.items():
            with self.subTest(name):
                text = self.info("a.3mf", data)
                self.assertIn(message, str(text))
                self.assertNotIn("crashed", str(text))

    def test_a_collada_skin_is_in_its_initial_pose(self):
        # Bind shape 2, inverse bind + (1, 0, 0), joint at (0, 5, 0); the node of the controller has no effect.
        document = dae(controller=SKIN, inside='<node id="bone" sid="bone" type="JOINT"><translate>0 5 0</translate></node>',
                       instance='<translate>100 0 0</translate><instance_controller url="#k"><skeleton>#bone</skeleton></instance_controller>')
        self.expect_square(self.info("a.dae", document), 2.0, (1, 5, 0))

    def test_formats_that_are_not_read_are_named_with_a_remedy(self):
        for name, (data, format_name) in UNREAD.items():
            with self.subTest(name, format=format_name):
                text = str(self.info(name, data))
                self.assertIn(f"GLIDAR does not read {format_name}; ", text)
                self.assertNotIn("damaged", text)


if __name__ == "__main__":
    unittest.main()
