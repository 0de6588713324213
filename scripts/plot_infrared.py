#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of docs/internals/infrared.md: infrared.png (image, status and depth of a scene) and infrared-curves.png
(noise of a wall, edge of an object, reflectance and sunlight), and prints the numbers of its table.

usage: plot_infrared.py GLIDAR_PROGRAM FOLDER
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np
import yaml
from PIL import Image

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

PRESET = Path(__file__).resolve().parents[1] / "sensors" / "D435.yaml"
PRODUCT = 430.1398 * 0.05015  # f b of the preset D435, metres times pixels
STATUSES = {0: (255, 255, 255), 1: (90, 90, 90), 7: (70, 110, 200), 9: (240, 200, 40), 12: (170, 170, 170), 13: (0, 0, 0),
            14: (140, 80, 170), 15: (230, 130, 50), 16: (90, 180, 220), 17: (60, 150, 90), 18: (200, 90, 140)}
SCENE = [
    ("plane", 4.0, (0.0, 0.0, 1.6), {}),
    ("box", 0.16, (-0.28, 0.05, 1.0), {}),
    ("sphere", 0.14, (0.05, -0.12, 0.9), {}),
    ("box", 0.12, (0.42, 0.12, 1.2), {"diffuse": [0.004, 0.004, 0.004]}),
    ("box", 0.12, (0.05, 0.28, 1.1), {"opacity": 0.05}),
    ("box", 0.12, (0.45, -0.25, 1.0), {"diffuse": [0.6, 0.6, 0.6],
                                       "backscatter": {"type": "glossy", "diffuse_fraction": 0.02, "lobe_gain": 60, "width_deg": 4}}),
]


class Camera:
    """The preset D435 in a folder, with a smaller image and changes."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder
        self.preset = yaml.safe_load(PRESET.read_text(encoding="utf-8"))

    def shoot(self, models, size=(424, 240), sun=0.0, seed=1):
        """Columns of the cloud and the left image."""
        sensor = dict(self.preset)
        width, height = size
        sensor["optics"] = {"type": "pinhole", "width": width, "height": height, "fx": 430.1398, "fy": 430.1398}
        sensor["depth_model"] = "physical"
        sensor["depth_camera"] = dict(sensor["depth_camera"])
        sensor["depth_camera"]["illumination"] = {"ambient_w_per_m2": 0.03, "sun_w_per_m2": sun, "sun_direction": [0, 0, -1]}
        sensor["limits"] = {"near_m": 0.1, "far_m": 100}
        for key in ("source", "unverified", "aliases"):
            sensor.pop(key, None)
        entries = [{"model": f"builtin:{model}", "scale": scale, "pose": {"position": list(position)},
                    "materials": {"*": {"diffuse": [0.5, 0.5, 0.5], **material}}} for model, scale, position, material in models]
        (self.folder / "sensor.yaml").write_text(yaml.safe_dump(sensor), encoding="utf-8")
        (self.folder / "scene.yaml").write_text(
            yaml.safe_dump({"models": entries, "sensor": "sensor.yaml", "sensor_pose": {"position": [0, 0, 0]}}), encoding="utf-8")
        subprocess.run([self.program, "render", "scene.yaml", "--quiet", "--no-sidecar", "--seed", str(seed), "--columns",
                        "depth,status,true_range", "-o", "a.npz", "-o", "a.ir_left.png"], cwd=self.folder, check=True)
        cloud = {name: np.asarray(column) for name, column in np.load(self.folder / "a.npz").items()}
        return cloud, np.asarray(Image.open(self.folder / "a.ir_left.png"))

    def wall(self, depth_m, reflectance=0.5, **options):
        return self.shoot([("plane", 40.0, (0.0, 0.0, depth_m), {"diffuse": [reflectance] * 3})], **options)[0]


def fill(cloud):
    return float(np.mean(cloud["status"] == 0))


def disparity(cloud):
    return PRODUCT / cloud["depth"]


def plane_deviation(values):
    """Median deviation from planes through 9 x 9 pixels."""
    v, u = np.mgrid[-4:5, -4:5]
    basis = np.stack([np.ones(81), u.ravel(), v.ravel()], axis=1)
    residual = np.eye(81) - basis @ np.linalg.pinv(basis)
    patches = np.lib.stride_tricks.sliding_window_view(values, (9, 9))[::9, ::9].reshape(-1, 81)
    patches = patches[np.isfinite(patches).all(axis=1)]
    return float(np.median(np.sqrt(np.square(patches @ residual).sum(axis=1) / 78)))


def noise_curves(camera, axis):
    depths = [0.35, 0.5, 0.75, 1.1, 1.6, 2.3, 3.0]
    wall, plane, temporal, sigma = [], [], [], []
    for depth in depths:
        frames = [camera.wall(depth, seed=seed) for seed in (1, 2, 3, 4)]
        all_px = np.stack([disparity(frame) for frame in frames])
        good = np.isfinite(all_px).all(axis=0) & (np.abs(all_px - PRODUCT / depth) < 1).all(axis=0)
        wall.append(np.std(all_px[0][good]))
        sigma.append(np.std(frames[0]["depth"][good]))
        temporal.append(np.sqrt(np.var(all_px[:, good], axis=0, ddof=1).mean()))
        plane.append(plane_deviation(all_px[0]))
    exponent = np.polyfit(np.log(depths), np.log(sigma), 1)[0]
    print(f"temporal {min(temporal):.3f} to {max(temporal):.3f} px, plane {min(plane):.3f} to {max(plane):.3f} px, "
          f"wall {min(wall):.3f} to {max(wall):.3f} px, exponent {exponent:.2f}")
    axis.plot(depths, temporal, "o-", label="one pixel over time")
    axis.plot(depths, wall, "s-", label="whole wall")
    axis.plot(depths, plane, "^-", label="planes of 9 x 9 px")
    axis.plot([0.45, 0.75, 1.05, 1.35, 1.65, 2.0], [0.097, 0.078, 0.096, 0.094, 0.123, 0.129], "kx", label="real, over time")
    axis.plot([0.75, 1.05, 1.35, 1.65, 2.0], [0.038, 0.038, 0.027, 0.027, 0.023], "k+", label="real, 9 x 9 px")
    axis.set(xlabel="depth, m", ylabel="disparity noise, px", title="A wall", ylim=(0, 0.16))
    axis.legend(fontsize=6)


def edge_curve(camera, axis):
    cloud, _ = camera.shoot([("plane", 4.0, (4.0, 0.0, 0.6), {}), ("plane", 40.0, (0.0, 0.0, 1.2), {})])
    rows = disparity(cloud)[60:180]
    column = np.arange(rows.shape[1]) - rows.shape[1] / 2
    axis.plot(column, np.nanmedian(rows, axis=0), ".", ms=2, label="median of the rows")
    axis.plot(column, 100 * np.isfinite(rows).mean(axis=0) / 4, lw=0.8, label="filled, % / 4")
    axis.axvspan(-PRODUCT * (1 / 0.6 - 1 / 1.2), 0, alpha=0.2, label="f b (1/z1 - 1/z2)")
    axis.set(xlabel="column from the edge, px", ylabel="disparity, px", title="An edge at 0.6 m before 1.2 m", xlim=(-60, 40))
    axis.legend(fontsize=6)


def sweep(axis, values, shots, wall_m, label):
    filled, wrong = [], []
    for cloud in shots:
        filled.append(100 * fill(cloud))
        off = np.abs(disparity(cloud) - PRODUCT / wall_m) > 1
        wrong.append(100 * np.mean(off & (cloud["status"] == 0)))
    axis.plot(values, filled, "o-", label="filled")
    axis.plot(values, wrong, "s-", label="off by more than 1 px")
    axis.set(ylabel="% of the pixels", xlabel=label, ylim=(-3, 100))
    axis.legend(fontsize=6)


def draw_curves(camera, path):
    figure, axes = plt.subplots(2, 2, figsize=(8, 5.6), dpi=100)
    noise_curves(camera, axes[0, 0])
    edge_curve(camera, axes[0, 1])
    reflectances = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.3, 0.8]
    sweep(axes[1, 0], reflectances, [camera.wall(2.5, rho) for rho in reflectances], 2.5, "reflectance of a wall at 2.5 m")
    axes[1, 0].set_xscale("log")
    suns = [0, 0.5, 1, 2, 4, 8, 16, 32, 64]
    sweep(axes[1, 1], suns, [camera.wall(1.5, sun=sun) for sun in suns], 1.5, "sunlight on a wall at 1.5 m, W/m² in the passband")
    axes[1, 1].set_xscale("symlog", linthresh=0.5)
    axes[1, 1].set_xlim(left=0)
    figure.tight_layout()
    figure.savefig(path)


def draw_scene(camera, path):
    cloud, image = camera.shoot(SCENE, size=(480, 300))
    status = np.zeros((*image.shape, 3), np.uint8)
    for number, colour in STATUSES.items():
        status[cloud["status"] == number] = colour
    depth = cloud["depth"]
    shown = plt.get_cmap("viridis")(np.clip((depth - 0.8) / 0.9, 0, 1))[..., :3] * 255
    shown[~np.isfinite(depth)] = 0
    panels = [np.repeat(np.clip(image.astype(float) * 1.6, 0, 255)[..., None], 3, axis=2), status, shown]
    Image.fromarray(np.concatenate(panels, axis=1).astype(np.uint8)).resize((1200, 250), Image.Resampling.LANCZOS).convert(
        "P", palette=Image.Palette.ADAPTIVE, colors=96).save(path, optimize=True)
    names, counts = np.unique(cloud["status"], return_counts=True)
    print("statuses", dict(zip(names.tolist(), counts.tolist())))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        camera = Camera(str(Path(sys.argv[1]).resolve()), Path(name))
        draw_scene(camera, Path(sys.argv[2]) / "infrared.png")
        draw_curves(camera, Path(sys.argv[2]) / "infrared-curves.png")


if __name__ == "__main__":
    main()
