#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the renderers are bit-identical on all models below folders.

usage: PYTHONPATH=build/dev/python build/venv/bin/python scripts/compare_renderers.py FOLDER... [OPTION...]

Each model is seen from around it, from places in its box and from some of its vertices: by a pinhole camera, or by
the presets of --sensors (cameras with lenses, scanners). Footprints and noise are included unless `raster` is among
the renderers, which does not support footprints (`auto` does). Measured range, true range,
instance, triangle and normal of every beam must have the same bits for all renderers. Prints the views that differ, and exits with 1 if
there is one. Files that are no model, or that cannot be read, are counted. At least one view of every sensor must
have hits.
"""

import argparse
import pathlib
import sys

import numpy as np

import glidar

SUFFIXES = {".3ds", ".3mf", ".amf", ".dae", ".fbx", ".glb", ".gltf", ".lwo", ".obj", ".off", ".ply", ".stl", ".x"}
COLUMNS = ("range_m", "instance", "primitive", "normal")


def models_below(folders):
    files = (file for folder in folders for file in sorted(pathlib.Path(folder).rglob("*")))
    return [file for file in files if file.suffix.lower() in SUFFIXES]


def eyes(scene, views, random):
    """Positions of the sensor, by turns outside, inside and on a vertex."""
    low, high = scene.bounds
    middle, size = (low + high) / 2, np.linalg.norm(high - low)
    vertices = scene.objects[0].mesh.vertices
    for k in range(views):
        outward = random.normal(size=3)
        outside = middle + size * random.uniform(0.6, 3.0) * outward / np.linalg.norm(outward)
        inside = low + random.uniform(size=3) * (high - low)
        if k % 3 == 0:
            yield outside
        elif k % 3 == 1 or len(vertices) == 0:
            yield inside
        else:
            yield np.asarray(vertices[random.integers(len(vertices))], dtype=float)


def target(scene, random):
    low, high = scene.bounds
    return low + random.uniform(size=3) * (high - low)


def sensors_of(options):
    """The sensors by their names."""
    if not options.sensors:
        return {"camera": glidar.camera(options.side, options.side, fov_deg=60.0)}
    sensors = {name: glidar.sensor(name) for name in options.sensors}
    if "raster" in options.renderers:
        sensors = {name: sensor.ground_truth() for name, sensor in sensors.items()}
    return sensors


# From the optical frame (z ahead, y down) to that of scanners (x ahead, z up).
OPTICAL_FROM_SCANNER = np.array([[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], dtype=float)


def pose_of(sensor, eye, at):
    """The sensor looks at a point."""
    pose = np.asarray(glidar.look_at(eye, at))
    return pose if sensor.boresight == "z" else pose @ OPTICAL_FROM_SCANNER


def truth_of(scene, sensor, pose, renderer):
    frame = scene.simulator(sensor, renderer=renderer).simulate(pose, columns="all")
    columns = {name: np.ascontiguousarray(getattr(frame.ground_truth, name)) for name in COLUMNS}
    return columns | {"measured_m": np.ascontiguousarray(frame.range_m).reshape(columns["range_m"].size, -1)}


def differing(first, second):
    """Beams of which some column differs in its bits."""
    differs = np.zeros(first["range_m"].size, dtype=bool)
    for name in first:
        a, b = (x[name].reshape(differs.size, -1).view(np.uint8).reshape(differs.size, -1) for x in (first, second))
        differs |= (a != b).any(axis=1)
    return np.flatnonzero(differs)


def compare(file, sensors, options, random, hits):
    """Returns beams compared and beams that differ; adds each sensor's hits to `hits`."""
    scene = glidar.Scene(str(file))
    beams = wrong = 0
    for eye in eyes(scene, options.views, random):
        at = target(scene, random)
        if np.allclose(eye, at):
            continue
        for name, sensor in sensors.items():
            pose = pose_of(sensor, eye, at)
            truths = {renderer: truth_of(scene, sensor, pose, renderer) for renderer in options.renderers}
            reference = options.renderers[0]
            hits[name] += np.isfinite(truths[reference]["range_m"]).sum()
            for renderer in options.renderers[1:]:
                found = differing(truths[reference], truths[renderer])
                beams += truths[reference]["range_m"].size
                wrong += found.size
                if found.size > 0:
                    print(f"{file}: {name}: {reference} and {renderer} differ for {found.size} beams, the first "
                          f"{found[0]}; eye {eye.tolist()}, at {at.tolist()}", flush=True)  # fmt: skip
    return beams, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="FOLDER")
    parser.add_argument("--views", type=int, default=3, help="views of each model")
    parser.add_argument("--side", type=int, default=256, help="pixels of a view's side")
    parser.add_argument("--sensors", nargs="+", metavar="PRESET", help="instead of a pinhole camera")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--renderers", nargs="+", default=["rays", "raster"], help="the first is the reference")
    parser.add_argument("--verbose", action="store_true", help="print why files are not read")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    files = models_below(options.folders)
    sensors = sensors_of(options)
    hits = dict.fromkeys(sensors, 0)
    beams = wrong = unread = 0
    for file in files:
        try:
            more_beams, more_wrong = compare(file, sensors, options, random, hits)
        except glidar.Error as error:
            unread += 1
            if options.verbose:
                print(error)
            continue
        beams += more_beams
        wrong += more_wrong
    print(f"{len(files) - unread} models, {unread} files not read, {beams} comparisons, {wrong} beams differ")
    for name in (name for name, count in hits.items() if count == 0):
        print(f"{name}: no beam hit anything")
    return 1 if wrong > 0 or 0 in hits.values() else 0


if __name__ == "__main__":
    sys.exit(main())
