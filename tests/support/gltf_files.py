# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glTF files made and read by NumPy alone: what GLIDAR's reader is compared with."""

import base64
import json
import struct
from pathlib import Path
from urllib.parse import unquote_to_bytes

import numpy as np

TYPES = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
SHAPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


class Gltf:
    """A document with one buffer. `json` may be changed before it is written."""

    def __init__(self):
        self.bytes = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                     "meshes": [{"primitives": []}], "accessors": [], "bufferViews": []}

    def view(self, data, **more):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more})
        self.bytes += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind="f4", stride=0, **more):
        """Of an array of elements; `stride` bytes from one to the next."""
        values = np.asarray(values, "<" + kind)
        rows = [row.tobytes() for row in values]
        data = b"".join(row + b"\xEE" * max(0, stride - len(row)) for row in rows)
        view = self.view(data, **({"byteStride": stride} if stride else {}))
        self.json["accessors"].append({"bufferView": view, "componentType": TYPES[kind], "count": len(values),
                                       "type": SHAPES[values.shape[1:]], **more})
        return len(self.json["accessors"]) - 1

    def primitive(self, positions, indices=None, **more):
        """With float positions and 16-bit indices, or accessors of others."""
        if not isinstance(positions, int):
            positions = self.accessor(positions)
        made = {"attributes": {"POSITION": positions, **more.pop("attributes", {})}, **more}
        if indices is not None:
            made["indices"] = indices if isinstance(indices, int) else self.accessor(indices, "u2")
        self.json["meshes"][0]["primitives"].append(made)
        return made

    def write(self, path):
        """.gltf with a data URI, or .glb."""
        path, document = Path(path), json.loads(json.dumps(self.json))
        if path.suffix == ".glb":
            document.setdefault("buffers", [{"byteLength": len(self.bytes)}])
            text = json.dumps(document).encode()
            text += b" " * (-len(text) % 4)
            body = self.bytes + b"\0" * (-len(self.bytes) % 4)
            chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
            path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)
        else:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
            document.setdefault("buffers", [{"byteLength": len(self.bytes), "uri": uri}])
            path.write_text(json.dumps(document))
        return path


def plate(**more):
    """A unit square at z = 0, of two triangles."""
    made = Gltf()
    made.primitive([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [0, 1, 2, 0, 2, 3], **more)
    return made


class Reader:
    """A document as the standard defines it, by NumPy."""

    def __init__(self, path):
        self.folder, data, self.chunk = Path(path).parent, Path(path).read_bytes(), b""
        if data[:4] == b"glTF":
            size, = struct.unpack_from("<I", data, 12)
            text, rest = data[20:20 + size], data[20 + size:]
            if rest:
                size, = struct.unpack_from("<I", rest)
                self.chunk = rest[8:8 + size]
            data = text
        self.json = json.loads(data.decode("utf-8-sig"))

    def buffer(self, index):
        uri = self.json["buffers"][index].get("uri")
        return self.chunk if uri is None else self.bytes_of(uri)

    def bytes_of(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1] + "==")
        return (self.folder / unquote_to_bytes(uri).decode()).read_bytes()

    def rows(self, view, offset, count, dtype, width):
        view = self.json["bufferViews"][view]
        size = dtype.itemsize * width
        stride, start = view.get("byteStride", size), view.get("byteOffset", 0) + offset
        data = self.buffer(view["buffer"])
        return np.array([np.frombuffer(data, dtype, width, start + i * stride) for i in range(count)]).reshape(count, width)

    def accessor(self, index):
        one = self.json["accessors"][index]
        kind = next(kind for kind, number in TYPES.items() if number == one["componentType"])
        dtype, width, count = np.dtype("<" + kind), SIZES[one["type"]], one["count"]
        values = np.zeros((count, width), dtype)
        if "bufferView" in one:
            values = self.rows(one["bufferView"], one.get("byteOffset", 0), count, dtype, width)
        if "sparse" in one:
            at, to = one["sparse"]["indices"], one["sparse"]["values"]
            number = next(kind for kind, number in TYPES.items() if number == at["componentType"])
            where = self.rows(at["bufferView"], at.get("byteOffset", 0), one["sparse"]["count"], np.dtype("<" + number), 1)
            values[where[:, 0]] = self.rows(to["bufferView"], to.get("byteOffset", 0), len(where), dtype, width)
        values = values.astype(float)
        return np.maximum(values / np.iinfo(dtype).max, -1.0) if one.get("normalized") else values

    def matrix(self, node):
        if "matrix" in node:
            return np.array(node["matrix"], float).reshape(4, 4).T
        x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1])) / np.linalg.norm(node.get("rotation", [0, 0, 0, 1]))
        turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        made = np.eye(4)
        made[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]))
        made[:3, 3] = node.get("translation", [0, 0, 0])
        return made

    def triangles(self):
        """All triangles of the scene, n x 3 corners x 3, in the axes of the file."""
        nodes, everywhere = self.json.get("nodes", []), {}
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in children]

        def place(index, parent):
            everywhere[index] = parent @ self.matrix(nodes[index])
            for child in nodes[index].get("children", []):
                place(child, everywhere[index])

        for root in roots:
            place(root, np.eye(4))
        scenes = self.json.get("scenes")
        shown = list(scenes[self.json.get("scene", 0)].get("nodes", [])) if scenes else roots
        made = []
        while shown:
            index = shown.pop()
            shown += nodes[index].get("children", [])
            if "mesh" in nodes[index]:
                made += self.mesh(nodes[index], everywhere[index], everywhere)
        return np.concatenate(made) if made else np.zeros((0, 3, 3))

    def mesh(self, node, matrix, everywhere):
        mesh, parts = self.json["meshes"][node["mesh"]], []
        for primitive in mesh["primitives"]:
            mode = primitive.get("mode", 4)
            if mode < 4 or "POSITION" not in primitive["attributes"]:
                continue
            points = self.accessor(primitive["attributes"]["POSITION"])
            weights = node.get("weights", mesh.get("weights", []))
            for weight, target in zip(weights, primitive.get("targets", [])):
                if "POSITION" in target:
                    points = points + weight * self.accessor(target["POSITION"])
            if "skin" in node:
                points = self.skinned(primitive, self.json["skins"][node["skin"]], points, everywhere)
            else:
                points = points @ matrix[:3, :3].T + matrix[:3, 3]
            order = self.accessor(primitive["indices"])[:, 0].astype(int) if "indices" in primitive else np.arange(len(points))
            parts.append(points[self.corners(order, mode)])
        return parts

    def skinned(self, primitive, skin, points, everywhere):
        joints = np.array([everywhere[i] for i in skin["joints"]])
        if "inverseBindMatrices" in skin:
            joints = joints @ self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4)[:len(joints)].transpose(0, 2, 1)
        which = self.accessor(primitive["attributes"]["JOINTS_0"]).astype(int)
        weights = self.accessor(primitive["attributes"]["WEIGHTS_0"])
        blended = np.einsum("vk,vkij->vij", weights / weights.sum(1, keepdims=True), joints[which])
        return np.einsum("vij,vj->vi", blended[:, :3, :3], points) + blended[:, :3, 3]

    @staticmethod
    def corners(order, mode):
        if mode == 4:
            return order[:len(order) // 3 * 3].reshape(-1, 3)
        count = range(max(0, len(order) - 2))
        if mode == 5:
            return np.array([[order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]] for i in count]).reshape(-1, 3)
        return np.array([[order[i + 1], order[i + 2], order[0]] for i in count]).reshape(-1, 3)
