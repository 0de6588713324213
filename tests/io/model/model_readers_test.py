# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Models as GLIDAR reads them and as NumPy parses them by hand: triangles, box and area are the same."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
DATA = os.environ.get("GLIDAR_DATA", "")
TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
         "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}


def number(word):
    """Also 1.#IND and 1.#INF, as Windows' C library writes them."""
    return float("nan") if "#" in word else float(word)


def read_obj(path):
    vertices, faces = [], []
    text = path.read_bytes()
    text = text.decode("utf-16" if text[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", errors="replace")
    for line in text.replace("\\\r\n", " ").replace("\\\n", " ").splitlines():
        words = line.split() if "1.#" in line else line.split("#")[0].split()
        if words and words[0] == "v":
            vertices.append([number(w) for w in words[1:4]])
        elif words and words[0] == "f":
            corners = [int(w.split("/")[0]) for w in words[1:]]
            faces.append([c - 1 if c > 0 else len(vertices) + c for c in corners])
    return np.array(vertices), faces


def ply_elements(path):
    """The entries of each element, by the names of their properties."""
    data = path.read_bytes()
    end = data.index(b"end_header") + len(b"end_header")
    end += 2 if data[end:end + 2] == b"\r\n" else 1
    elements, order = [], ""
    for words in (line.split() for line in data[:end].decode(errors="replace").splitlines()):
        if words and words[0] == "format":
            order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words and words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words and words[0] == "property":
            elements[-1][2].append(words[1:])
    words, at = (data[end:].split(), 0) if not order else (None, end)
    found = {}

    def value(kind):
        nonlocal at
        if words is not None:
            at += 1
            return float(words[at - 1])
        got = np.frombuffer(data, order + TYPES[kind], 1, at)[0]
        at += got.itemsize
        return got

    for name, count, properties in elements:
        rows = []
        for _ in range(count):
            row = {}
            for p in properties:
                row[p[-1]] = [value(p[2]) for _ in range(int(value(p[1])))] if p[0] == "list" else value(p[0])
            rows.append(row)
        found[name] = rows
    return found


def read_ply(path):
    found = ply_elements(path)
    vertices = np.array([[float(r[k]) for k in "xyz"] for r in found["vertex"]])
    lists = [r.get("vertex_indices", r.get("vertex_index")) for r in found.get("face", [])]
    return vertices, [[int(i) for i in corners] for corners in lists]


def read_stl(path):
    data = path.read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0]) if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        facets = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
        vertices = facets["v"].reshape(-1, 3).astype(float)
    else:
        lines = (line.split() for line in data.decode(errors="replace").lower().splitlines())
        vertices = np.array([[float(w) for w in words[1:4]] for words in lines if words and words[0] == "vertex"])
    return vertices, np.arange(len(vertices)).reshape(-1, 3).tolist()


def read_off(path):
    lines = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    lines = [line for line in lines if line]
    head = lines.pop(0)[1:] or lines.pop(0)
    count, faces = int(head[0]), int(head[1])
    vertices = np.array([[float(w) for w in line[:3]] for line in lines[:count]])
    return vertices, [[int(w) for w in line[1:1 + int(line[0])]] for line in lines[count:count + faces]]


READERS = {".obj": read_obj, ".ply": read_ply, ".stl": read_stl, ".off": read_off}
# Numbers such as 3.1+e2; a list of 7.9 values; vertices that are missing or 0
REFUSED = {"number_formats.obj", "issue623.ply", "box-incomplete-positions.obj", "invalid-relative-texture-index.obj",
           "invalid-relative-vertex-index.obj", "issue-140-zero-face-idx.obj"}
# More numbers than its header states
OTHER = {"fuze_ascii.ply"}


def model_files():
    files = sorted((ROOT / "models").rglob("*"))
    if DATA:
        files += sorted(p for folder in ("textured", "models", "scenes") for p in Path(DATA, folder).rglob("*"))
    # A limit for the loops of Python
    return [p for p in files if p.suffix.lower() in READERS and p.name not in OTHER and p.stat().st_size < 1_000_000]


def area_of(vertices, faces):
    """Of all polygons, by Newell's normal: exact for planar ones."""
    total = 0.0
    for face in faces:
        p = vertices[face] - vertices[face[0]]
        total += np.linalg.norm(np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)) / 2
    return total


class Models(unittest.TestCase):
    def check(self, path):
        run = subprocess.run(["glidar", "info", str(path), "--json", "--no-cache"], capture_output=True, text=True, check=False)
        if path.name in REFUSED:
            self.assertEqual(run.returncode, 2)
            self.assertRegex(run.stderr, r"line \d+")
            return
        vertices, faces = READERS[path.suffix.lower()](path)
        surfaces = [f for f in faces if len(f) >= 3 and np.isfinite(vertices[f]).all()]
        if not surfaces:
            self.assertIn("no triangles", run.stderr)
            return
        self.assertEqual(run.returncode, 0, run.stderr)
        info = json.loads(run.stdout)
        self.assertEqual(info["triangles"], sum(len(f) - 2 for f in surfaces))
        self.assertEqual(info["loaded"]["faces"], len(surfaces))
        if path.suffix.lower() != ".stl":  # whose vertices are merged
            self.assertEqual(info["stated"]["vertices"], len(vertices))
        used = vertices[sorted({i for f in surfaces for i in f})]
        size = (used.max(axis=0) - used.min(axis=0)).max()
        np.testing.assert_allclose(info["min_m"], used.min(axis=0), rtol=0, atol=1e-7 * size)
        np.testing.assert_allclose(info["max_m"], used.max(axis=0), rtol=0, atol=1e-7 * size)
        if all(len(f) == 3 for f in surfaces):
            self.assertAlmostEqual(info["check"]["area_m2"] / max(area_of(vertices, surfaces), 1e-30), 1.0, places=4)

    def test_are_read_as_by_an_independent_reader(self):
        files = model_files()
        self.assertGreater(len(files), 5)
        for path in files:
            with self.subTest(str(path)):
                self.check(path)

    def test_random_meshes_are_the_same_in_every_format(self):
        random = np.random.default_rng(7)
        vertices = random.uniform(-1, 1, (40, 3)) + [5e5, 5.4e6, 100]
        faces = [random.choice(40, 3, replace=False).tolist() for _ in range(60)]
        rows = "".join("%.17g %.17g %.17g\n" % tuple(v) for v in vertices)
        index = "".join("3 %d %d %d\n" % tuple(f) for f in faces)
        header = f"element vertex 40\nproperty double x\nproperty double y\nproperty double z\nelement face {len(faces)}\n"
        header += "property list uchar int vertex_indices\nend_header\n"
        facets = "".join("facet\nouter loop\n" + "".join("vertex %.17g %.17g %.17g\n" % tuple(vertices[i]) for i in f) + "endloop\nendfacet\n"
                         for f in faces)
        big = vertices.astype(">f8").tobytes() + b"".join(b"\3" + np.array(f, ">i4").tobytes() for f in faces)
        texts = {
            "a.obj": "".join(f"v {row}\n" for row in rows.splitlines()) + "".join("f %d %d %d\n" % tuple(np.add(f, 1)) for f in faces),
            "a.off": f"OFF\n40 {len(faces)} 0\n" + rows + index,
            "a.ply": "ply\nformat ascii 1.0\n" + header + rows + index,
            "b.ply": ("ply\nformat binary_big_endian 1.0\n" + header).encode() + big,
            "a.stl": "solid a\n" + facets + "endsolid a\n"}
        with tempfile.TemporaryDirectory() as folder:
            for name, text in texts.items():
                with self.subTest(name):
                    path = Path(folder, name)
                    path.write_bytes(text if isinstance(text, bytes) else text.encode())
                    self.check(path)


if __name__ == "__main__":
    unittest.main()
