# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""BOP data sets, scene-wise (thodan/bop_toolkit, docs/bop_datasets_format.md): each shard is a BOP
scene, each trial an image.

Masks are exact, unlike those that the toolkit estimates by rendering: the visible pixels of an object are those
whose beam hits it first, its silhouette those that hit it when it is rendered alone. As in the toolkit, silhouettes are
counted on a canvas of three times the width and height, so that truncated objects are counted completely.
"""

import json

import numpy as np
from PIL import Image

from glidar import Error
from glidar._poses import inverse
from glidar.campaign import bop_models

FOLDER = "bop"
MAX_STEPS = 65535  # maximum value of a 16-bit depth image
MM_PER_M = 1000.0
NO_BOX = [-1, -1, -1, -1]


def box_of(mask):
    """x, y, width, height of the pixels that are set, like misc.calc_2d_bbox of the toolkit: width and
    height are measured from the first to the last pixel."""
    ys, xs = np.nonzero(mask)
    if len(xs) == 0:
        return NO_BOX
    return [int(xs.min()), int(ys.min()), int(xs.max() - xs.min()), int(ys.max() - ys.min())]


def object_info(silhouette, visible, valid):
    """An entry of scene_gt_info from the masks silhouette (3h x 3w), visible and valid depth (h x w)."""
    rows, cols = visible.shape
    inside = silhouette[rows : 2 * rows, cols : 2 * cols]
    everywhere, seen = int(silhouette.sum()), int(visible.sum())
    box = NO_BOX
    if seen:
        x, y, width, height = box_of(silhouette)
        box = [x - cols, y - rows, width, height]
    return {"px_count_all": everywhere, "px_count_valid": int((inside & valid).sum()),
            "px_count_visib": seen, "visib_fract": seen / everywhere if everywhere else 0.0,
            "bbox_obj": box, "bbox_visib": box_of(visible)}


class TrialError(Error):
    """A frame that BOP cannot represent. Its trial fails."""


def depth_steps(depth_m, scale_mm):
    """The depth image in steps of scale_mm; 0 for no return."""
    steps = np.rint(np.nan_to_num(depth_m * (MM_PER_M / scale_mm)))
    maximum = steps.max(initial=0.0)
    if maximum > MAX_STEPS:
        raise Error("outputs.bop.depth_scale_mm", f"a depth of {maximum * scale_mm / MM_PER_M:.6g} m does "
                    f"not fit in 16 bits in steps of {scale_mm:g} mm",
                    f"at least {maximum * scale_mm / MAX_STEPS:.4g} mm",
                    "if these trials matter, run a new campaign with larger steps")
    return steps.astype(np.uint16)


def object_box(box, object_id):
    """An entry of scene_boxes: rotation and translation from the box to the camera, sizes in mm, and what the camera
    sees of the object in its image."""
    return {"obj_id": object_id,
            "cam_R_b2c": box.frame_from_box[:3, :3].ravel().tolist(),
            "cam_t_b2c": (MM_PER_M * box.centre_m).tolist(),
            "size": (MM_PER_M * box.size_m).tolist(),
            "velocity": (MM_PER_M * box.velocity_m_s).tolist(),
            "points": box.points, "px_count_image": box.beams, "px_count_visib": box.visible_beams,
            "occlusion": box.occlusion if box.beams else None}


def save_json(path, content):
    """Writes JSON in the toolkit's format: one image per line."""
    lines = ",\n".join(f'  "{key}": {json.dumps(content[key], sort_keys=True)}'
                       for key in sorted(content))
    path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


class BopOutput:
    def __init__(self, plan, temp, shard):
        self._options = plan.spec.outputs.bop
        self._temp = temp
        self._folder = f"{FOLDER}/{self._options.split}/{shard:06}"
        self._first = plan.trials_of(shard)[0]
        self._ids = bop_models.ids_by_scene(plan)
        self._camera, self._truth, self._info, self._boxes, self._files = {}, {}, {}, {}, []

    def add(self, row, trial, frame):
        """Raises TrialError before it stores anything of the frame."""
        try:
            depth = depth_steps(frame.depth_m, self._options.depth_scale_mm)
            intrinsics, silhouettes = frame.intrinsics, frame.silhouettes()
        except Error as error:
            raise TrialError(*error.args) from None
        image = trial - self._first
        camera_from_world = inverse(frame.world_from_sensor)
        self._camera[image] = {"cam_K": intrinsics.ravel().tolist(),
                               "depth_scale": self._options.depth_scale_mm,
                               "cam_R_w2c": camera_from_world[:3, :3].ravel().tolist(),
                               "cam_t_w2c": (MM_PER_M * camera_from_world[:3, 3]).tolist()}
        self._truth[image], self._info[image] = [], []
        self._image("depth", f"{image:06}", depth)
        self._image("gray", f"{image:06}", np.rint(
            255.0 * np.clip(np.nan_to_num(frame.intensity), 0.0, 1.0)).astype(np.uint8))
        self._boxes[image] = [object_box(box, self._ids[frame.scene][box.index]) for box in frame.boxes()]
        for i, world_from_object in enumerate(frame.world_from_objects):
            self._add_object(image, self._ids[frame.scene][i],
                             camera_from_world @ world_from_object)
            visible = frame.instance == i
            self._info[image].append(object_info(silhouettes[i], visible, depth > 0))
            rows, cols = visible.shape
            inside = silhouettes[i][rows : 2 * rows, cols : 2 * cols]
            self._image("mask", f"{image:06}_{i:06}", inside.astype(np.uint8) * 255)
            self._image("mask_visib", f"{image:06}_{i:06}", visible.astype(np.uint8) * 255)

    def _add_object(self, image, object_id, camera_from_object):
        self._truth[image].append({"obj_id": object_id,
                                   "cam_R_m2c": camera_from_object[:3, :3].ravel().tolist(),
                                   "cam_t_m2c": (MM_PER_M * camera_from_object[:3, 3]).tolist()})

    def _image(self, kind, name, pixels):
        if kind not in self._options.images:
            return
        path = self._temp.path(f"{name}.png")
        Image.fromarray(pixels).save(path, compress_level=1)
        self._files.append((f"{self._folder}/{kind}/{name}.png", path))

    def finish(self):
        for name, content in (("scene_camera", self._camera), ("scene_gt", self._truth),
                              ("scene_gt_info", self._info), ("scene_boxes", self._boxes)):
            path = self._temp.path(f"{name}.json")
            save_json(path, content)
            self._files.append((f"{self._folder}/{name}.json", path))
        return self._files
