# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of a nuScenes data set (Caesar et al. 2020; schema: schema_nuscenes.md of nuscenes-devkit 1.2)."""

from __future__ import annotations

import hashlib
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ._inputs import FloatArray
from ._poses import quaternion

Record: TypeAlias = dict[str, Any]

NAMES = ("category", "attribute", "visibility", "instance", "sensor", "calibrated_sensor", "ego_pose", "log", "scene",
         "sample", "sample_data", "sample_annotation", "map", "lidarseg")  # fmt: skip

# The categories of nuScenes and nuScenes-lidarseg, for which the devkit has colours.
KNOWN_CATEGORIES = (
    "noise", "animal", "human.pedestrian.adult", "human.pedestrian.child", "human.pedestrian.construction_worker",
    "human.pedestrian.personal_mobility", "human.pedestrian.police_officer", "human.pedestrian.stroller",
    "human.pedestrian.wheelchair", "movable_object.barrier", "movable_object.debris",
    "movable_object.pushable_pullable", "movable_object.trafficcone", "static_object.bicycle_rack", "vehicle.bicycle",
    "vehicle.bus.bendy", "vehicle.bus.rigid", "vehicle.car", "vehicle.construction", "vehicle.emergency.ambulance",
    "vehicle.emergency.police", "vehicle.motorcycle", "vehicle.trailer", "vehicle.truck", "flat.driveable_surface",
    "flat.other", "flat.sidewalk", "flat.terrain", "static.manmade", "static.other", "static.vegetation",
    "vehicle.ego")  # fmt: skip

# The categories of common names of classes.
CATEGORIES = {
    "unlabelled": "noise", "car": "vehicle.car", "truck": "vehicle.truck", "bus": "vehicle.bus.rigid",
    "trailer": "vehicle.trailer", "bicycle": "vehicle.bicycle", "motorcycle": "vehicle.motorcycle",
    "person": "human.pedestrian.adult", "pedestrian": "human.pedestrian.adult", "animal": "animal",
    "barrier": "movable_object.barrier", "cone": "movable_object.trafficcone", "road": "flat.driveable_surface",
    "pavement": "flat.sidewalk", "sidewalk": "flat.sidewalk", "terrain": "flat.terrain", "grass": "flat.terrain",
    "building": "static.manmade", "wall": "static.manmade", "fence": "static.manmade", "pole": "static.manmade",
    "tree": "static.vegetation", "vegetation": "static.vegetation"}  # fmt: skip

# Surroundings, which have labels of points but no boxes.
UNBOXED = ("noise", "flat.", "static.", "vehicle.ego")

# Lower ends of the visible fraction.
VISIBILITIES = (("v0-40", 0.0), ("v40-60", 0.4), ("v60-80", 0.6), ("v80-100", 0.8))

ATTRIBUTES = ("vehicle.moving", "vehicle.parked", "cycle.without_rider", "pedestrian.moving", "pedestrian.standing")
MOVING_M_S = 0.2  # speeds above are "moving"


def token(*parts: object) -> str:
    """32 hexadecimal digits that depend on the parts only, so that the same data have the same tokens."""
    return hashlib.md5("/".join(str(part) for part in parts).encode(), usedforsecurity=False).hexdigest()


def visibility_token(visible: int, beams: int) -> str:
    """The token of the visible fraction of beams: "1" to "4", as in nuScenes."""
    return str(max(1, sum(visible >= least * beams for _, least in VISIBILITIES))) if beams else "1"


def attribute_of(category: str, speed_m_s: float) -> str | None:
    """The attribute of an object; None for categories that have none."""
    is_moving = speed_m_s > MOVING_M_S
    if category in ("vehicle.bicycle", "vehicle.motorcycle"):
        return "cycle.without_rider"
    if category.startswith("vehicle."):
        return "vehicle.moving" if is_moving else "vehicle.parked"
    if category.startswith("human.pedestrian."):
        return "pedestrian.moving" if is_moving else "pedestrian.standing"
    return None


def pose_record(pose: FloatArray) -> Record:
    """Translation and rotation, w first."""
    return {"translation": plain(pose[:3, 3]), "rotation": plain(quaternion(pose, "wxyz"))}


def plain(numbers: npt.ArrayLike) -> list[float]:
    """Numbers for JSON, without -0."""
    return [float(number) + 0.0 for number in np.asarray(numbers)]


def link(records: list[Record]) -> None:
    """Sets prev and next of records in the order of time."""
    for k, record in enumerate(records):
        record["prev"] = records[k - 1]["token"] if k > 0 else ""
        record["next"] = records[k + 1]["token"] if k + 1 < len(records) else ""


def fixed_tables() -> dict[str, list[Record]]:
    """The tables at the beginning; visibilities and attributes are the same in every data set."""
    tables: dict[str, list[Record]] = {name: [] for name in NAMES}
    for number, (level, least) in enumerate(VISIBILITIES, 1):
        upper = 100 if number == len(VISIBILITIES) else round(100 * VISIBILITIES[number][1])
        tables["visibility"].append({"token": str(number), "level": level,
                                     "description": f"{round(100 * least)} to {upper} % of the object are visible"})  # fmt: skip
    for name in ATTRIBUTES:
        tables["attribute"].append({"token": token("attribute", name), "name": name, "description": ""})
    return tables
