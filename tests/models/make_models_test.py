# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Promises of the models/ folder. Exits with 77 (skipped) where numpy or Pillow is missing."""

import io
import json
import struct
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from skipping import importing

with importing():
    import numpy as np
    from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / "models"
ASTEROID = MODELS / "asteroid" / "asteroid.glb"
SATELLITE = MODELS / "satellite" / "satellite.obj"
OPEN_PARTS = {"helix_reflector"}


def pixels(data):
    return np.asarray(Image.open(io.BytesIO(data)))


def glb_blocks(data):
    """The JSON document and the bytes of each buffer view."""
    magic, version, total, length, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, total, kind) == (b"glTF", 2, len(data), b"JSON")
    document = json.loads(data[20 : 20 + length])
    start = 28 + length
    return document, [data[start + v["byteOffset"] : start + v["byteOffset"] + v["byteLength"]]
                      for v in document["bufferViews"]]


def read_asteroid():
    """Positions, normals, uvs, triangles."""
    _, blocks = glb_blocks(ASTEROID.read_bytes())
    floats = [np.frombuffer(block, "<f4").astype(np.float64) for block in blocks[:3]]
    return (floats[0].reshape(-1, 3), floats[1].reshape(-1, 3), floats[2].reshape(-1, 2),
            np.frombuffer(blocks[3], "<u2").astype(int).reshape(-1, 3))


def read_satellite():
    """{"v": positions, "vt": uvs, "vn": normals} and {part: triangles of (v, vt, vn) indices}."""
    values, parts, used = {"v": [], "vt": [], "vn": []}, {}, set()
    for line in SATELLITE.read_text(encoding="ascii").splitlines():
        key, *words = line.split()
        if key in values:
            values[key].append([float(word) for word in words])
        elif key == "o":
            faces = parts.setdefault(words[0], [])
        elif key == "usemtl":
            used.add(words[0])
        elif key == "f":
            faces.append([[int(i) - 1 for i in word.split("/")] for word in words])
    return ({k: np.array(v) for k, v in values.items()},
            {k: np.array(v) for k, v in parts.items()}, used)


def read_materials():
    """{material: {statement: text}}"""
    materials = {}
    for line in SATELLITE.with_suffix(".mtl").read_text(encoding="ascii").splitlines():
        key, _, text = line.partition(" ")
        if key == "newmtl":
            current = materials.setdefault(text, {})
        elif key and key != "#":
            current[key] = text
    return materials


def open_edges(corners):
    """Edges of triangles (t, 3 of points or of point keys) without exactly one opposite partner."""
    edges = Counter()
    for a, b, c in corners:
        edges.update(((a, b), (b, c), (c, a)))
    return [edge for edge, count in edges.items() if count != 1 or edges[edge[::-1]] != 1]


def double_areas(points):
    """Cross products of triangles (t, 3, 3)."""
    return np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])


def signed_volume(points):
    return np.sum(points[:, 0] * np.cross(points[:, 1], points[:, 2])) / 6.0


class Script(unittest.TestCase):
    def test_makes_the_kept_files_again(self):
        # Pictures are compared by pixel: their compression depends on Pillow's zlib.
        with tempfile.TemporaryDirectory() as folder:
            script = ROOT / "scripts" / "make_models.py"
            subprocess.run([sys.executable, "-B", script, "--out", folder], check=True)
            made = {p.relative_to(folder): p for p in Path(folder).rglob("*") if p.is_file()}
            kept = {p.relative_to(MODELS) for p in MODELS.rglob("*") if p.is_file()}
            self.assertEqual(set(made) | {Path("README.md")}, kept)
            for name, path in made.items():
                with self.subTest(file=str(name)):
                    self.assert_same(name, path.read_bytes(), (MODELS / name).read_bytes())

    def assert_same(self, name, made, kept):
        if name.suffix == ".png":
            np.testing.assert_array_equal(pixels(made), pixels(kept))
        elif name.suffix == ".glb":
            (made_json, made_blocks), (kept_json, kept_blocks) = glb_blocks(made), glb_blocks(kept)
            for sized in ("bufferViews", "buffers"):
                made_json.pop(sized), kept_json.pop(sized)
            self.assertEqual(made_json, kept_json)
            self.assertEqual(made_blocks[:4], kept_blocks[:4])
            for a, b in zip(made_blocks[4:], kept_blocks[4:], strict=True):
                np.testing.assert_array_equal(pixels(a), pixels(b))
        else:
            self.assertEqual(made, kept)

    def test_unknown_model_is_an_error_that_names_the_known_ones(self):
        script = ROOT / "scripts" / "make_models.py"
        run = subprocess.run([sys.executable, "-B", script, "teapot"], capture_output=True,
                             text=True, check=False)
        self.assertEqual(run.returncode, 2)
        self.assertIn("no model named 'teapot'; known: asteroid, satellite", run.stderr)


class Folder(unittest.TestCase):
    def test_stays_small(self):
        size = sum(p.stat().st_size for p in MODELS.rglob("*") if p.is_file())
        self.assertLess(size, 3_000_000)


class Asteroid(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.positions, cls.normals, cls.uvs, cls.triangles = read_asteroid()
        cls.corners = cls.positions[cls.triangles]

    def test_is_closed_and_wound_outwards(self):
        self.assertEqual(open_edges([tuple(map(tuple, t)) for t in self.corners.tolist()]), [])
        self.assertGreater(signed_volume(self.corners), 0.0)

    def test_size_and_count_are_as_the_readme_says(self):
        self.assertEqual(len(self.triangles), 37_632)
        size = np.ptp(self.positions, axis=0)
        np.testing.assert_allclose(size, [337.3, 218.0, 169.6], atol=0.1)

    def test_origin_is_the_centre_of_volume(self):
        volumes = np.sum(self.corners[:, 0] * np.cross(self.corners[:, 1], self.corners[:, 2]), -1)
        centre = volumes @ self.corners.sum(axis=1) / 4.0 / volumes.sum()
        np.testing.assert_allclose(centre, 0.0, atol=1e-3)

    def test_no_degenerate_triangles(self):
        self.assertGreater(np.linalg.norm(double_areas(self.corners), axis=-1).min(), 0.5)

    def test_normals_are_unit_and_agree_with_the_winding(self):
        np.testing.assert_allclose(np.linalg.norm(self.normals, axis=-1), 1.0, atol=2e-4)
        along = np.einsum("tj,tcj->tc", double_areas(self.corners), self.normals[self.triangles])
        self.assertGreater(along.min(), 0.0)

    def test_uvs_lie_on_the_texture_and_do_not_fold(self):
        self.assertGreaterEqual(self.uvs.min(), 0.0)
        self.assertLessEqual(self.uvs.max(), 1.0)
        flat = np.pad(self.uvs * [1.0, -1.0], ((0, 0), (0, 1)))[self.triangles]
        self.assertGreater(double_areas(flat)[:, 2].min(), 0.0)

    def test_textures_are_a_grey_albedo_and_unit_normals(self):
        _, blocks = glb_blocks(ASTEROID.read_bytes())
        albedo, normals = pixels(blocks[4]), pixels(blocks[5])
        self.assertEqual(albedo.shape, (512, 768))
        self.assertEqual(normals.shape, (512, 768, 3))
        lengths = np.linalg.norm(normals / 127.5 - 1.0, axis=-1)
        np.testing.assert_allclose(lengths, 1.0, atol=0.01)


class Satellite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.values, cls.parts, cls.used = read_satellite()
        cls.materials = read_materials()

    def test_parts_are_closed_and_wound_outwards(self):
        for name, faces in self.parts.items():
            with self.subTest(part=name):
                edges = open_edges(faces[:, :, 0].tolist())
                self.assertEqual(bool(edges), name in OPEN_PARTS)
                if name not in OPEN_PARTS:
                    corners = self.values["v"][faces[:, :, 0]]
                    self.assertGreater(signed_volume(corners - corners[0, 0]), 0.0)

    def test_size_and_counts_are_as_the_readme_says(self):
        self.assertEqual(sum(len(faces) for faces in self.parts.values()), 10_032)
        self.assertEqual(len(self.materials), 11)
        np.testing.assert_allclose(np.ptp(self.values["v"], axis=0), [1.81, 6.88, 2.27], atol=0.01)

    def test_no_degenerate_triangles(self):
        for name, faces in self.parts.items():
            areas = np.linalg.norm(double_areas(self.values["v"][faces[:, :, 0]]), axis=-1)
            self.assertGreater(areas.min(), 1e-6, name)

    def test_normals_are_unit_and_agree_with_the_winding(self):
        np.testing.assert_allclose(np.linalg.norm(self.values["vn"], axis=-1), 1.0, atol=2e-4)
        for name, faces in self.parts.items():
            made = double_areas(self.values["v"][faces[:, :, 0]])
            along = np.einsum("tj,tcj->tc", made, self.values["vn"][faces[:, :, 2]])
            self.assertGreater(along.min(), 0.0, name)

    def test_uvs_repeat_a_texture_a_few_times_only(self):
        self.assertGreaterEqual(self.values["vt"].min(), 0.0)
        self.assertLessEqual(self.values["vt"].max(), 10.0)

    def test_textured_triangles_have_area_in_the_texture(self):
        for name in ("bus", "left_wing_panel_1", "right_wing_panel_3", "helix_reflector"):
            flat = np.pad(self.values["vt"], ((0, 0), (0, 1)))[self.parts[name][:, :, 1]]
            self.assertGreater(double_areas(flat)[:, 2].min(), 0.0, name)

    def test_materials_are_those_used_and_their_textures_exist(self):
        self.assertEqual(set(self.materials), self.used)
        maps = {}
        for statements in self.materials.values():
            self.assertLessEqual({"Ka", "Kd", "Ks", "Ns"}, set(statements))
            for key in statements.keys() & {"map_Kd", "map_Ks", "norm", "map_bump", "map_d"}:
                maps.setdefault(key, set()).add(statements[key])
        self.assertEqual(set(maps), {"map_Kd", "map_Ks", "norm", "map_bump", "map_d"})
        named = set().union(*maps.values())
        self.assertEqual(named, {p.name for p in SATELLITE.parent.glob("*.png")})
        for name in maps["norm"]:
            normals = pixels((SATELLITE.parent / name).read_bytes()) / 127.5 - 1.0
            np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0, atol=0.01)
        for name in maps["map_d"]:
            opacity = pixels((SATELLITE.parent / name).read_bytes())
            self.assertEqual(set(np.unique(opacity)), {0, 255})


class Street(unittest.TestCase):
    """The things of examples/street.yaml."""

    FOLDER = MODELS / "street"

    def test_stands_on_the_ground_in_metres(self):
        heights = {"house": (8, 13), "car": (1.3, 1.6), "tree": (5, 8), "lamp": (6, 7), "person": (1.6, 1.9)}
        for name, (low, high) in heights.items():
            lines = (self.FOLDER / f"{name}.obj").read_text(encoding="ascii").splitlines()
            z = [float(line.split()[3]) for line in lines if line.startswith("v ")]
            self.assertAlmostEqual(min(z), 0.0, delta=0.03, msg=name)
            self.assertTrue(low < max(z) < high, f"{name} is {max(z)} m tall")


if __name__ == "__main__":
    unittest.main()
