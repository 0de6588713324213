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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from skipping import importing

with importing():
    import numpy as np

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


# Name, NumPy type and offset in a packed point, as the drivers that docs/files/layouts.md names publish them.
LAYOUTS = {
    "minimal": "x <f4 0, y <f4 4, z <f4 8",
    "velodyne": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, ring <u2 16, time <f4 18",
    "ouster": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, t <u4 16, reflectivity <u2 20, ring <u2 22, ambient <u2 24, "
    "range <u4 26",
    "ouster-2022": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, t <u4 16, reflectivity <u2 20, ring |u1 22, noise <u2 23, "
    "range <u4 25",
    "livox-custom": "offset_time <u4 0, x <f4 4, y <f4 8, z <f4 12, reflectivity |u1 16, tag |u1 17, line |u1 18",
    "robosense": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, ring <u2 16, timestamp <f8 18",
    "hesai": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, ring <u2 16, timestamp <f8 18",
    "livox": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, tag |u1 16, line |u1 17, timestamp <f8 18",
    "autoware": "x <f4 0, y <f4 4, z <f4 8, intensity |u1 12, return_type |u1 13, channel <u2 14, azimuth <f4 16, "
    "elevation <f4 20, distance <f4 24, time_stamp <u4 28",
    "ouster-fast-lio": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, t <u4 16, reflectivity <u2 20, ring |u1 22, "
    "ambient <u2 23, range <u4 25",
    "ouster-rgb": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12, t <u4 16, reflectivity <u2 20, ring <u2 22, ambient <u2 24, "
    "range <u4 26, rgb <u4 30",
    "robosense-xyzi": "x <f4 0, y <f4 4, z <f4 8, intensity <f4 12",
}


def reflectivity_byte(intensity, white):
    """Linear to `white` at 1, then logarithmic to 255 at 1000."""
    r = np.maximum(intensity.astype(np.float64), 1e-30)
    above = white + 1 + np.floor((254 - white) * np.log(r) / np.log(1000.0) + 0.5)
    return np.where(r > 1, np.minimum(255, above), np.floor(white * r + 0.5))


def scan_columns(name):
    """What layouts are made of besides."""
    rows, cols = SIZES[name]
    i = np.arange(rows * cols)
    return {
        "azimuth": -3.0 + 0.25 * (i % 24),
        "elevation": -0.25 + 0.0125 * (i % 24),
        "range": np.where(i % 3 == 2, np.nan, 1.0 + i * 0.001234),
        "time": (i * 55296).astype(np.uint32),
        "stamp": 1700000000123456789 + i.astype(np.int64) * 55296,
    }


def layout_values(c):
    """Every layout's fields after x y z as numbers; their types are in LAYOUTS."""
    percent = reflectivity_byte(c["intensity"], 100)
    zero = np.zeros(len(percent))
    turn = np.where(c["azimuth"] < 0, c["azimuth"] + 2 * np.pi, c["azimuth"])
    red, green, blue = np.floor(255 * np.clip(c["colour"].astype(np.float64), 0, 1) + 0.5).T
    return {
        "minimal": {},
        "velodyne": {"intensity": percent, "ring": c["ring"], "time": c["time"] * 1e-9},
        "ouster": {"intensity": c["intensity"], "t": c["time"], "reflectivity": percent,
                   "ring": c["ring"], "ambient": zero, "range": np.floor(np.nan_to_num(c["range"]) / 0.001 + 0.5)},
        "livox": {"intensity": reflectivity_byte(c["intensity"], 150), "tag": zero,
                  "line": np.minimum(c["ring"], 255), "timestamp": c["stamp"].astype(np.float64)},
        "ouster-2022": {"intensity": c["intensity"], "t": c["time"], "reflectivity": percent,
                        "ring": np.minimum(c["ring"], 255), "noise": zero,
                        "range": np.floor(np.nan_to_num(c["range"]) / 0.001 + 0.5)},
        "livox-custom": {"offset_time": c["time"], "reflectivity": reflectivity_byte(c["intensity"], 150), "tag": zero,
                         "line": np.minimum(c["ring"], 255)},
        "robosense": {"intensity": percent, "ring": c["ring"], "timestamp": c["stamp"].astype(np.float64) * 1e-9},
        "hesai": {"intensity": np.minimum(255, np.floor(100 * c["intensity"].astype(np.float64) + 0.5)), "ring": c["ring"],
                  "timestamp": c["stamp"].astype(np.float64) * 1e-9},
        "autoware": {"intensity": percent, "return_type": c["status"] == 0, "channel": c["ring"],
                     "azimuth": turn, "elevation": c["elevation"], "distance": c["range"], "time_stamp": c["time"]},
        "ouster-fast-lio": {"intensity": c["intensity"], "t": c["time"], "reflectivity": percent,
                            "ring": np.minimum(c["ring"], 255), "ambient": zero,
                            "range": np.floor(np.nan_to_num(c["range"]) / 0.001 + 0.5)},
        "ouster-rgb": {"intensity": c["intensity"], "t": c["time"], "reflectivity": percent,
                       "ring": c["ring"], "ambient": zero, "range": np.floor(np.nan_to_num(c["range"]) / 0.001 + 0.5),
                       "rgb": 65536 * red + 256 * green + blue},
        "robosense-xyzi": {"intensity": percent},
    }  # fmt: skip


def dense(columns):
    keep = ~np.isnan(columns["xyz"][:, 0])
    return {name: values[keep] for name, values in columns.items()}


def colour_bytes(columns):
    full = np.clip(columns["colour"], 0, 1) * np.float32(255)
    return np.floor(full + np.float32(0.5)).astype(np.uint32)



def sidecar_of(path):
    return path.with_name(path.name.partition(".")[0] + ".glidar.json")


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

    def layout_files(self, layout):
        """(path, wanted structured array) of every file in a layout."""
        dtype = np.dtype([(n, t) for n, t, _ in (f.split() for f in LAYOUTS[layout].split(", "))])
        for folder in SIZES:
            for ending in (".pcd", ".ply", ".npz", ".csv", "_ascii.pcd", "_compressed.pcd",
                           "_ascii.ply", "_dense.pcd", "_dense.npz"):  # fmt: skip
                columns = {**expected(folder), **scan_columns(folder)}
                columns = dense(columns) if "dense" in ending else columns
                wanted = np.empty(len(columns["time"]), dtype)
                for n, name in enumerate("xyz"):
                    wanted[name] = columns["xyz"][:, n]
                for name, values in layout_values(columns)[layout].items():
                    wanted[name] = values
                yield FOLDER / folder / (layout + ending), wanted

    def read_points(self, path, dtype):
        if path.suffix == ".pcd":
            return formats.read_pcd(path)[1]
        if path.suffix == ".ply":
            return formats.read_ply(path)[1]
        if path.suffix == ".csv":
            head, *lines = path.read_text("ascii").splitlines()
            self.assertEqual(head.split(","), list(dtype.names))
            return formats.text_table(lines, dtype, ",")
        points = None
        with np.load(path, allow_pickle=False) as arrays:
            for name in arrays.files[: len(dtype)]:
                points = np.empty(arrays[name].size, dtype) if points is None else points
                self.assertEqual(arrays[name].dtype, dtype[name], name)
                points[name] = arrays[name].reshape(-1)
        return points

    def test_layouts_have_the_drivers_fields(self):
        for layout, fields in LAYOUTS.items():
            for path, wanted in self.layout_files(layout):
                points = self.read_points(path, wanted.dtype)
                found = [f"{n} {t.str} {at}" for n, (t, at) in
                         ((n, points.dtype.fields[n][:2]) for n in points.dtype.names)]  # fmt: skip
                self.assertEqual(", ".join(found), fields, path)
                for name in wanted.dtype.names:
                    self.same(points[name], wanted[name], f"{path}: {name}")
                self.assertEqual(
                    [n for _, _, names in self.told_columns(path) for n in names],
                    list(wanted.dtype.names))  # fmt: skip

    def test_stamps_are_exact_and_split_in_ply(self):
        for folder in SIZES:
            wanted = scan_columns(folder)["stamp"]
            for ending in (".pcd", "_ascii.pcd", "_compressed.pcd"):
                _, points = formats.read_pcd(FOLDER / folder / ("scan" + ending))
                self.same(points["stamp"], wanted, ending)
            with np.load(FOLDER / folder / "scan.npz", allow_pickle=False) as arrays:
                self.same(arrays["stamp"].reshape(-1), wanted, "npz")
            lines = (FOLDER / folder / "scan.csv").read_text("ascii").splitlines()
            place = lines[0].split(",").index("stamp")
            self.assertEqual([int(line.split(",")[place]) for line in lines[1:]], wanted.tolist())
            for ending in (".ply", "_ascii.ply"):
                _, points = formats.read_ply(FOLDER / folder / ("scan" + ending))
                seconds, rest = np.divmod(wanted, 10**9)
                self.same(points["stamp_sec"], seconds.astype(np.uint32), ending)
                self.same(points["stamp_nsec"], rest.astype(np.uint32), ending)

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
            shares = np.clip(columns["intensity"], 0, 1)  # the fixture's sensor has the paper's light
            wanted = np.column_stack([columns["xyz"], shares]).astype(np.float32)
            self.same(np.fromfile(path, "<f4").reshape(-1, 4), wanted, path)

    def test_depth_npy(self):
        for path, columns, rows, cols in self.each("a.npy"):
            image = np.load(path, allow_pickle=False)
            self.same(image, columns["depth"].astype(np.float32).reshape(rows, cols), path)

    def test_range_images(self):
        for folder, (rows, cols) in SIZES.items():
            i = np.arange(rows * cols)
            ranges = np.where(i % 3 == 2, np.nan, 1.0 + i).reshape(rows, cols)
            self.same(np.load(FOLDER / folder / "a.range.npy", allow_pickle=False), ranges.astype(np.float32), folder)
            image, texts = formats.read_png(FOLDER / folder / "a.range.png")
            np.testing.assert_array_equal(image[:, :, 0], np.nan_to_num(ranges))
            self.assertTrue(texts["Description"].startswith("range, 1 units per metre"), texts)

    def test_depth_png(self):
        for folder in ("small", "one", "none"):
            rows, cols = SIZES[folder]
            image, texts = formats.read_png(FOLDER / folder / "a.depth.png")
            depth = expected(folder)["depth"]
            wanted = np.where(np.isnan(depth), 0, np.floor(np.nan_to_num(depth) * 1000 + 0.5))
            np.testing.assert_array_equal(image[:, :, 0], wanted.reshape(rows, cols))
            self.assertEqual(image.dtype, np.dtype(">u2"))
            self.assertIn("1000 units per metre", texts["Description"])

    def test_paper_png(self):
        for folder, (rows, cols) in SIZES.items():
            image, texts = formats.read_png(FOLDER / folder / "a.framebuffer.png")
            wanted = (np.arange(4 * rows * cols) * 37 % 256).astype(np.uint8)
            np.testing.assert_array_equal(image, wanted.reshape(rows, cols, 4))
            self.assertTrue(texts["Description"].endswith("n = 1.25 m, f = 3.1000000000000001 m"), texts)

    def test_preview(self):
        image, _ = formats.read_png(FOLDER / "small" / "a.png")
        zoom, gap = 512 // 5, 15  # letters of 12 + 510 / 128 pixels
        panel = image[gap + zoom // 2 :: zoom, gap + zoom // 2 :: zoom][:4, :5].astype(int)
        light = panel.sum(2).reshape(-1)
        miss = np.arange(20) % 3 == 2
        self.assertTrue((light[miss] < 150).all(), light)
        self.assertTrue((np.diff(light[~miss]) < 0).all(), light)  # near is bright
        self.assertTrue(panel.reshape(-1, 3)[0].tolist() == [253, 231, 37])
        grey = image[gap + zoom // 2 :: zoom, 5 * zoom + 2 * gap + zoom // 2 :: zoom][:4, :5]
        grey = grey.reshape(-1, 3).astype(int)[~miss]
        np.testing.assert_array_equal(grey[:, 0], grey[:, 2])
        self.assertEqual((grey[0, 0], grey[-1, 0]), (0, 255))

    def test_sidecar(self):
        for path, _, rows, cols in self.each("a.pcd", "dense1.ply", "a.bin"):
            reported = json.loads(sidecar_of(path).read_text("utf-8"))
            (file,) = (one for one in reported["files"] if one["file"] == path.name)
            self.assertEqual((file["rows"], file["cols"]), (rows, cols))

    def told_columns(self, path):
        """The sidecar's (name, type, components)."""
        reported = json.loads(sidecar_of(path).read_text("utf-8"))
        (file,) = (one for one in reported["files"] if one["file"] == path.name)
        return [(c["name"], c["type"], c["components"]) for c in file["columns"]]

    def test_sidecars_name_every_field_of_the_file_with_its_type(self):
        types = {"f4": "f32", "f8": "f64", "u1": "u8", "u2": "u16", "u4": "u32", "i8": "i64"}
        for path, *_ in self.each("a.pcd", "ascii.pcd", "compressed.pcd", "dense0.pcd", "a.ply",
                                  "ascii.ply", "dense1.ply", "scan.pcd", "scan_ascii.pcd",
                                  "scan.ply"):  # fmt: skip
            _, points = formats.read_pcd(path) if path.suffix == ".pcd" else formats.read_ply(path)
            found = [(n, types[points.dtype[n].str[1:]]) for n in points.dtype.names]
            # PCD has no type of its own for colour: float in binary files, integer in text
            found = [(n, "packed_rgb" if n == "rgb" else t) for n, t in found]
            reported = [(n, t) for _, t, names in self.told_columns(path) for n in names]
            self.assertEqual(reported, found, path)

    def test_sidecars_of_csv_npz_and_kitti_tell_what_is_there(self):
        sizes = {"f32": 4, "f64": 8, "u8": 1, "u16": 2, "u32": 4}
        for path, *_ in self.each("a.csv"):
            reported = [n for _, _, names in self.told_columns(path) for n in names]
            self.assertEqual(reported, path.read_text("ascii").splitlines()[0].split(","))
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
    with importing():
        import open3d as o3d
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
