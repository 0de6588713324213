#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/cameras.png: one scene through every camera model.

usage: plot_cameras.py GLIDAR [ROOT]; GLIDAR is the program, ROOT the folder of the sources.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

COLUMNS = 4
TILE = (190, 142)
GAP = 6
LABEL = 16
SAMPLES = 2  # rays per pixel and axis
SUN = np.array([-0.3, 0.5, 0.8]) / np.linalg.norm([-0.3, 0.5, 0.8])
SKY = (0.72, 0.82, 0.93)
NO_BEAM = (1.0, 1.0, 1.0)
NO_BEAM_STATUS = 4  # invalid_pixel
#: Label, focal length in widths of the picture, further keys of `optics`, tiles across.
CAMERAS = [
    ("pinhole", 0.5, "", 1),
    ("pinhole, skew", 0.5, "skew: 0.25", 1),
    ("radial_tangential, k1 and k2", 0.5, "distortion: {model: radial_tangential, k1: -0.2, k2: 0.03}", 1),
    ("thin prism, s1 and s3", 0.5, "distortion: {model: radial_tangential, s1: 0.12, s3: -0.12}", 1),
    ("tilted sensor, tau_x and tau_y", 0.5, "distortion: {model: radial_tangential, tau_x: 0.25, tau_y: 0.3}", 1),
    ("fov", 0.42, "distortion: {model: fov, w: 1.2}", 1),
    ("fisheye", 0.25, "distortion: {model: fisheye}", 1),
    ("omni", 0.5, "distortion: {model: omni, xi: 1.2}", 1),
    ("double_sphere", 0.32, "distortion: {model: double_sphere, xi: -0.2, alpha: 0.6}", 1),
    ("eucm", 0.3, "distortion: {model: eucm, alpha: 0.6, beta: 1.1}", 1),
    ("equirectangular", None, "distortion: {model: equirectangular}", 2),
]


def optics_text(focal, keys, size):
    keys = keys.replace("skew: 0.25", f"skew: {0.25 * focal * size[0]}" if focal else "")
    lens = "" if focal is None else f", fx: {focal * size[0]}, fy: {focal * size[0]}"
    return f"optics: {{width: {size[0]}, height: {size[1]}{lens}{', ' + keys if keys else ''}}}\n"


def picture_of(program, scene, camera, size):
    """The image as RGB, 0 to 1."""
    _, focal, keys, _ = camera
    many = tuple(SAMPLES * side for side in size)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "camera.yaml").write_text(optics_text(focal, keys, many), encoding="utf-8")
        subprocess.run([program, "render", str(scene), "--sensor", "camera.yaml", "--eye", "0.5,0.3,1.7", "--target",
                        "9,1.6,1.7", "--quiet", "--no-sidecar", "--columns", "colour,shading_normal,status",
                        "-o", "a.npz"], cwd=folder, check=True)
        cloud = dict(np.load(Path(folder, "a.npz")).items())
    rotation = cloud["world_from_sensor"][:3, :3]
    light = 0.45 + 0.55 * np.clip(cloud["shading_normal"] @ rotation.T @ SUN, 0, 1)
    image = np.power(np.clip(cloud["colour"] * light[..., None], 0, 1), 1 / 1.6)
    image[cloud["status"] != 0] = SKY
    image[cloud["status"] == NO_BEAM_STATUS] = NO_BEAM
    rows, cols = image.shape[0] // SAMPLES, image.shape[1] // SAMPLES
    return image.reshape(rows, SAMPLES, cols, SAMPLES, 3).mean(axis=(1, 3))


def main():
    program = str(Path(sys.argv[1]).resolve())
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".").resolve()
    rows = -(-sum(camera[3] for camera in CAMERAS) // COLUMNS)
    cell = (TILE[0] + GAP, TILE[1] + LABEL + GAP)
    sheet = Image.new("RGB", (COLUMNS * cell[0] - GAP, rows * cell[1] - GAP), "white")
    draw = ImageDraw.Draw(sheet)
    place = 0
    for camera in CAMERAS:
        label, across = camera[0], camera[3]
        x, y = place % COLUMNS * cell[0], place // COLUMNS * cell[1]
        size = (across * cell[0] - GAP, TILE[1])
        image = picture_of(program, root / "examples/street.yaml", camera, size)
        sheet.paste(Image.fromarray(np.uint8(np.round(255 * image))), (x, y + LABEL))
        draw.text((x + 1, y + 2), label, fill="black")
        place += across
    sheet.quantize(96, dither=Image.Dither.NONE).save(root / "docs/images/cameras.png", optimize=True)
    print("wrote", root / "docs/images/cameras.png")


if __name__ == "__main__":
    main()
