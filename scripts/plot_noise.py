#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/noise.png: what glidar's steps of noise do (circles) against their laws in
noise.md (lines), one panel a step.

usage: plot_noise.py GLIDAR_PROGRAM PICTURE.png
"""

import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Callable

import numpy as np
from PIL import Image, ImageDraw

PANEL = (300, 190)
MARGIN = (46, 36, 14, 20)  # left, top, right, bottom
COLUMNS = 4
COLOURS = [(200, 60, 40), (30, 70, 160), (60, 130, 60), (150, 90, 170), (130, 110, 30)]
HALF_LIGHT = 299792458.0 / 2
DEPTHS_M = [0.6, 0.9, 1.3, 1.8, 2.4, 3.1, 3.9, 4.8]
SIGNALS = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0]
STEREO_M = 674.0 * 0.05
PULSE_M = HALF_LIGHT * 5e-9 / 2.3548  # half of light's way in sigma_p
CAMERA = "{width: 160, height: 120, fov_deg: 0.5}"
LIGHT = "{attenuation: {constant: 1, linear_per_m: 0, quadratic_per_m2: 0}, ambient: 0}"


class Stage:
    """Shots of the program at a plane of given reflectance, or at a box around the sensor."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder

    def scene(self, model, rho=1.0, scale=1.0):
        (self.folder / "scene.yaml").write_text(
            f"models: [{{model: '{model}', scale: {scale}, materials: {{'*': {{diffuse: "
            f"[{rho}, {rho}, {rho}], specular: [0, 0, 0]}}}}}}]\n", encoding="utf-8")

    def render(self, optics, step, options, columns="all", more=""):
        """The cloud's columns as a dictionary of arrays."""
        (self.folder / "sensor.yaml").write_text(
            f"optics: {optics}\nlight: {LIGHT}\n{more}noise: [{step}]\n", encoding="utf-8")
        subprocess.run(
            [self.program, "render", "scene.yaml", "--sensor", "sensor.yaml", "--quiet",
             "--no-sidecar", "--columns", columns, *options, "-o", "cloud.npz"],
            cwd=self.folder, check=True)
        return [dict(np.load(file)) for file in sorted(self.folder.glob("cloud*.npz"))]

    def wall(self, step, depth_m, rho=1.0, seed=1, tilt=0.0, optics=CAMERA):
        """A camera before the middle of a plane, which is tilted by so many radians."""
        self.scene("builtin:plane", rho)
        eye = f"{depth_m * math.sin(tilt)!r},0,{depth_m * math.cos(tilt)!r}"
        return self.render(optics, step, ["--eye", eye, "--target", "0,0,0", "--up-vector",
                                          "0,1,0", "--seed", str(seed)])[0]

    def room(self, step, optics, half_m=5.0):
        self.scene("builtin:box", 1.0, half_m)
        return self.render(optics, step, ["--eye", "0,0,0"])[0]


def depth_sigma_mm(step):
    """Over depths that are spread over a step of disparity, as those of a surface are."""
    def measure(stage, depth_m):
        errors = []
        for k in range(6):
            z = 1.0 / (1.0 / depth_m + k / 6 / 351.3)
            errors.append(stage.wall(step, z, seed=k)["depth"].ravel() - z)
        return 1e3 * float(np.nanstd(np.concatenate(errors)))
    return measure


def range_sigma_mm(step):
    def measure(stage, signal):
        cloud = stage.wall(step, 1.0, rho=signal)
        return 1e3 * float(np.nanstd(cloud["range"] - cloud["true_range"]))
    return measure


def lost(step):
    """Share of returns that a step loses, over depth."""
    return lambda stage, z: float(np.isnan(stage.wall(step, z)["range"]).mean())


def quantum_mm(stage, true_mm):
    cloud = stage.wall("{type: range_quantization, step_m: 0.002}", 1.0 + 1e-3 * true_mm,
                       optics="{width: 1, height: 1, fov_deg: 0.001}")
    return 1e3 * (float(cloud["range"].ravel()[0]) - 1.0)


def level_mm(stage, depth_m):
    """From the level of disparity at a depth to the next one."""
    step = "{type: disparity_quantization, k_m: 351.3}"
    first, second = (1.0 / (round(351.3 / depth_m) - k) * 351.3 for k in (0, 1))
    measured = [float(np.nanmean(stage.wall(step, z)["depth"])) for z in (first, second)]
    return 1e3 * (measured[1] - measured[0])


def bias_quantile_mm(stage, quantile):
    """Of the biases of 400 rings."""
    cloud = stage.wall("{type: range_bias, sigma_m: 0.01}", 1.0,
                       optics="{width: 2, height: 400, fov_deg: 0.5}")
    biases = np.nanmean((cloud["range"] - cloud["true_range"]).reshape(400, 2), axis=1)
    return 1e3 * float(np.quantile(biases, NormalDist().cdf(quantile)))


def drift_correlation(stage, lag_s):
    """Of rings' errors with those of the same rings so much later."""
    stage.scene("builtin:plane")
    for file in stage.folder.glob("cloud*.npz"):
        file.unlink()
    clouds = stage.render(
        "{width: 1, height: 2000, fov_deg: 0.5}",
        "{type: range_drift, sigma_m: 0.01, tau_s: 1, per_ring: true}",
        ["--eye", "0,0,1", "--target", "0,0,0", "--up-vector", "0,1,0", "--duration", "2.05"],
        more="rate_hz: 10\n")
    errors = [(c["range"] - c["true_range"]).ravel() for c in clouds]
    for file in stage.folder.glob("cloud*.npz"):
        file.unlink()
    frames = round(10 * lag_s)
    pairs = [np.mean(a * b) for a, b in zip(errors, errors[frames:])]
    return float(np.mean(pairs) / np.mean([np.mean(e * e) for e in errors]))


def crosstalk_share(stage, place):
    """Share of the foreign ranges below `place`, 0 at near and 1 at the wall."""
    cloud = stage.wall("{type: crosstalk, probability: 0.5, near_m: 0.5}", 1.0)
    foreign = cloud["range"][np.abs(cloud["range"] - cloud["true_range"]) > 1e-3]
    return float(np.mean(foreign < 0.5 + 0.5 * place))


def arrivals_share(stage, range_m):
    """Share of beams into the void with an echo from before this range."""
    step = "{type: false_alarms, rate_hz: 5e6, near_m: 0, far_m: 100}"
    stage.scene("builtin:plane")
    cloud = stage.render(CAMERA, step, ["--eye", "0,0,5", "--target", "0,0,10", "--up-vector",
                                        "0,1,0"])[0]
    return float(np.mean(np.nan_to_num(cloud["range"], nan=1e9) < range_m))


def lateral_px(stage, incidence_deg):
    """The error of depth over the depth's change from pixel to pixel."""
    tilt = math.radians(incidence_deg)
    optics = "{width: 160, height: 120, fx: 4000, fy: 4000}"
    cloud = stage.wall("{type: nguyen_lateral}", 2.0, tilt=tilt, optics=optics)
    depth = cloud["depth"].reshape(120, 160)
    true = (cloud["true_range"] / cloud["range"] * cloud["depth"]).reshape(120, 160)
    inner = (slice(20, -20), slice(20, -20))
    per_px = np.abs(np.gradient(true, axis=1))[inner]
    return float(np.nanstd((depth - true)[inner] / per_px))


def nguyen_px(incidence_deg):
    theta = math.radians(incidence_deg)
    return 0.8 + 0.035 * theta / (math.pi / 2 - theta)


def intensity_sigma(stage, signal):
    cloud = stage.wall("{type: intensity_gaussian, sigma: 0.01, relative: 0.05}", 1.0, rho=signal)
    return float(np.nanstd(cloud["intensity"]))


def vendor_count(stage, log_rho):
    step = f"{{type: intensity_scale, kind: vendor, gain: {10 ** log_rho!r}}}"
    return float(np.nanmean(stage.wall(step, 1.0)["intensity"]))


def vendor_law(log_rho):
    rho = 10 ** log_rho
    return 100 * rho if rho <= 1 else 101 + 154 * math.log(rho) / math.log(100)


def jitter_deg(stage, sigma_deg):
    """Rms angle between where the beams went and where they should have gone, sideways."""
    step = f"{{type: pointing_jitter, sigma_azimuth_deg: {sigma_deg}, sigma_elevation_deg: 0}}"
    cloud = stage.wall(step, 1.0)
    went = cloud["true_xyz"].reshape(-1, 3)
    measured = cloud["xyz"].reshape(-1, 3)
    sine = np.cross(went, measured) / np.linalg.norm(went, axis=1, keepdims=True)
    sine /= np.linalg.norm(measured, axis=1, keepdims=True)
    return math.degrees(float(np.sqrt(np.nanmean(np.sum(sine ** 2, axis=1)))))


def encoder_deg(stage, azimuth_deg):
    """Reported minus true azimuth of a turning head, near a reported azimuth."""
    step = "{type: encoder_error, eccentricity_deg: 0.3, phase_deg: 40}"
    optics = ("{type: spinning, columns_per_turn: 360, elevation_deg: [0], fire_time_us: [0]}")
    cloud = stage.room(step, optics)
    azimuth = [np.degrees(np.arctan2(*cloud[c].reshape(-1, 3)[:, 1::-1].T))
               for c in ("xyz", "true_xyz")]
    error = (azimuth[0] - azimuth[1] + 180) % 360 - 180
    near = np.argmin(np.abs((azimuth[0] - azimuth_deg + 180) % 360 - 180))
    return float(error[near])


def electrons_sigma_mm(_depth_m):
    """Lange and Seitz at 16 MHz: A = 20000 (intensity 1 here), B = 5000, contrast 0.6."""
    return 1e3 * HALF_LIGHT / (2 * math.sqrt(2) * math.pi * 16e6) * math.sqrt(25000) / 12000


@dataclass
class Case:
    title: str
    what: str  # the vertical axis
    unit: str  # of the horizontal axis
    places: list
    measure: Callable  # of stage and place
    law: Callable  # of place


def depth_case(title, step, law):
    return Case(title, "sigma of depth, mm", "depth, m", DEPTHS_M, depth_sigma_mm(step), law)


def signal_case(title, step, law):
    return Case(title, "sigma of range, mm", "intensity", SIGNALS, range_sigma_mm(step), law)


CASES = [
    depth_case("range_gaussian", "{type: range_gaussian, sigma_m: 0.005, sigma_per_m: 0.002}",
               lambda z: 5.0 + 2.0 * z),
    signal_case("range_snr", "{type: range_snr, floor_m: 0.005, k_m: 0.3, snr_at_full_scale: 250}",
                lambda i: 1e3 * math.sqrt(0.005 ** 2 + 0.3 ** 2 / (250 * i))),
    signal_case("range_crlb", "{type: range_crlb, pulse_fwhm_ns: 5, sample_ns: 1, noise: 0.01}",
                lambda i: 1e3 * HALF_LIGHT * 0.01 / i * math.sqrt(
                    2 * 5e-9 / 2.3548 * 1e-9 / math.sqrt(math.pi))),
    signal_case("range_shot_noise", "{type: range_shot_noise, pulse_fwhm_ns: 5, "
                "photons_at_full_scale: 1000}", lambda i: 1e3 * PULSE_M / math.sqrt(1000 * i)),
    depth_case("range_uniform (uniform)", "{type: range_uniform, additive_m: 0.01, "
               "multiplicative: 0.01}", lambda z: 10 * math.sqrt((1 + z * z) / 3)),
    Case("range_quantization, 2 mm", "reported, mm", "true mm", [0.3 + 0.75 * k for k in range(11)],
         quantum_mm, lambda x: 2.0 * math.floor(x / 2.0 + 0.5)),
    Case("range_bias, 400 rings", "quantiles, mm", "normal quantiles", [-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5,
                                                             2], bias_quantile_mm,
         lambda x: 10.0 * x),
    Case("range_drift, 1 s", "correlation", "lag, s", [0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.4, 1.8],
         drift_correlation, lambda t: math.exp(-t)),
    Case("dropout", "share lost", "range, m", DEPTHS_M,
         lost("{type: dropout, probability: 0.05, by_range_m: [[1, 0], [4, 0.6]]}"),
         lambda z: 1 - 0.95 * (1 - 0.6 * min(max((z - 1) / 3, 0), 1))),
    Case("crosstalk", "share of foreign ranges below", "near to wall",
         [0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1], crosstalk_share, lambda x: x),
    Case("false_alarms, 5 MHz", "share with an echo before", "range, m", [5, 15, 25, 40, 55, 70, 85, 99],
         arrivals_share, lambda r: 1 - math.exp(-5e6 * r / HALF_LIGHT)),
    Case("disparity_quantization", "from level to level, mm", "depth, m", DEPTHS_M, level_mm,
         lambda z: 1e3 * z * z / 351.3),
    depth_case("kinect_v1", "{type: kinect_v1}",
               lambda z: 1e3 * z * z / 345.489 * math.sqrt(0.44 ** 2 + 1 / 12)),
    depth_case("khoshelham", "{type: khoshelham}", lambda z: 1.425 * z * z),
    depth_case("nguyen_axial", "{type: nguyen_axial}", lambda z: 1.2 + 1.9 * (z - 0.4) ** 2),
    Case("nguyen_lateral", "sigma, pixels", "incidence, deg", [20, 30, 40, 50, 60, 70, 80], lateral_px,
         nguyen_px),
    depth_case("icl_kinect", "{type: icl_kinect}",
               lambda z: 1e3 * z * z / 351.3 * math.sqrt(1 / 36 + 1 / 12)),
    depth_case("stereo", "{type: stereo, focal_px: 674, baseline_m: 0.05, sigma_px: 0.08}",
               lambda z: 1e3 * z * z * 0.08 / STEREO_M),
    depth_case("continuous_wave, 16 MHz",
               "{type: continuous_wave, frequencies_hz: [16e6], electrons_at_full_scale: 20000, "
               "background_electrons: 5000, contrast: 0.6}", electrons_sigma_mm),
    Case("intensity_gaussian", "sigma", "intensity", SIGNALS, intensity_sigma,
         lambda i: 0.01 + 0.05 * i),
    Case("intensity_scale (vendor)", "reported", "log reflectance",
         [-1.5, -1, -0.6, -0.3, -0.1, 0.3, 0.7, 1.2, 1.6, 2], vendor_count, vendor_law),
    Case("pointing_jitter", "rms angle, deg", "sigma, deg", [0.05, 0.1, 0.2, 0.3, 0.4, 0.5],
         jitter_deg, lambda s: s),
    Case("encoder_error", "error, deg", "azimuth, deg", list(range(-160, 161, 40)), encoder_deg,
         lambda a: 0.3 * math.sin(math.radians(a + 40))),
]


class Panel:
    """One case's axes in the picture."""

    def __init__(self, draw, corner, case, points):
        self.draw = draw
        self.case = case
        self.points = points
        left, top, right, bottom = MARGIN
        self.left, self.top = corner[0] + left, corner[1] + top
        self.width = PANEL[0] - left - right
        self.height = PANEL[1] - top - bottom
        self.x0 = min(0.0, case.places[0])
        self.x1 = case.places[-1] + 0.03 * (case.places[-1] - self.x0)
        begin = self.x0 if case.places[0] <= 0 else 0.9 * case.places[0]
        self.line = [(x, case.law(x)) for x in np.linspace(begin, self.x1, 400)]
        values = [y for _, y in points] + [y for x, y in self.line if x >= case.places[0]]
        self.y0 = min(0.0, 1.1 * min(values))
        self.y1 = 1.1 * max(values)

    def place(self, x, y):
        return (self.left + self.width * (x - self.x0) / (self.x1 - self.x0),
                self.top + self.height * (1 - (y - self.y0) / (self.y1 - self.y0)))

    def text(self, x, y, text, fill="black"):
        self.draw.text((x, y), text, fill=fill)

    def ticks(self, low, high):
        """Round numbers, three to six of them."""
        step = 10.0 ** math.floor(math.log10((high - low) / 3))
        step *= next(k for k in (1, 2, 5, 10) if (high - low) / (k * step) < 6)
        return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step) + 1)]

    def axes(self):
        self.draw.line([self.place(self.x0, self.y1), self.place(self.x0, self.y0),
                        self.place(self.x1, self.y0)], fill="black")
        ticks = self.ticks(self.x0, self.x1)
        for tick in ticks:
            x, y = self.place(tick, self.y0)
            text = f"{tick:.4g}"
            self.draw.line([(x, y), (x, y + 3)], fill="black")
            if x + 20 < self.left + self.width - 6 * len(self.case.unit):
                self.text(x - 3 * len(text), y + 5, text)
        unit_x = self.left + self.width + 8 - 6 * len(self.case.unit)
        self.text(unit_x, self.top + self.height + 5, self.case.unit)
        for tick in self.ticks(self.y0, self.y1):
            x, y = self.place(self.x0, tick)
            text = f"{tick:.4g}"
            self.draw.line([(x - 3, y), (x, y)], fill="black")
            self.text(x - 6 - 6 * len(text), y - 5, text)

    def frame(self):
        """Draws the titles and the axes."""
        self.text(self.left - 40, self.top - 32, self.case.title)
        self.text(self.left - 40, self.top - 19, self.case.what, fill=(110, 110, 110))
        self.axes()

    def curve(self, colour, point_colour):
        """Draws the law and the measured points."""
        self.draw.line([self.place(x, y) for x, y in self.line if y <= self.y1], fill=colour)
        for x, y in self.points:
            x, y = self.place(x, y)
            self.draw.ellipse([x - 3, y - 3, x + 3, y + 3], outline=point_colour)


def deviation_percent(case, law, points):
    """The largest difference from the law, of its largest value."""
    scale = max(abs(law(x)) for x in case.places) or 1.0
    return 100 * max(abs(y - law(x)) for x, y in points) / scale


def draw_noise(stage, draw, corner, case):
    points = [(x, case.measure(stage, x)) for x in case.places]
    print(f"{case.title}: within {deviation_percent(case, case.law, points):.1f} % of the law's largest value")
    panel = Panel(draw, corner, case, points)
    panel.frame()
    panel.curve(COLOURS[0], COLOURS[1])


def plot(usage, stage_type, cases, draw_case):
    """Draws a picture with a panel for each case, by the program and into the file that the command line names."""
    if len(sys.argv) != 3:
        sys.exit(usage)
    program = str(Path(sys.argv[1]).resolve())
    rows = math.ceil(len(cases) / COLUMNS)
    picture = Image.new("RGB", (COLUMNS * PANEL[0], rows * PANEL[1]), "white")
    draw = ImageDraw.Draw(picture)
    with tempfile.TemporaryDirectory() as name:
        stage = stage_type(program, Path(name))
        for k, case in enumerate(cases):
            draw_case(stage, draw, (k % COLUMNS * PANEL[0], k // COLUMNS * PANEL[1]), case)
    picture.convert("P", palette=Image.ADAPTIVE, colors=16).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    plot(__doc__, Stage, CASES, draw_noise)
