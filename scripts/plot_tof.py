#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of docs/time-of-flight.md and docs/internals/time-of-flight-simulation.md.

usage: PYTHONPATH=build/dev/python build/venv/bin/python scripts/plot_tof.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

import glidar

STATUS_COLOURS = {"valid": (235, 235, 235), "not_illuminated": (110, 110, 110), "saturated": (240, 200, 40),
                  "low_signal": (30, 30, 30), "ambiguous": (230, 120, 30), "too_near": (60, 140, 90),
                  "too_far": (130, 70, 160), "edge": (40, 90, 200)}
SCALE = 3
LIGHT_M_PER_S = 299792458.0


def depth_colours(depth_m, near_m, far_m):
    """From red (near) over green to blue (far); holes are black."""
    t = np.clip((np.nan_to_num(depth_m, nan=near_m) - near_m) / (far_m - near_m), 0, 1)[..., None]
    stops = np.array([[210, 60, 40], [240, 210, 90], [70, 160, 120], [40, 70, 150]], float)
    place = t * (len(stops) - 1)
    index = np.minimum(place.astype(int), len(stops) - 2)[..., 0]
    colours = stops[index] + (place - index[..., None]) * (stops[index + 1] - stops[index])
    colours[np.isnan(depth_m)] = 0
    return colours.astype(np.uint8)


def enlarged(pixels):
    return Image.fromarray(pixels.repeat(SCALE, axis=0).repeat(SCALE, axis=1))


def draw_status(path):
    raw, depth_per_range, is_illuminated = glidar.sample_tof_images()
    measured = glidar.decode_tof(raw, glidar.TofOptions.kinect_v2(), depth_per_range=depth_per_range,
                                 is_illuminated=is_illuminated)
    depth = enlarged(depth_colours(measured.range_m * depth_per_range, 1.0, 4.5))
    table = np.array([STATUS_COLOURS[status.name] for status in glidar.TofStatus], np.uint8)
    status = enlarged(table[measured.status])
    legend = 30
    picture = Image.new("RGB", (depth.width + status.width + 10, depth.height + legend), "white")
    picture.paste(depth, (0, 0))
    picture.paste(status, (depth.width + 10, 0))
    pen = ImageDraw.Draw(picture)
    pen.text((4, depth.height + 9), "depth 1 m (red) to 4.5 m (blue); holes black", fill=(40, 40, 40))
    x = depth.width + 10
    for status_of in (s for s in glidar.TofStatus if (measured.status == s).any()):
        pen.rectangle([x, depth.height + 10, x + 9, depth.height + 19], fill=STATUS_COLOURS[status_of.name], outline=(40, 40, 40))
        pen.text((x + 13, depth.height + 9), status_of.name, fill=(40, 40, 40))
        x += 22 + int(pen.textlength(status_of.name))
    picture.save(path, optimize=True)


def raw_values(frequencies_hz, ranges_m, taps, correlation, electrons=1e6, random=None):
    """Frequencies x phase steps x 1 x ranges; with `random`, shot noise of the two wells."""
    turns = 2 * np.reshape(frequencies_hz, (-1, 1, 1, 1)) * np.reshape(ranges_m, (1, 1, 1, -1)) / LIGHT_M_PER_S
    values = correlation(turns - np.arange(taps).reshape(1, -1, 1, 1) / taps)
    if random is None:
        return electrons * values
    return random.poisson(electrons * (1 + values) / 2) - random.poisson(electrons * (1 - values) / 2.0)


def sine(turns):
    return np.cos(2 * np.pi * turns)


def triangle(turns):
    """The correlation of a square wave with a square wave."""
    return 1 - 4 * np.abs(turns - np.round(turns))


class Chart:
    """Axes with curves in a part of a picture."""

    def __init__(self, pen, box, title, x_range, y_range, x_ticks, y_ticks):
        self.pen, self.box, self.x_range, self.y_range = pen, box, x_range, y_range
        left, top, right, bottom = box
        pen.rectangle(box, outline=(120, 120, 120))
        pen.text((left, top - 16), title, fill=(20, 20, 20))
        for x in x_ticks:
            pen.line([self.at(x, y_range[0]), (self.at(x, y_range[0])[0], bottom + 4)], fill=(120, 120, 120))
            pen.text((self.at(x, 0)[0] - 8, bottom + 6), f"{x:g}", fill=(60, 60, 60))
        for y in y_ticks:
            pen.line([self.at(x_range[0], y), self.at(x_range[1], y)], fill=(225, 225, 225))
            pen.text((left - 32, self.at(0, y)[1] - 6), f"{y:g}", fill=(60, 60, 60))

    def at(self, x, y):
        left, top, right, bottom = self.box
        return (left + (x - self.x_range[0]) / (self.x_range[1] - self.x_range[0]) * (right - left),
                bottom - (y - self.y_range[0]) / (self.y_range[1] - self.y_range[0]) * (bottom - top))

    def line(self, x, y, colour):
        self.pen.line([self.at(*point) for point in zip(x, y, strict=True)], fill=colour, width=2)

    def curve(self, x, y, colour, name, line):
        self.line(x, y, colour)
        self.pen.text((self.box[0] + 8, self.box[1] + 6 + 13 * line), name, fill=colour)

    def dots(self, x, y, colour, name, line, radius=1):
        for point in zip(x, y, strict=True):
            u, v = self.at(*point)
            self.pen.ellipse([u - radius, v - radius, u + radius, v + radius], fill=colour)
        self.pen.text((self.box[0] + 8, self.box[1] + 6 + 13 * line), name, fill=colour)


def draw_wiggling(pen, box):
    period_m = LIGHT_M_PER_S / 2 / 80e6
    ranges_m = np.linspace(0.02, 0.98, 400) * period_m
    chart = Chart(pen, box, "wiggling at 80 MHz: error in mm by the range in m", (0, period_m), (-30, 30),
                  np.arange(0, 1.9, 0.5), (-20, -10, 0, 10, 20))
    for line, (taps, colour) in enumerate(((3, (30, 70, 160)), (4, (200, 60, 40)), (5, (60, 130, 60)))):
        raw = raw_values([80e6], ranges_m, taps, triangle)
        measured = glidar.decode_tof(raw, glidar.TofOptions(frequencies_hz=[80e6], taps=taps))
        chart.curve(ranges_m, 1e3 * (measured.range_m[0] - ranges_m), colour, f"{taps} phase steps", line)


def draw_wraps(pen, box):
    ranges_m = np.linspace(0.1, 18.6, 1500)
    chart = Chart(pen, box, "80, 16 and 120 MHz with 6 electrons: measured by true range in m", (0, 18.75), (0, 18.75),
                  (0, 5, 10, 15), (0, 5, 10, 15))
    raw = raw_values([80e6, 16e6, 120e6], ranges_m, 3, sine, electrons=6, random=np.random.default_rng(1))
    untested = glidar.TofMisfitTest(min_rad=100, max_rad=100, scale=100)
    options = glidar.TofOptions(frequencies_hz=[80e6, 16e6, 120e6], taps=3, misfit_test=untested)
    all_m = glidar.decode_tof(raw, options).range_m[0]
    tested_m = glidar.decode_tof(raw, glidar.TofOptions(frequencies_hz=[80e6, 16e6, 120e6], taps=3)).range_m[0]
    chart.dots(ranges_m, all_m, (220, 130, 60), "all pixels", 0)
    kept = ~np.isnan(tested_m)
    chart.dots(ranges_m[kept], tested_m[kept], (30, 70, 160), "misfit below 0.61 rad", 1)


def draw_errors(path):
    picture = Image.new("RGB", (900, 300), "white")
    pen = ImageDraw.Draw(picture)
    draw_wiggling(pen, (50, 30, 430, 265))
    draw_wraps(pen, (500, 30, 880, 265))
    picture.save(path, optimize=True)


def tof_camera(optics, frequencies_hz, **keys):
    """A camera of so many electrons that shot noise is invisible, without tests of pixels."""
    untested = {"min_rad": 100, "max_rad": 100, "scale": 100}
    return glidar.Sensor.from_dict({
        "optics": optics, "wavelength_nm": 850, "depth_model": "physical",
        "depth_camera": {"type": "time_of_flight", "signal_electrons": 1e12, **keys,
                         "decoder": {"frequencies_hz": frequencies_hz, "misfit_test": untested}}})


def panel(scene, corner, u, v, reflectance):
    """A parallelogram that is seen from both sides."""
    corner, u, v = (np.asarray(value, float) for value in (corner, u, v))
    faces = [[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]
    scene.add_mesh([corner, corner + u, corner + u + v, corner + v], faces).set_materials({"*": {"diffuse": [reflectance] * 3}})


def draw_flying_pixels(pen, box):
    """Pixels that a tilted edge crosses, by the share of them that shows the near wall."""
    near_m, far_m, f_hz, fine = 1.5, 2.5, 40e6, 16
    scene = glidar.Scene()
    panel(scene, (-3, -3, near_m), (3, 0, 0), (0.4, 6, 0), 0.5)
    panel(scene, (-4, -4, far_m), (8, 0, 0), (0, 8, 0), 0.5)
    optics = {"width": 64, "height": 48, "fx": 120, "fy": 120}
    raw = glidar.simulate(scene, tof_camera(optics, [f_hz], sub_rays=fine, bounces=0), np.eye(4))
    depth_m = raw.range_m * raw_cosines(optics)
    rays = glidar.simulate(scene, glidar.Sensor.from_dict({"optics": {key: fine * value for key, value in optics.items()}}), np.eye(4))
    is_near = (rays.range_m * raw_cosines({key: fine * value for key, value in optics.items()}) < 2).astype(float)
    share = is_near.reshape(48, fine, 64, fine).mean(axis=(1, 3))
    chart = Chart(pen, box, "an edge at 1.5 m before 2.5 m, 40 MHz: depth in m by the near share", (0, 1), (1.3, 2.7),
                  (0, 0.25, 0.5, 0.75, 1), (1.5, 2, 2.5))
    shares = np.linspace(0, 1, 200)
    turn = 4j * np.pi * f_hz / LIGHT_M_PER_S
    phasor = shares / near_m**2 * np.exp(turn * near_m) + (1 - shares) / far_m**2 * np.exp(turn * far_m)
    chart.curve(shares, np.mod(np.angle(phasor), 2 * np.pi) / abs(turn), (30, 70, 160), "sum of both waves", 0)
    mixed = (share > 0) & (share < 1)
    chart.dots(share[mixed][::2], depth_m[mixed][::2], (220, 130, 60), "simulated pixels", 1, radius=2)


def raw_cosines(optics):
    """Depth over range of each pixel."""
    return glidar.Sensor.from_dict({"optics": optics}).ray_directions[..., 2]


CORNER_CAMERA_M = np.array([1.2, 1.2, 0.0])
CORNER_REFLECTANCE = 0.8


def corner_error_m(place_m, f_hz):
    """One bounce by quadrature: a wall y = 0 seen at x = place_m, lit over the wall x = 0 that is 2 m wide and 3 m high."""
    t = (np.arange(400) + 0.5) / 400
    u = (np.arange(401) + 0.5) / 401 * 2 - 1
    y, z = 2 * t[:, None]**3, 1.5 * u[None, :]**3  # finer near the corner
    area = 6 * t[:, None]**2 / 400 * 4.5 * u[None, :]**2 * 2 / 401
    lamp2 = CORNER_CAMERA_M[0]**2 + (y - CORNER_CAMERA_M[1])**2 + z**2
    way2 = place_m**2 + y**2 + z**2
    direct2 = (place_m - CORNER_CAMERA_M[0])**2 + CORNER_CAMERA_M[1]**2
    light = CORNER_CAMERA_M[0] / lamp2**1.5 * place_m * y / way2**2 * CORNER_REFLECTANCE / np.pi * area
    delay = np.sqrt(lamp2) + np.sqrt(way2) - np.sqrt(direct2)
    factor = 1 + (light * np.exp(2j * np.pi * f_hz / LIGHT_M_PER_S * delay)).sum() / (CORNER_CAMERA_M[1] / direct2**1.5)
    return np.angle(factor) * LIGHT_M_PER_S / (4 * np.pi * f_hz)


def draw_corner(pen, box):
    """The bent wall of a corner: light that bounced on the other wall comes later."""
    scene = glidar.Scene()
    panel(scene, (0, 0, -1.5), (0, 2, 0), (0, 0, 3), CORNER_REFLECTANCE)
    panel(scene, (0, 0, -1.5), (2, 0, 0), (0, 0, 3), CORNER_REFLECTANCE)
    optics = {"width": 96, "height": 12, "fx": 70, "fy": 600}
    pose = glidar.look_at(CORNER_CAMERA_M, [0.75, 0, 0])
    chart = Chart(pen, box, "a corner: error in mm by the distance from it in m", (0, 1.3), (-20, 130),
                  (0, 0.4, 0.8, 1.2), (0, 40, 80, 120))
    for line, (f_hz, colour) in enumerate(((16e6, (200, 60, 40)), (80e6, (30, 70, 160)), (120e6, (60, 130, 60)))):
        sensor = tof_camera(optics, [f_hz], sub_rays=1, bounces=1, bounce_rays=256)
        frame = glidar.simulate(scene, sensor, pose)
        points = frame.cloud(columns=["xyz"], frame="world")["xyz"].reshape(12, 96, 3)
        truth_m = frame.ground_truth.range_m
        ends = CORNER_CAMERA_M + (points - CORNER_CAMERA_M) * (truth_m / frame.range_m)[..., None]
        places = ends[..., 0].mean(axis=0)
        is_wall = (np.abs(ends[..., 1]) < 1e-3).all(axis=0) & (places > 0.02) & (places < 1.29)
        curve = np.linspace(0.03, 1.28, 90)
        chart.line(curve, [1e3 * corner_error_m(place, f_hz) for place in curve], colour)
        period_m = LIGHT_M_PER_S / (2 * f_hz)
        errors_mm = 1e3 * (np.mod(frame.range_m - truth_m + period_m / 2, period_m) - period_m / 2).mean(axis=0)
        chart.dots(places[is_wall][::2], errors_mm[is_wall][::2], colour, f"{f_hz * 1e-6:.0f} MHz", line, radius=2)


def draw_artefacts(path):
    picture = Image.new("RGB", (900, 300), "white")
    pen = ImageDraw.Draw(picture)
    draw_flying_pixels(pen, (50, 30, 430, 265))
    draw_corner(pen, (500, 30, 880, 265))
    picture.save(path, optimize=True)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    draw_status(folder / "tof-status.png")
    draw_errors(folder / "tof-errors.png")
    draw_artefacts(folder / "tof-artefacts.png")


if __name__ == "__main__":
    main()
