# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The outputs in a campaign file."""

from dataclasses import dataclass

from glidar._inputs import column_list
from glidar.campaign import yaml_file as yf

BOP_IMAGES = ["depth", "gray", "mask", "mask_visib"]
COLUMNS = column_list("all")
DEFAULT_COLUMNS = ("range", "intensity", "status")


@dataclass(frozen=True)
class Npz:
    """Shards of many trials: arrays trial x row x column of the frame."""

    columns: tuple = DEFAULT_COLUMNS
    real: str = "f32"  # type in which float64 columns are stored
    compress: bool = False


@dataclass(frozen=True)
class Cloud:
    """One file per trial, for every n-th trial."""

    columns: tuple | None = None  # None: glidar's defaults
    every: int = 1


@dataclass(frozen=True)
class Bop:
    split: str = "train"
    depth_scale_mm: float = 0.1  # millimetres per step of the depth images
    images: tuple = tuple(BOP_IMAGES)


@dataclass(frozen=True)
class Outputs:
    npz: Npz | None = None
    pcd: Cloud | None = None
    ply: Cloud | None = None
    exr: Cloud | None = None
    mcap: Cloud | None = None  # None of its columns: those that suit the sensor
    kitti: bool = False
    tum: bool = False
    bop: Bop | None = None


DEFAULT = Outputs(npz=Npz())


def _columns(field):
    names = tuple(yf.one_of(item, COLUMNS) for item in yf.items(field))
    if len(set(names)) != len(names):
        yf.reject(field, "a column given twice", "each column once")
    return names


def _is_off(field):
    """`npz: false` is the same as omitting it; `npz: true` selects the defaults."""
    return yf.is_single(field) and not yf.boolean(field)


def _npz(field):
    if yf.is_single(field):
        return None if _is_off(field) else Npz()
    found = yf.require_keys(field, ["columns", "real", "compress"])
    return Npz(yf.optional(found, "columns", _columns, DEFAULT_COLUMNS),
               yf.optional(found, "real", lambda f: yf.one_of(f, ["f32", "f64"]), "f32"),
               yf.optional(found, "compress", yf.boolean, False))


def _cloud(field):
    if yf.is_single(field):
        return None if _is_off(field) else Cloud()
    found = yf.require_keys(field, ["columns", "every"])
    return Cloud(yf.optional(found, "columns", _columns, None),
                 yf.optional(found, "every", lambda f: yf.whole(f, 1, 1 << 32), 1))


def _bop(field):
    if yf.is_single(field):
        return None if _is_off(field) else Bop()
    found = yf.require_keys(field, ["split", "depth_scale_mm", "images"])
    images = Bop.images
    if "images" in found:
        images = tuple(yf.one_of(item, BOP_IMAGES) for item in yf.items(found["images"]))
    return Bop(yf.optional(found, "split", lambda f: yf.one_of(f, ["train", "val", "test"]), "train"),
               yf.optional(found, "depth_scale_mm", lambda f: yf.number(f, yf.ABOVE_ZERO), 0.1),
               images)


def read_outputs(field):
    found = yf.require_keys(field, ["npz", "pcd", "ply", "exr", "mcap", "kitti", "tum", "bop"])
    outputs = Outputs(yf.optional(found, "npz", _npz, None), yf.optional(found, "pcd", _cloud, None),
                      yf.optional(found, "ply", _cloud, None),
                      yf.optional(found, "exr", _cloud, None), yf.optional(found, "mcap", _cloud, None),
                      yf.optional(found, "kitti", yf.boolean, False),
                      yf.optional(found, "tum", yf.boolean, False),
                      yf.optional(found, "bop", _bop, None))
    if outputs == Outputs():
        yf.reject(field, "no output is selected", "at least one of npz, pcd, ply, exr, mcap, kitti, tum, bop")
    return outputs
