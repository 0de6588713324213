#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/structured-light.png: a sphere before a wall, whose images are rendered with shadows of the projector,
falloff, ambient light and shot noise, and decoded.

usage: plot_structured_light.py [ROOT], by a Python that has glidar and Matplotlib.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import yaml
from PIL import Image

import glidar

DPI = 90
COLOURS = 128  # so that noise takes little space
ELECTRONS = 9000.0  # of a white pixel at 0.8 m that faces the projector
AMBIENT = 0.05  # of it
READ_NOISE = 8.0  # electrons
ELECTRONS_PER_LEVEL = 45.0
STATUS_COLOURS = np.array([(235, 235, 235), (240, 200, 40), (30, 30, 30), (225, 110, 40), (50, 110, 200), (150, 90, 200)])


def scene():
    """In the optical frame of the camera."""
    result = glidar.Scene()
    result.add_model("builtin:box:size=2,2,0.1", pose=glidar.pose((0.0, 0.0, 1.0)))
    result.add_model("builtin:sphere:radius=0.1", pose=glidar.pose((0.0, 0.0, 0.8)))
    return result


def camera_and_pose(setup):
    """The camera as a sensor that sees what the projector lights, and projector_from_camera."""
    keys = setup["projector_from_camera"]
    angle = keys["rotation_vector"][1]
    rotation = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    translation = np.array(keys["position"])
    sensor = glidar.Sensor.from_dict({"optics": {"type": "pinhole", **setup["camera"]},
                                      "projector_origin_m": list(-rotation.T @ translation)})
    return sensor, rotation, translation


def render(setup, patterns):
    """The camera's images of the patterns, 8 bits, and the true depth."""
    sensor, rotation, translation = camera_and_pose(setup)
    frame = glidar.simulate(scene(), sensor, np.eye(4))
    points = frame.ground_truth.range_m[..., None] * sensor.ray_directions
    truth = points[..., 2]
    lit = frame.status == glidar.Status.hit
    points = points @ rotation.T + translation
    distance = np.linalg.norm(points, axis=-1)
    cosine = np.clip(-np.sum(frame.ground_truth.normal @ rotation.T * points, axis=-1) / distance, 0, 1)
    height, width = patterns.shape[1:]
    focal = width / 2 / np.tan(np.radians(setup["projector"]["fov_x_deg"]) / 2)
    column = focal * points[..., 0] / points[..., 2] + width / 2 - 0.5
    row = focal * points[..., 1] / points[..., 2] + height / 2 - 0.5
    inside = lit & (column >= 0) & (column <= width - 1) & (row >= 0) & (row <= height - 1)
    column, row = np.where(inside, column, 0), np.where(inside, row, 0).round().astype(int)
    left = np.floor(column).astype(int)
    share, right = column - left, np.minimum(left + 1, width - 1)
    random = np.random.default_rng(1)
    images = []
    for pattern in patterns / 255.0:
        light = np.where(inside, (1 - share) * pattern[row, left] + share * pattern[row, right], 0.0)
        electrons = ELECTRONS * (light * cosine * (0.8 / distance) ** 2 + AMBIENT)
        electrons = random.poisson(electrons) + random.normal(0, READ_NOISE, electrons.shape)
        images.append(np.clip(np.round(electrons / ELECTRONS_PER_LEVEL), 0, 255).astype(np.uint8))
    return np.array(images), truth


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent)
    setup = yaml.safe_load((root / "examples/structured_light.yaml").read_text(encoding="utf-8"))
    scanner = glidar.StructuredLight(setup)
    images, truth = render(setup, scanner.patterns())
    found = scanner.decode(images)
    error_mm = 1000 * np.nanmedian(np.abs(found.depth_m - truth))
    shown = [(images[0], "gray", "fringes"), (images[-6], "gray", "Gray code"), (found.phase_rad, "twilight", "phase"),
             (found.depth_m, "viridis", f"depth, median error {error_mm:.2f} mm"), (STATUS_COLOURS[found.status], None, "status")]
    figure, axes = plt.subplots(1, len(shown), figsize=(12, 2.2), dpi=DPI, layout="constrained")
    for axis, (image, colours, title) in zip(axes, shown):
        axis.imshow(image, cmap=colours)
        axis.set_title(title, fontsize=9)
        axis.set_axis_off()
    path = root / "docs/images/structured-light.png"
    figure.savefig(path)
    Image.open(path).convert("RGB").quantize(COLOURS).save(path, optimize=True)


if __name__ == "__main__":
    main()
