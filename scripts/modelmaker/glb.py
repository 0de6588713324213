# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes one textured mesh as binary glTF 2.0."""

import json
import struct
from dataclasses import dataclass

import numpy as np

FLOAT, UNSIGNED_SHORT = 5126, 5123
VERTICES, INDICES = 34962, 34963


@dataclass
class GlbMesh:
    positions_m: np.ndarray  # (v, 3)
    normals: np.ndarray  # (v, 3)
    uvs: np.ndarray  # (v, 2), v downwards
    triangles: np.ndarray  # (t, 3), v < 65536


def padded(data, filler):
    return data + filler * (-len(data) % 4)


def document(name, mesh, sizes):
    """The JSON part; sizes are the bytes of positions, normals, uvs, indices and two images."""
    offsets = np.concatenate([[0], np.cumsum([size + -size % 4 for size in sizes])])
    views = [{"buffer": 0, "byteOffset": int(offsets[i]), "byteLength": size}
             for i, size in enumerate(sizes)]
    for view in views[:3]:
        view["target"] = VERTICES
    views[3]["target"] = INDICES
    count = len(mesh.positions_m)
    accessors = [
        {"bufferView": 0, "componentType": FLOAT, "count": count, "type": "VEC3",
         "min": mesh.positions_m.min(axis=0).tolist(),
         "max": mesh.positions_m.max(axis=0).tolist()},
        {"bufferView": 1, "componentType": FLOAT, "count": count, "type": "VEC3"},
        {"bufferView": 2, "componentType": FLOAT, "count": count, "type": "VEC2"},
        {"bufferView": 3, "componentType": UNSIGNED_SHORT, "count": int(mesh.triangles.size),
         "type": "SCALAR"},
    ]
    return {
        "asset": {"version": "2.0", "generator": "GLIDAR scripts/make_models.py",
                  "copyright": "2026 The GLIDAR developers, BSD-3-Clause"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"name": name, "primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
            "indices": 3, "material": 0}]}],
        "materials": [{"name": "regolith",
                       "pbrMetallicRoughness": {
                           "baseColorFactor": [1.0, 0.95, 0.88, 1.0],
                           "baseColorTexture": {"index": 0},
                           "metallicFactor": 0.0, "roughnessFactor": 1.0},
                       "normalTexture": {"index": 1}}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 0}],
        "samplers": [{"wrapS": 33071, "wrapT": 33071}],  # clamp to edge
        "images": [{"name": "albedo", "mimeType": "image/png", "bufferView": 4},
                   {"name": "normals", "mimeType": "image/png", "bufferView": 5}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": int(offsets[-1])}],
    }


def write_glb(path, mesh, albedo_png, normal_png):
    blocks = [mesh.positions_m.astype("<f4").tobytes(), mesh.normals.astype("<f4").tobytes(),
              mesh.uvs.astype("<f4").tobytes(), mesh.triangles.astype("<u2").tobytes(),
              albedo_png, normal_png]
    binary = b"".join(padded(block, b"\0") for block in blocks)
    text = json.dumps(document(path.stem, mesh, [len(b) for b in blocks]), separators=(",", ":"))
    text = padded(text.encode(), b" ")
    total = 12 + 8 + len(text) + 8 + len(binary)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, total))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
