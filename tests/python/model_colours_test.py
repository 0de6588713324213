# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Colours of models as GLIDAR measures them and as NumPy and Pillow read them: factors, textures with their coordinates,
colours of vertices and faces. Beams aim at points of random triangles."""

import io
import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import glidar

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tests/io/model")]
from gltf_files import Reader
from model_readers_test import REFUSED, number, ply_elements

Image = pytest.importorskip("PIL.Image")
FOLDERS = [ROOT / "models", *(Path(os.environ["GLIDAR_DATA"], one) for one in ("textured", "models", "scenes") if "GLIDAR_DATA" in os.environ)]
SAMPLES = 40  # triangles of each part
CLOSE = 0.012  # of colours: three steps of a byte
# What the readers below leave out, by words of the files
OTHER_GLTF = ("KHR_", "EXT_", "texCoord", "33071", "33648", '"skins"', '"targets"', "byteStride")


class Part:
    """Triangles of one material: corners (n, 3, 3), coordinates (n, 3, 2; v up), colours (n, 3, 3)."""

    def __init__(self, corners, uvs=None, colours=None, factor=(1, 1, 1), image=None):
        self.corners = np.asarray(corners, float).reshape(-1, 3, 3)
        self.uvs = uvs if uvs is None else np.asarray(uvs, float).reshape(-1, 3, 2)
        self.colours = colours if colours is None else np.asarray(colours, float).reshape(-1, 3, 3)
        self.factor, self.image = np.asarray(factor, float), image

    def limits(self, chosen, weights):
        """The least and the largest colour of the 3 x 3 texels around points of triangles."""
        colour = np.tile(self.factor, (len(chosen), 1))
        if self.colours is not None:
            colour *= np.einsum("nk,nkc->nc", weights, self.colours[chosen])
        if self.image is None or self.uvs is None:
            return colour, colour
        pixels = np.asarray(Image.open(io.BytesIO(self.image)).convert("RGB"), float) / 255
        uv, (height, width) = np.einsum("nk,nkc->nc", weights, self.uvs[chosen]), pixels.shape[:2]
        column, row = np.floor(uv[:, 0] * width).astype(int), np.floor((1 - uv[:, 1]) * height).astype(int)
        near = [pixels[(row + dy) % height, (column + dx) % width] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
        return colour * np.min(near, axis=0), colour * np.max(near, axis=0)


def read_mtl(path):
    """Materials by name: their Kd and the texture without options, None if it has some."""
    found, current = {}, None
    for line in path.read_text(errors="replace").splitlines():
        word, _, rest = line.strip().replace("\t", " ").partition(" ")
        if word == "newmtl":
            current = found.setdefault(rest.strip(), {"kd": (1, 1, 1), "map": "", "folder": path.parent})
        elif current is None:
            continue
        elif word == "Kd" and len(rest.split()) == 3:
            current["kd"] = [float(w) for w in rest.split()]
        elif word.lower() == "map_kd":
            current["map"] = None if rest.strip().startswith("-") else rest.strip()
    return found


def obj_parts(path):
    vertices, colours, uvs, faces, materials, material = [], [], [], {}, {}, None
    for line in path.read_text(errors="replace").replace("\\\n", " ").splitlines():
        word, _, rest = line.split("#")[0].strip().partition(" ")
        words = rest.split()
        if word == "v":
            vertices.append([number(w) for w in words[:3]])
            colours.append([number(w) for w in words[3:6]] if len(words) > 5 else [1, 1, 1])
        elif word == "vt":
            uvs.append([number(w) for w in (words + ["0"])[:2]])
        elif word == "usemtl":
            material = rest.strip()
        elif word == "mtllib" and (path.parent / rest.strip()).is_file():
            materials.update(read_mtl(path.parent / rest.strip()))
        elif word == "f" and len(words) == 3:
            counts = (len(vertices), len(uvs))
            face = [[int(i) - 1 if int(i) > 0 else n + int(i) for i, n in zip(w.split("/"), counts) if i] for w in words]
            faces.setdefault((material, all(len(corner) == 2 for corner in face)), []).append(face)
    for (name, has_uvs), some in faces.items():
        if name is not None and name not in materials:
            continue  # in a file with another name
        known = materials.get(name, {"kd": (1, 1, 1), "map": ""})
        image = known["map"] and known["folder"] / known["map"]
        if known["map"] is None or (image and has_uvs and not image.is_file()):
            continue  # has options, or is searched elsewhere
        index = np.array([[corner[0] for corner in face] for face in some])
        used = np.array(uvs)[[[corner[1] for corner in face] for face in some]] if has_uvs else None
        yield Part(np.array(vertices)[index], used, np.array(colours)[index], known["kd"], image.read_bytes() if image and has_uvs else None)


def ply_parts(path):
    found = ply_elements(path)
    rows, faces = found["vertex"], [f for f in found.get("face", []) if len(f.get("vertex_indices", f.get("vertex_index", []))) == 3]
    index = np.array([f.get("vertex_indices", f.get("vertex_index")) for f in faces], int).reshape(-1, 3)
    rgb = ("red", "green", "blue")
    of_vertices = np.array([[r[k] for k in rgb] for r in rows], float) if "red" in rows[0] else None
    of_faces = np.array([[f[k] for k in rgb] for f in faces], float) if faces and "red" in faces[0] else None
    uvs, image, named = None, None, re.search(rb"comment TextureFile (.*)", path.read_bytes()[:2000])
    if named:
        uvs = [f["texcoord"] for f in faces] if "texcoord" in faces[0] else np.array([[r["s"], r["t"]] for r in rows], float)[index]
        image = (path.parent / named[1].decode().strip()).read_bytes()
    colours = of_vertices[index] if of_vertices is not None else None if of_faces is None else np.repeat(of_faces[:, None], 3, axis=1)
    if colours is not None and max(c.max() for c in (of_vertices, of_faces) if c is not None) > 1:
        colours = colours / 255
    yield Part(np.array([[r[k] for k in "xyz"] for r in rows], float)[index], uvs, colours, image=image)


def gltf_parts(path):
    reader = Reader(path)
    nodes = reader.json.get("nodes", [])
    scenes = reader.json.get("scenes")
    shown = [(i, np.eye(4)) for i in scenes[reader.json.get("scene", 0)].get("nodes", [])] if scenes else []
    while shown:
        index, parent = shown.pop()
        matrix = parent @ reader.matrix(nodes[index])
        shown += [(child, matrix) for child in nodes[index].get("children", [])]
        for primitive in reader.json["meshes"][nodes[index]["mesh"]]["primitives"] if "mesh" in nodes[index] else []:
            if primitive.get("mode", 4) == 4 and "POSITION" in primitive["attributes"]:
                yield gltf_part(reader, primitive, matrix)


def gltf_part(reader, primitive, matrix):
    attributes, json = primitive["attributes"], reader.json
    points = reader.accessor(attributes["POSITION"]) @ matrix[:3, :3].T + matrix[:3, 3]
    order = reader.accessor(primitive["indices"])[:, 0].astype(int) if "indices" in primitive else np.arange(len(points))
    order = order[:len(order) // 3 * 3]
    material = json["materials"][primitive["material"]] if "material" in primitive else {}
    surface = material.get("pbrMetallicRoughness", {})
    image = uvs = None
    if "baseColorTexture" in surface and "TEXCOORD_0" in attributes:
        source = json["images"][json["textures"][surface["baseColorTexture"]["index"]]["source"]]
        view = json["bufferViews"][source["bufferView"]] if "bufferView" in source else None
        image = reader.bytes_of(source["uri"]) if view is None else reader.buffer(view["buffer"])[view.get("byteOffset", 0):][:view["byteLength"]]
        uvs = reader.accessor(attributes["TEXCOORD_0"])[order] * [1, -1] + [0, 1]
    colours = reader.accessor(attributes["COLOR_0"])[order, :3] if "COLOR_0" in attributes else None
    return Part(points[order], uvs, colours, surface.get("baseColorFactor", [1, 1, 1])[:3], image)


READERS = {".obj": obj_parts, ".ply": ply_parts, ".gltf": gltf_parts, ".glb": gltf_parts}


def model_files():
    files = sorted(p for folder in FOLDERS for p in folder.rglob("*") if p.suffix.lower() in READERS and p.stat().st_size < 1_000_000)
    is_other = lambda p: p.suffix.lower() in (".gltf", ".glb") and any(word.encode() in p.read_bytes() for word in OTHER_GLTF)
    return [p for p in files if p.name not in REFUSED and not is_other(p)]


def is_covered(point, corners, size):
    """Whether a point is in several triangles."""
    first, second, offset = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], point - corners[:, 0]
    normal = np.cross(first, second)
    squared = np.maximum((normal * normal).sum(axis=1), 1e-300)
    u, v = ((normal * np.cross(*pair)).sum(axis=1) / squared for pair in ((offset, second), (first, offset)))
    is_near = np.abs((offset * normal).sum(axis=1)) < 1e-5 * size * np.sqrt(squared)
    return (is_near & (u > -1e-9) & (v > -1e-9) & (u + v < 1 + 1e-9)).sum() > 1


def measured(path, parts, random):
    """The number of beams that hit the point at which they aim, and those of another colour, as text."""
    size = np.ptp(np.concatenate([part.corners.reshape(-1, 3) for part in parts]), axis=0).max()
    starts, directions, lows, highs = [], [], [], []
    for part in parts:
        normals = np.cross(part.corners[:, 1] - part.corners[:, 0], part.corners[:, 2] - part.corners[:, 0])
        areas = np.linalg.norm(normals, axis=1)
        large = np.flatnonzero(areas > 1e-9 * size * size)
        chosen = random.choice(large, min(SAMPLES, len(large)), replace=False)
        weights = random.dirichlet([2, 2, 2], len(chosen))
        normal = normals[chosen] / areas[chosen, None]
        starts.append(np.einsum("nk,nkc->nc", weights, part.corners[chosen]) + 1e-4 * size * normal)
        directions.append(-normal)
        low, high = part.limits(chosen, weights)
        lows.append(low)
        highs.append(high)
    beams = {"type": "table", "directions": [np.concatenate(directions)], "origins_m": [np.concatenate(starts)]}
    simulator = glidar.Simulator(glidar.Scene(path, unit=1.0, up="z"), glidar.Sensor.from_dict({"optics": beams}), threads=1)
    frame = simulator.simulate(np.eye(4), columns="all").ground_truth
    hits = np.abs(frame.range_m.ravel() - 1e-4 * size) < 1e-6 * size  # the others aim at a surface that another one covers
    colour, low, high = frame.colour.reshape(-1, 3)[hits], np.concatenate(lows)[hits], np.concatenate(highs)[hits]
    wrong = ((colour < low - CLOSE) | (colour > high + CLOSE)).any(axis=1)
    corners, points = np.concatenate([part.corners for part in parts]), (np.concatenate(starts) + 1e-4 * size * np.concatenate(directions))[hits]
    wrong[wrong] = [not is_covered(point, corners, size) for point in points[wrong]]
    return hits.sum(), [f"{c} for {a} to {b}" for c, a, b in zip(colour[wrong], low[wrong], high[wrong])]


def test_colours_are_those_of_independent_readers():
    models = beams = 0
    failed = {}
    for path in model_files():
        parts = [part for part in READERS[path.suffix.lower()](path) if len(part.corners) and np.isfinite(part.corners).all()]
        if not parts:
            continue
        hits, wrong = measured(path, parts, np.random.default_rng(3))
        models, beams = models + 1, beams + hits
        if wrong:
            failed[str(path)] = wrong[:3]
    print(models, "models,", beams, "beams")
    assert not failed, "\n".join(f"{k}: {v}" for k, v in failed.items())
    assert beams > 40
