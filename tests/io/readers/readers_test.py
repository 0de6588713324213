# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads what glidar_io_files wrote with NumPy and readers of our own and compares every number.

usage: readers_test.py PROGRAM [open3d]
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not installed")
    sys.exit(SKIPPED)

import formats

FOLDER = None
SIZES = {"small": (4, 5), "large": (300, 200), "one": (1, 1), "none": (2, 2)}


def expected(name):
    """The fixture's formulas; a column per key, row by row."""
    rows, cols = SIZES[name]
    i = np.arange(rows * cols)
    miss = i % 3 == 2
    at = i.astype(np.float64)
    at20 = (i.astype(np.float32) / np.float32(20)).astype(np.float32)
    gone = np.full_like(miss, True) if name == "none" else miss
    xyz = np.stack([at * 0.125 + 1.0 / 3.0, -at / 7.0, 2.0 + at * 0.01], 1)
    colour = np.stack([at20, np.float32(1) - at20, np.full_like(at20, 0.5)], 1)
    normal = np.tile(np.array([0.6, -0.8, 0.0], np.float32), (len(i), 1))
    return {
        "xyz": np.where(gone[:, None], np.nan, xyz),
        "intensity": np.where(miss, np.float32(0), at20),
        "depth": np.where(gone, np.nan, 1.0 + at % 100 / 3.0),
        "normal": np.where(miss[:, None], np.float32(np.nan), normal),
        "colour": np.where(miss[:, None], np.float32(0), colour),
        "instance": np.where(miss, 0xFFFFFFFF, i + 7).astype(np.uint32),
        "ring": (i * 1000).astype(np.uint16),
        "status": miss.astype(np.uint8),
    }


def dense(columns):
    keep = ~np.isnan(columns["xyz"][:, 0])
    return {name: values[keep] for name, values in columns.items()}


def colour_bytes(columns):
    full = np.clip(columns["colour"], 0, 1) * np.float32(255)
    return np.floor(full + np.float32(0.5)).astype(np.uint32)


class Formats(unittest.TestCase):
    def same(self, found, wanted, text):
        found, wanted = np.asarray(found), np.asarray(wanted)
        self.assertEqual(found.dtype, wanted.dtype, text)
        np.testing.assert_array_equal(found, wanted, text)

    def each(self, *names):
        """(path, expected columns, rows, cols) of these files in every folder."""
        for folder, (rows, cols) in SIZES.items():
            for name in names:
                columns = expected(folder)
                if name.startswith("dense") or name.endswith(".bin"):
                    columns = dense(columns)
                    yield FOLDER / folder / name, columns, 1, len(columns["depth"])
                else:
                    yield FOLDER / folder / name, columns, rows, cols

    def check_points(self, points, columns, fields, path):
        for name, wanted in fields(columns).items():
            self.same(points[name], wanted, f"{path}: {name}")
        self.assertEqual(len(points.dtype.names), len(fields(columns)))

    def test_pcd(self):
        def fields(c):
            rgb = colour_bytes(c)
            out = {k: c["xyz"][:, n].astype(np.float32) for n, k in enumerate("xyz")}
            out.update({f"normal_{k}": c["normal"][:, n] for n, k in enumerate("xyz")})
            out["rgb"] = rgb[:, 0] << 16 | rgb[:, 1] << 8 | rgb[:, 2]
            out["depth"] = c["depth"].astype(np.float32)
            out.update({k: c[k] for k in ("intensity", "instance", "ring", "status")})
            return out

        names = ["a.pcd", "ascii.pcd", "compressed.pcd", "dense0.pcd", "dense1.pcd", "dense2.pcd"]
        for path, columns, rows, cols in self.each(*names):
            header, points = formats.read_pcd(path)
            self.assertEqual((header["WIDTH"], header["HEIGHT"]), ([str(cols)], [str(rows)]))
            rgb_type = header["TYPE"][header["FIELDS"].index("rgb")]
            self.assertEqual(rgb_type, "U" if header["DATA"] == ["ascii"] else "F")
            as_bits = np.dtype([(n, "<u4" if n == "rgb" else points.dtype[n]) for n in points.dtype.names])
            self.check_points(points.view(as_bits), columns, fields, path)
            viewpoint = np.array([float(w) for w in header["VIEWPOINT"]])
            np.testing.assert_allclose(viewpoint[:3], [2, -1, 4], atol=1e-15)
            self.assertAlmostEqual(np.linalg.norm(viewpoint[3:]), 1, 14)

    def test_ply(self):
        def fields(c):
            out = {k: c["xyz"][:, n].astype(np.float32) for n, k in enumerate("xyz")}
            if np.nanmax(np.abs(np.append(c["xyz"], 0))) >= 2048:
                out = {k: c["xyz"][:, n] for n, k in enumerate("xyz")}
            out.update({f"n{k}": c["normal"][:, n] for n, k in enumerate("xyz")})
            rgb = colour_bytes(c).astype(np.uint8)
            out.update({k: rgb[:, n] for n, k in enumerate(("red", "green", "blue"))})
            out.update({k: c[k] for k in ("depth", "intensity", "instance", "ring", "status")})
            return out

        for path, columns, rows, cols in self.each("a.ply", "ascii.ply", "dense0.ply", "dense1.ply"):
            info, points = formats.read_ply(path)
            self.assertEqual(info, {"num_cols": cols, "num_rows": rows} if rows > 1 else {})
            self.check_points(points, columns, fields, path)

    def test_csv(self):
        def fields(c):
            out = {k: c["xyz"][:, n] for n, k in enumerate("xyz")}
            out.update({f"normal_{k}": c["normal"][:, n] for n, k in enumerate("xyz")})
            out.update({k: c["colour"][:, n] for n, k in enumerate(("red", "green", "blue"))})
            out.update({k: c[k] for k in ("depth", "intensity", "instance", "ring", "status")})
            return out

        for path, columns, _, _ in self.each("a.csv", "dense0.csv"):
            head, *lines = path.read_text("ascii").splitlines()
            dtype = np.dtype([(n, fields(columns)[n].dtype) for n in head.split(",")])
            self.check_points(formats.text_table(lines, dtype, ","), columns, fields, path)

    def test_npz(self):
        for path, columns, rows, cols in self.each("a.npz", "dense1.npz"):
            with np.load(path, allow_pickle=False) as arrays:
                for name, wanted in columns.items():
                    self.same(arrays[name], wanted.reshape((rows, cols) + wanted.shape[1:]), name)
                poses = {"world_from_sensor", "world_from_cloud", "world_from_instance"}
                self.assertEqual(set(arrays.files), set(columns) | poses | {"stamp_ns", "seed"})
                self.same(arrays["stamp_ns"], np.int64(-1234567890123456789), "stamp")
                self.same(arrays["seed"], np.uint64(18446744073709551615), "seed")
                self.assertEqual(arrays["world_from_instance"].shape, (2, 4, 4))
                np.testing.assert_allclose(
                    arrays["world_from_instance"][0],
                    [[-1, 0, 0, 10], [0, -1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
                    atol=1e-15,
                )
                np.testing.assert_allclose(
                    arrays["world_from_sensor"],
                    [[0, -1, 0, 1], [0, 0, -1, 2], [1, 0, 0, 3], [0, 0, 0, 1]],
                    atol=1e-15,
                )

    def test_kitti(self):
        for path, columns, _, _ in self.each("a.bin"):
            wanted = np.column_stack([columns["xyz"], columns["intensity"]]).astype(np.float32)
            self.same(np.fromfile(path, "<f4").reshape(-1, 4), wanted, path)

    def test_depth_npy(self):
        for path, columns, rows, cols in self.each("a.npy"):
            image = np.load(path, allow_pickle=False)
            self.same(image, columns["depth"].astype(np.float32).reshape(rows, cols), path)

    def test_depth_png(self):
        for folder in ("small", "one", "none"):
            rows, cols = SIZES[folder]
            image, texts = formats.read_png(FOLDER / folder / "a.depth.png")
            depth = expected(folder)["depth"]
            wanted = np.where(np.isnan(depth), 0, np.floor(np.nan_to_num(depth) * 1000 + 0.5))
            np.testing.assert_array_equal(image[:, :, 0], wanted.reshape(rows, cols))
            self.assertEqual(image.dtype, np.dtype(">u2"))
            self.assertIn("1000 units per metre", texts["Description"])

    def test_preview(self):
        image, _ = formats.read_png(FOLDER / "small" / "a.png")
        zoom, gap = 512 // 5, 16
        panel = image[gap + zoom // 2 :: zoom, gap + zoom // 2 :: zoom][:4, :5].astype(int)
        light = panel.sum(2).reshape(-1)
        miss = np.arange(20) % 3 == 2
        self.assertTrue((light[miss] < 120).all(), light)
        self.assertTrue((np.diff(light[~miss]) < 0).all(), light)  # near is bright
        self.assertTrue(panel.reshape(-1, 3)[0].tolist() == [253, 231, 37])
        grey = image[gap + zoom // 2 :: zoom, 5 * zoom + 2 * gap + zoom // 2 :: zoom][:4, :5]
        grey = grey.reshape(-1, 3).astype(int)[~miss]
        np.testing.assert_array_equal(grey[:, 0], grey[:, 2])
        self.assertEqual((grey[0, 0], grey[-1, 0]), (0, 255))

    def test_sidecar(self):
        for path, _, rows, cols in self.each("a.pcd", "dense1.ply", "a.bin"):
            told = json.loads(path.with_name(path.name + ".json").read_text("utf-8"))
            self.assertEqual((told["cloud"]["rows"], told["cloud"]["cols"]), (rows, cols))
            self.assertEqual(told["cloud"]["file"], path.name)

    def told_columns(self, path):
        """The sidecar's (name, type, components)."""
        told = json.loads(path.with_name(path.name + ".json").read_text("utf-8"))
        return [(c["name"], c["type"], c["components"]) for c in told["cloud"]["columns"]]

    def test_sidecars_name_every_field_of_the_file_with_its_type(self):
        types = {"f4": "f32", "f8": "f64", "u1": "u8", "u2": "u16", "u4": "u32"}
        for path, *_ in self.each("a.pcd", "ascii.pcd", "compressed.pcd", "dense0.pcd", "a.ply",
                                  "ascii.ply", "dense1.ply"):  # fmt: skip
            _, points = formats.read_pcd(path) if path.suffix == ".pcd" else formats.read_ply(path)
            found = [(n, types[points.dtype[n].str[1:]]) for n in points.dtype.names]
            # PCD has no type of its own for colour: float in binary files, integer in text
            found = [(n, "packed_rgb" if n == "rgb" else t) for n, t in found]
            told = [(n, t) for _, t, names in self.told_columns(path) for n in names]
            self.assertEqual(told, found, path)

    def test_sidecars_of_csv_npz_and_kitti_tell_what_is_there(self):
        sizes = {"f32": 4, "f64": 8, "u8": 1, "u16": 2, "u32": 4}
        for path, *_ in self.each("a.csv"):
            told = [n for _, _, names in self.told_columns(path) for n in names]
            self.assertEqual(told, path.read_text("ascii").splitlines()[0].split(","))
        for path, *_ in self.each("a.npz", "dense1.npz"):
            with np.load(path, allow_pickle=False) as arrays:
                for name, kind, components in self.told_columns(path):
                    self.assertEqual(arrays[name].dtype.itemsize, sizes[kind], name)
                    self.assertEqual(arrays[name].dtype.kind, kind[0], name)
                    self.assertEqual(arrays[name].shape[2:], (len(components),) * (len(components) > 1))
        for path, columns, *_ in self.each("a.bin"):
            row = sum(sizes[t] * len(names) for _, t, names in self.told_columns(path))
            self.assertEqual(path.stat().st_size, row * len(columns["depth"]))


def open3d_test():
    try:
        import open3d as o3d
    except ImportError:
        print("skipped: open3d is not installed for this Python")
        sys.exit(SKIPPED)
    for folder in ("small", "large", "one"):
        everything = expected(folder)
        for name in ("a.pcd", "ascii.pcd", "compressed.pcd", "dense0.pcd", "dense1.pcd",
                     "dense2.pcd", "a.ply", "ascii.ply", "dense0.ply", "dense1.ply"):  # fmt: skip
            columns = dense(everything) if name.startswith("dense") else everything
            path = str(FOLDER / folder / name)
            cloud = o3d.io.read_point_cloud(path, remove_nan_points=False)
            xyz = columns["xyz"].astype(np.float32)
            np.testing.assert_array_equal(np.asarray(cloud.points).astype(np.float32), xyz, path)
            np.testing.assert_array_equal(
                np.asarray(cloud.normals).astype(np.float32), columns["normal"], path
            )
            colours = np.asarray(cloud.colors)
            np.testing.assert_allclose(colours * 255, colour_bytes(columns), atol=1e-4, err_msg=path)
            if folder != "one":
                tensor = o3d.t.io.read_point_cloud(path, remove_nan_points=False).point
                np.testing.assert_array_equal(
                    tensor["intensity"].numpy().reshape(-1), columns["intensity"], path
                )
            print("Open3D reads", folder, name)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        FOLDER = pathlib.Path(made)
        subprocess.run([sys.argv[1], made], check=True)
        if sys.argv[2:] == ["open3d"]:
            open3d_test()
        else:
            unittest.main(argv=sys.argv[:1], verbosity=1)
