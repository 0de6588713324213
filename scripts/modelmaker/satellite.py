# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The satellite: a foil-wrapped bus with two solar wings, a dish, instruments and thrusters.

Body axes, origin in the middle of the bus: x forward (instruments), y left, z up (dish).
"""

import numpy as np

from .obj import write_mtl, write_obj
from .satellite_textures import write_textures
from .shapes import box, cylinder, disc, lathe, placed, rotation, strut, tube, wrinkled

BUS_M = (1.2, 1.0, 1.0)
PANEL_M = (1.10, 0.80, 0.022)
FOIL_REPEATS_PER_M = 2.0
WIRE_REPEATS_PER_M = 14.0
BACKWARD = rotation(1, -90.0)  # turns +z to -x
FORWARD = rotation(1, 90.0)
DOWN = rotation(0, 180.0)


def material(diffuse, specular, shininess, **maps):
    """Statements of one material; ambient is taken equal to diffuse."""
    def colour(rgb):
        return " ".join(f"{value:g}" for value in rgb)
    return {"Ka": colour(diffuse), "Kd": colour(diffuse), "Ks": colour(specular),
            "Ns": f"{shininess:g}", "d": "1", "illum": "2", **maps}


MATERIALS = {
    "gold_foil": material((0.83, 0.58, 0.20), (0.90, 0.70, 0.35), 40,
                          map_Kd="foil.png", norm="foil_normals.png"),
    "solar_cells": material((1, 1, 1), (0.7, 0.7, 0.8), 90, map_Kd="cells.png",
                            map_Ks="cells_gloss.png", norm="cells_normals.png"),
    "panel_back": material((0.22, 0.22, 0.23), (0.25, 0.25, 0.25), 20,
                           map_bump="weave_height.png"),
    "white_paint": material((0.86, 0.86, 0.84), (0.10, 0.10, 0.10), 12),
    "aluminium": material((0.55, 0.56, 0.58), (0.50, 0.50, 0.50), 50),
    "black_paint": material((0.04, 0.04, 0.04), (0.05, 0.05, 0.05), 8),
    "radiator": material((0.75, 0.77, 0.80), (0.80, 0.80, 0.80), 110, map_Kd="radiator.png"),
    "nozzle": material((0.24, 0.20, 0.18), (0.45, 0.38, 0.32), 30),
    "lens": material((0.05, 0.04, 0.10), (0.90, 0.90, 1.00), 120),
    "wire_mesh": material((0.72, 0.60, 0.38), (0.30, 0.25, 0.15), 25, map_d="wire_mesh.png"),
    "copper": material((0.70, 0.42, 0.26), (0.50, 0.35, 0.25), 40),
}


def bus():
    body = box("bus", BUS_M, "gold_foil", FOIL_REPEATS_PER_M, cells=11)
    parts = [wrinkled(body, BUS_M, 0.045, 0.004, 0.009, 5)]
    for name, y in (("left", 0.512), ("right", -0.512)):
        plate = box(f"radiator_{name}", (0.72, 0.02, 0.34), "radiator", 10.0)
        parts.append(placed(plate, (0.05, y, -0.26)))
    for name, size, paint, place in (
            ("service_panel", (0.012, 0.34, 0.22), "aluminium", (-0.61, 0.0, 0.36)),
            ("electronics", (0.30, 0.22, 0.10), "black_paint", (-0.32, 0.27, 0.55)),
            ("patch_antenna", (0.14, 0.14, 0.03), "white_paint", (0.42, 0.34, 0.522))):
        parts.append(placed(box(name, size, paint), place))
    for name, side in (("left", 1), ("right", -1)):
        start, end = (-0.5, 0.42 * side, 0.48), (-0.78, 0.62 * side, 0.98)
        parts.append(strut(f"whip_{name}", start, end, 0.006, "aluminium"))
    return parts


def wing(name):
    """One wing along +y: drive, yoke and three panels with their cells up."""
    tilt = rotation(1, 22.0)
    parts = [cylinder(f"{name}_drive", 0.07, 0.13, 24, "aluminium")]
    placed(parts[0], (0.0, 0.49, 0.0), rotation(0, -90.0))
    for side, x in (("a", 0.36), ("b", -0.36)):
        parts.append(strut(f"{name}_yoke_{side}", (0.0, 0.59, 0.0), (x, 0.96, 0.0), 0.016,
                           "aluminium"))
    parts.append(strut(f"{name}_yoke_bar", (-0.42, 0.96, 0.0), (0.42, 0.96, 0.0), 0.018,
                       "aluminium"))
    faces = ["aluminium"] * 4 + ["solar_cells", "panel_back"]
    for n in range(3):
        y = 0.98 + n * (PANEL_M[1] + 0.03)
        panel = box(f"{name}_panel_{n + 1}", PANEL_M, faces, (None,) * 5 + (8.0,))
        parts.append(placed(panel, (0.0, y + PANEL_M[1] / 2.0, 0.0)))
        for side, x in (("a", 0.36), ("b", -0.36)):
            hinge = cylinder(f"{name}_hinge_{n + 1}{side}", 0.017, 0.10, 8, "aluminium")
            parts.append(placed(hinge, (x - 0.05, y - 0.015, -0.012), FORWARD))
    return [placed(part, turn=tilt) for part in parts]


def dish():
    """A parabolic reflector on a mast, with a feed horn on three struts in its focus."""
    focus, radius, thickness = 0.30, 0.47, 0.012
    r = radius * np.linspace(0.0, 1.0, 9)
    back = [(a, a * a / (4.0 * focus) - thickness) for a in r]
    front = [(a, a * a / (4.0 * focus)) for a in r[::-1]]
    parts = [lathe("dish", back + front, 40, "white_paint")]
    hub = [(0.0, -0.16), (0.05, -0.16), (0.05, -0.10), (0.13, -0.03), (0.13, 0.001), (0.0, 0.001)]
    parts.append(lathe("dish_hub", hub, 24, "aluminium"))
    horn = [(0.028, focus - 0.03), (0.06, focus - 0.05), (0.066, focus - 0.05),
            (0.036, focus - 0.01), (0.036, focus + 0.07), (0.0, focus + 0.07)]
    inside = [(0.0, focus - 0.03)]
    parts.append(lathe("feed_horn", inside + horn, 24, ["black_paint"] * 2 + ["aluminium"] * 4))
    rim = radius * radius / (4.0 * focus)
    for k in range(3):
        a = np.radians(30.0 + 120.0 * k)
        start = (0.97 * radius * np.cos(a), 0.97 * radius * np.sin(a), 0.94 * rim)
        end = (0.03 * np.cos(a), 0.03 * np.sin(a), focus + 0.05)
        parts.append(strut(f"feed_strut_{k + 1}", start, end, 0.009, "white_paint"))
    parts = [placed(part, (-0.02, 0.0, 0.80), rotation(1, 24.0)) for part in parts]
    parts.append(strut("dish_mast", (-0.08, 0.0, 0.48), (-0.08, 0.0, 0.67), 0.045, "aluminium", 24))
    parts.append(placed(box("dish_gimbal", (0.13, 0.16, 0.10), "black_paint"), (-0.08, 0.0, 0.66)))
    return parts


def propulsion():
    """Docking ring and main engine behind; four pods of attitude thrusters."""
    ring = [(0.34, 0.0), (0.40, 0.0), (0.40, 0.05), (0.38, 0.05), (0.38, 0.09), (0.41, 0.09),
            (0.41, 0.11), (0.34, 0.11)]
    parts = [lathe("docking_ring", ring, 48, "aluminium")]
    s = np.linspace(0.0, 1.0, 7)
    bell = [(0.035 + 0.115 * a**0.62, 0.06 + 0.24 * a) for a in s]
    outside = [(0.0, 0.0), (0.06, 0.0), (0.06, 0.03)] + bell
    inside = [(a - 0.006, z + (0.004 if z < 0.29 else 0.0)) for a, z in bell[::-1]]
    inside += [(0.0, inside[-1][1])]
    parts.append(lathe("engine", outside + inside, 32,
                       ["nozzle"] * len(outside) + ["black_paint"] * (len(inside) - 1)))
    parts = [placed(part, (-0.59, 0.0, 0.0), BACKWARD) for part in parts]
    for k, (y, z) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        place = np.array([-0.615, 0.42 * y, 0.42 * z])
        pod = box(f"thruster_pod_{k + 1}", (0.07, 0.09, 0.09), "aluminium")
        parts.append(placed(pod, place))
        cone = [(0.0, 0.0), (0.012, 0.0), (0.028, 0.055), (0.024, 0.055), (0.008, 0.006),
                (0.0, 0.006)]
        turns = (BACKWARD, rotation(0, -90.0 * y), rotation(0, 0.0 if z > 0 else 180.0))
        axes = ((-1, 0, 0), (0, y, 0), (0, 0, z))
        for letter, turn, axis in zip("abc", turns, axes, strict=True):
            jet = lathe(f"thruster_{k + 1}{letter}", cone, 10, "nozzle")
            offset = np.array(axis) * np.array((0.034, 0.044, 0.044))
            parts.append(placed(jet, place + offset, turn))
    return parts


def baffle(name, radius_m, flare_m, length_m, place, turn):
    """A light shade, white outside, black inside, with a lens at its bottom."""
    wall, lens = 0.008, 0.25 * length_m
    shade = [(0.0, 0.0), (radius_m, 0.0), (radius_m + flare_m, length_m),
             (radius_m + flare_m - wall, length_m), (radius_m - wall, lens), (0.0, lens)]
    glass = [(0.0, 0.0), (radius_m - 0.02, 0.0), (radius_m - 0.02, 0.004),
             (0.55 * radius_m, 0.014), (0.0, 0.018)]
    parts = [lathe(name, shade, 28, ["white_paint"] * 3 + ["black_paint"] * 2)]
    parts.append(placed(lathe(f"{name}_lens", glass, 28, "lens"), (0.0, 0.0, lens)))
    return [placed(part, place, turn) for part in parts]


def instruments():
    parts = baffle("telescope", 0.17, 0.0, 0.34, (0.58, 0.20, 0.12), FORWARD)
    tilted = rotation(2, 38.0) @ rotation(1, 52.0)
    parts += baffle("star_tracker_1", 0.045, 0.035, 0.17, (0.40, -0.28, 0.49), tilted)
    tilted = rotation(2, -60.0) @ rotation(1, 52.0)
    parts += baffle("star_tracker_2", 0.045, 0.035, 0.17, (0.26, -0.38, 0.49), tilted)
    parts.append(placed(box("lidar", (0.16, 0.26, 0.22), "white_paint"), (0.66, -0.24, 0.14)))
    for name, y in (("out", -0.305), ("in", -0.185)):
        window = cylinder(f"lidar_window_{name}", 0.042, 0.012, 24, ["black_paint"] * 2 + ["lens"])
        parts.append(placed(window, (0.738, y, 0.14), FORWARD))
    radar = box("radar_altimeter", (0.05, 0.42, 0.20), "aluminium")
    parts.append(placed(radar, (0.62, 0.0, -0.28)))
    for k in range(3):
        patch = box(f"radar_patch_{k + 1}", (0.012, 0.11, 0.15), "copper")
        parts.append(placed(patch, (0.65, -0.135 + 0.135 * k, -0.28)))
    return parts


def helix_antenna():
    """A helix over a reflector of wire mesh, whose openings let rays through."""
    turns = 2.0 * np.pi * np.linspace(0.0, 5.5, 5 * 14 + 8)
    path = np.stack([0.085 * np.cos(turns), 0.085 * np.sin(turns), 0.015 + 0.0135 * turns], -1)
    parts = [tube("helix", path, 0.007, 6, "copper"),
             disc("helix_reflector", 0.27, 40, "wire_mesh", WIRE_REPEATS_PER_M),
             lathe("helix_rim", [(0.265, -0.008), (0.28, -0.008), (0.28, 0.008), (0.265, 0.008)],
                   40, "aluminium"),
             strut("helix_mast", (0, 0, -0.15), (0, 0, 0.47), 0.013, "white_paint", 12)]
    for k in range(4):
        a = np.radians(45.0 + 90.0 * k)
        end = (0.27 * np.cos(a), 0.27 * np.sin(a), 0.0)
        parts.append(strut(f"helix_stay_{k + 1}", (0, 0, -0.10), end, 0.006, "aluminium", 8))
    return [placed(part, (0.16, 0.0, -0.62), DOWN) for part in parts]


def all_parts():
    left, right = wing("left_wing"), wing("right_wing")
    # A half turn about z keeps the cells up; the wing's tilt must be undone on both sides of it.
    right = [placed(part, turn=rotation(1, 44.0) @ rotation(2, 180.0)) for part in right]
    return (bus() + left + right + dish() + propulsion() + instruments() + helix_antenna())


def make_satellite(folder):
    """Writes folder/satellite.obj, its materials and textures."""
    comment = ["GLIDAR satellite, made by scripts/make_models.py; metres; x forward, y left, z up",
               "SPDX-FileCopyrightText: 2026 The GLIDAR developers",
               "SPDX-License-Identifier: BSD-3-Clause"]
    write_obj(folder / "satellite.obj", all_parts(), comment)
    write_mtl(folder / "satellite.mtl", MATERIALS, comment)
    write_textures(folder)
