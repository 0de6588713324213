#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/echoes.png: what glidar's pulsed light, footprints and receivers do (circles)
against their laws in echoes.md (lines).

usage: plot_echoes.py GLIDAR_PROGRAM PICTURE.png
"""

import math
import subprocess
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Callable

import numpy as np

from plot_noise import COLOURS, PANEL, Panel, deviation_percent, plot

SIGMA_M = 299792458.0 / 2 * 5e-9 / 2.3548200450309493  # of a pulse of 5 ns, along the range
REACH_M = 200  # of planes, to either side
APART_M = 2 * SIGMA_M  # c FWHM / 2.355
STRONG = "{reference_reflectance: 1, reference_range_m: 1e5}"  # far above the threshold
LINE = "{width: 1, height: 1, fx: 1e6, fy: 1e6}"


class Stage:
    """Shots of the program along z at planes across it."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder

    def shoot(self, planes, optics, light, more="", surface="{type: lambert}", seed=1):
        """Columns of a camera at the origin. A plane is (distance, edge: it is where x
        is above, tilt in radians about y)."""
        models = "".join(
            f"  - {{model: 'builtin:plane', scale: {REACH_M}, pose: {{position: [{edge + REACH_M * math.cos(tilt)!r}"
            f", 0, {z + REACH_M * math.sin(tilt)!r}], euler_deg: {{roll: 180, pitch: {-math.degrees(tilt)!r}}}}}, "
            f"materials: {{'*': {{diffuse: [1, 1, 1], backscatter: {surface}}}}}}}\n"
            for z, edge, tilt in planes)
        (self.folder / "scene.yaml").write_text(
            f"models:\n{models}sensor: sensor.yaml\nsensor_pose: {{position: [0, 0, 0]}}\n",
            encoding="utf-8")
        (self.folder / "sensor.yaml").write_text(
            f"optics: {optics}\nlidar_equation: {light}\n{more}\n", encoding="utf-8")
        subprocess.run(
            [self.program, "render", "scene.yaml", "--quiet", "--no-sidecar", "--seed", str(seed),
             "--columns", "range,true_range,intensity,azimuth,status", "-o", "cloud.npz"],
            cwd=self.folder, check=True)
        return {name: column.ravel() for name, column in np.load(self.folder / "cloud.npz").items()}

    def wall(self, z, light=STRONG, more="", **rest):
        """A plane that goes through the boresight at z and reaches to both sides."""
        return self.shoot([(z, -REACH_M, 0.0)], rest.pop("optics", LINE), light, more, **rest)


def beam(divergence_mrad, exit_mm=0, rings=8):
    return f"footprint: {{divergence_mrad: {divergence_mrad}, exit_mm: {exit_mm}, rings: {rings}}}\n"


def lit_law(place):
    """Lit part of a Gaussian beam; the edge's place in units of the 1/e^2 radius."""
    return 0.5 * (1 + math.erf(math.sqrt(2) * place))


def knife(stage, z, width_m, footprint):
    """Lit part of the beams of a line of pixels against their places before an edge, in metres."""
    pixels = 801
    focal_px = pixels * z / (1.8 * width_m)
    optics = f"{{width: {pixels}, height: 1, fx: {focal_px!r}, fy: {focal_px!r}}}"
    cloud = stage.shoot([(z, 0.0, 0.0)], optics, STRONG, footprint)
    places = -z * np.tan(cloud["azimuth"])
    order = np.argsort(places)
    return places[order], np.nan_to_num(cloud["intensity"][order].astype(float)) * (z / 1e5) ** 2


def width_mm(divergence_mrad, exit_mm):
    """Four standard deviations of the light across a beam, which is the width at 1/e^2."""
    def measure(stage, z):
        width_m = math.hypot(1e-3 * exit_mm, 1e-3 * divergence_mrad * z)
        places, lit = knife(stage, z, width_m, beam(divergence_mrad, exit_mm))
        middle = 0.5 * (places[1:] + places[:-1])
        return 4e3 * math.sqrt(float(np.sum(np.diff(lit) * middle ** 2)))
    return measure


def lit_part(rings):
    def measure(stage, place):
        places, lit = knife(stage, 50.0, 0.2, beam(4, 0, rings))
        return float(np.interp(0.1 * place, places, lit))
    return measure


def two_planes(stage, place, apart_m, receiver, rings=8):
    """Reported ranges of a beam with an edge between planes at 50 m and behind at a given position."""
    cloud = stage.shoot([(50.0, -0.1 * place, 0.0), (50.0 + apart_m, -REACH_M, 0.0)], LINE, STRONG,
                        beam(4, 0, rings) + f"receiver: {{pulse_ns: 5, {receiver}}}")
    return cloud["range"] - 50.0


def mixed(stage, place):
    return 1e3 * float(two_planes(stage, place, 0.3, "returns: [strongest]")[0])


def reported_as(which):
    return lambda stage, place: float(two_planes(stage, place, 2.0, f"returns: [{which}]")[0])


def separate_ranges(separation_m):
    """How far from each other the first and last returns are; 0: there is one."""
    def measure(stage, apart_m):
        measured = two_planes(stage, -0.02, apart_m,
                             f"min_return_separation_m: {separation_m}, returns: [first, last]")
        return float(measured[1] - measured[0]) if np.isfinite(measured[1]) else 0.0
    return measure


def light_of(signal, z=10.0):
    return f"{{reference_reflectance: 1, reference_range_m: {z * math.sqrt(signal)!r}}}"


def walk_mm(stage, decades):
    cloud = stage.wall(10.0, light_of(10.0 ** decades),
                       "receiver: {pulse_ns: 5, timing: leading_edge}")
    return 1e3 * float(cloud["range"][0] - cloud["true_range"][0])


def echo_sigma(stage, tilt_deg):
    """Of a beam of 20 mrad on a tilted plane at 50 m, from its walk."""
    cloud = stage.shoot(tilted(math.radians(tilt_deg)), LINE, STRONG,
                        beam(20) + "receiver: {pulse_ns: 5, timing: leading_edge}")
    walk = 50.0 - float(cloud["range"][0])
    return walk / math.sqrt(2 * math.log(float(cloud["intensity"][0])))


def tilted(tilt):
    """A plane that goes through (0, 0, 50 m), by where its middle is REACH_M away from its edge."""
    return [(50 - REACH_M * math.sin(tilt), -REACH_M * math.cos(tilt), tilt)]


def signal_decades(light):
    return lambda stage, z: math.log10(float(stage.wall(z, light)["intensity"][0]))


def backscatter(surface):
    """Relative to a white diffuse surface at normal incidence."""
    def measure(stage, tilt_deg):
        cloud = stage.shoot(tilted(math.radians(tilt_deg)), LINE, STRONG, surface=surface)
        return float(cloud["intensity"][0]) * (50 / 1e5) ** 2
    return measure


def retro_decades(stage, tilt_deg):
    return math.log10(backscatter("{type: retro, gain: 300, width_deg: 30}")(stage, tilt_deg))


def share_seen(sigma):
    light = f"{{reference_reflectance: 1, reference_range_m: 100, noise_sigma: {sigma}}}"
    return lambda stage, z: float((stage.wall(
        z, light, optics="{width: 200, height: 100, fx: 1e6, fy: 1e6}")["status"] == 0).mean())


def seen_law(sigma):
    return lambda z: 0.5 * math.erfc((1 - (100 / z) ** 2) / (sigma * math.sqrt(2)))


def phong_law(deg):
    return 0.6 * math.cos(math.radians(deg)) + 0.4 * abs(math.cos(math.radians(2 * deg))) ** 20


def oren_nayar_law(deg):
    s, cosine = math.radians(30) ** 2, math.cos(math.radians(deg))
    return (1 - 0.5 * s / (s + 0.33)) * cosine + 0.45 * s / (s + 0.09) * (1 - cosine * cosine)


def glossy_law(deg):
    return 0.05 * math.cos(math.radians(deg)) + 2 * math.exp(-0.5 * (deg / 10) ** 2)


def mixed_law(place):
    far = (50 / 50.3) ** 2 * (1 - lit_law(place))
    return 1e3 * 0.3 * far / (far + lit_law(place))


@dataclass
class Series:
    name: str
    measure: Callable  # of stage and place
    law: Callable  # of place


@dataclass
class Case:
    title: str
    what: str  # the vertical axis
    unit: str  # of the horizontal axis
    places: list
    series: list


PLACES = [-1.1 + 0.2 * k for k in range(12)]
APART = [0.1, 0.25, 0.4, 0.55, 0.61, 0.68, 0.78, 0.9, 0.98, 1.05, 1.2, 1.4]
DEGREES = [0, 10, 20, 30, 40, 50, 60, 70, 80]
FAR = [20, 45, 70, 85, 95, 100, 105, 115, 130, 150]

CASES = [
    Case("width of a beam", "4 sigma, mm", "range, m",
         [1, 5, 10, 20, 35, 50, 70, 100],
         [Series("3 mrad, exit 9.5 mm", width_mm(3, 9.5), lambda z: math.hypot(9.5, 3 * z)),
          Series("1 mrad, exit 40 mm", width_mm(1, 40), lambda z: math.hypot(40, z))]),
    Case("lit part of a beam at an edge", "share of the signal", "edge / w", PLACES,
         [Series("217 sub-rays", lit_part(8), lit_law), Series("7 sub-rays", lit_part(1), lit_law)]),
    Case("mixed: planes 0.3 m apart", "reported behind the front one, mm", "edge / w", PLACES,
         [Series("217 sub-rays", mixed, mixed_law)]),
    Case("two halves, pulse of 5 ns", "separation of reported echoes, m", "apart, m", APART,
         [Series("as the pulse can", separate_ranges(0), lambda x: x * (x > APART_M)),
          Series("min_return_separation_m: 1", separate_ranges(1), lambda x: x * (x > 1))]),
    Case("returns, planes 2 m apart", "reported behind the front one, m", "edge / w", PLACES,
         [Series("last", reported_as("last"), lambda x: 2.0),
          Series("strongest", reported_as("strongest"),
                 lambda x: 2.0 * ((50 / 52) ** 2 * (1 - lit_law(x)) > lit_law(x))),
          Series("first", reported_as("first"), lambda x: 0.0)]),
    Case("range walk, leading edge, 5 ns", "reported - true, mm", "log10 of S", [0, 0.1, 0.3, 0.6, 1, 1.5, 2, 3, 4],
         [Series("", walk_mm, lambda d: -1e3 * SIGMA_M * math.sqrt(2 * d * math.log(10)))]),
    Case("echo on a tilted plane", "sigma, m; 20 mrad at 50 m", "tilt, deg", DEGREES[:-1],
         [Series("", echo_sigma,
                 lambda t: math.hypot(SIGMA_M, 50 * 0.005 * math.tan(math.radians(t))))]),
    Case("range equation", "log10 of S", "range, m", [10, 20, 35, 50, 70, 100, 140, 180],
         [Series("q = 2", signal_decades("{reference_reflectance: 0.01, reference_range_m: 100}"),
                 lambda z: math.log10(100 * (100 / z) ** 2)),
          Series("q = 2.67, 0.005/m", signal_decades(
              "{reference_reflectance: 0.01, reference_range_m: 100, range_exponent: 2.67, "
              "extinction_per_m: 0.005}"),
                 lambda z: math.log10(100 * (100 / z) ** 2.67 * math.exp(-0.01 * (z - 100)))),
          Series("overlap", signal_decades(
              "{reference_reflectance: 0.01, reference_range_m: 100, overlap: [[0, 0], [50, 1]]}"),
                 lambda z: math.log10(100 * (100 / z) ** 2 * min(1, z / 50)))]),
    Case("backscatter", "over white diffuse, normal incidence", "incidence, deg", DEGREES,
         [Series("lambert", backscatter("{type: lambert}"), lambda t: math.cos(math.radians(t))),
          Series("oren_nayar, 30 deg", backscatter("{type: oren_nayar, roughness_deg: 30}"),
                 oren_nayar_law),
          Series("phong, 0.4, 20", backscatter("{type: phong, specular_fraction: 0.4, exponent: 20}"),
                 phong_law)]),
    Case("backscatter: glossy, 10 deg", "over white diffuse, normal incidence", "incidence, deg", DEGREES,
         [Series("", backscatter("{type: glossy, diffuse_fraction: 0.05, lobe_gain: 2, width_deg: 10}"),
                 glossy_law)]),
    Case("backscatter: retro, 30 deg", "log10 over white diffuse", "incidence, deg", DEGREES,
         [Series("", retro_decades, lambda t: math.log10(300) - (t / 30) ** 2 / math.log(10))]),
    Case("detection", "share of pulses seen", "range, m", FAR,
         [Series("noise_sigma 0.33", share_seen(0.33), seen_law(0.33)),
          Series("noise_sigma 0.1", share_seen(0.1), seen_law(0.1))]),
]


def draw_case(stage, draw, corner, case):
    """All series of a case on the axes that hold them."""
    curves = []
    for series in case.series:
        points = [(x, series.measure(stage, x)) for x in case.places]
        print(f"{case.title}, {series.name}: within {deviation_percent(case, series.law, points):.2f} % of the law's "
              "largest value")
        curves.append(Panel(draw, corner, SimpleNamespace(**{**case.__dict__, "law": series.law}), points))
    low, high = min(c.y0 for c in curves), max(c.y1 for c in curves)
    for k, (curve, series) in enumerate(zip(curves, case.series)):
        curve.y0, curve.y1 = low, high
        if k == 0:
            curve.frame()
        curve.curve(COLOURS[k], COLOURS[k])
        draw.text((corner[0] + PANEL[0] - 8 - 6 * len(series.name), corner[1] + 4 + 11 * k),
                  series.name, fill=COLOURS[k])


if __name__ == "__main__":
    plot(__doc__, Stage, CASES, draw_case)
