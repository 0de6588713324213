# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The objects of examples/street.yaml: one small OBJ for each thing that has a class of its own.

Houses and cars look along -y and +x; everything rests on z = 0.
"""

import numpy as np

from .noise import directions, uniforms
from .obj import write_mtl, write_obj
from .shapes import Part, box, cylinder, lathe, placed, rotation, strut

LENGTH = 120.0  # of the street, along x
ROAD, KERB, PAVEMENT, HIGH = 7.6, 0.15, 2.8, 0.12  # widths across, and how high the pavement is
MATERIALS = {
    "asphalt": {"Kd": "0.18 0.18 0.18"}, "marking": {"Kd": "0.80 0.80 0.80"},
    "kerb": {"Kd": "0.50 0.50 0.50"}, "paving": {"Kd": "0.38 0.36 0.34"},
    "plaster": {"Kd": "0.62 0.56 0.48"}, "trim": {"Kd": "0.75 0.75 0.72"},
    "glass": {"Kd": "0.08 0.09 0.10"}, "roof": {"Kd": "0.36 0.16 0.12"},
    "door": {"Kd": "0.22 0.14 0.09"}, "paint": {"Kd": "0.45 0.47 0.50"},
    "rubber": {"Kd": "0.05 0.05 0.05"}, "bark": {"Kd": "0.25 0.19 0.14"},
    "leaf": {"Kd": "0.30 0.40 0.20"}, "steel": {"Kd": "0.42 0.44 0.46"},
    "cloth": {"Kd": "0.35 0.30 0.40"}, "skin": {"Kd": "0.60 0.45 0.36"},
}
SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def polygons(name, corners, material):
    """A part of separate polygons (n, 3 or 4, 3)."""
    corners = np.asarray(corners, dtype=np.float64)
    part = Part(name, corners.reshape(-1, 3))
    count = corners.shape[1]
    for k in range(len(corners)):
        part.add(range(count * k, count * k + count), SQUARE[:count], material)
    return part


def block(name, low, high, material):
    """A box between two corners."""
    low, high = np.array(low), np.array(high)
    return placed(box(name, tuple(high - low), material), 0.5 * (low + high))


def ground():
    """(road, pavements): parts."""
    half, edge = 0.5 * LENGTH, 0.5 * ROAD
    road = [block("road", (-half, -edge, -0.2), (half, edge, 0.0), "asphalt")]
    for k in range(int(LENGTH / 6)):
        x = -half + 6.0 * k + 1.0
        road.append(block(f"marking_{k}", (x, -0.06, 0.0), (x + 3.0, 0.06, 0.003), "marking"))
    walks = []
    for side in (-1.0, 1.0):
        across = sorted((side * edge, side * (edge + KERB)))
        walks.append(block(f"kerb_{side:+.0f}", (-half, across[0], -0.2), (half, across[1], HIGH), "kerb"))
        across = sorted((side * (edge + KERB), side * (edge + KERB + PAVEMENT)))
        walks.append(block(f"pavement_{side:+.0f}", (-half, across[0], -0.2), (half, across[1], HIGH),
                           "paving"))
    return road, walks


def facade(width, heights, columns, door):
    """A wall in the plane y = 0 with recessed windows (and a door in one column); parts.

    heights: (sill, top) of each storey's windows.
    """
    depth, glass = 0.22, 1.15
    pitch = width / columns
    x = np.concatenate([[0.0], *[[pitch * (k + 0.5) - glass / 2, pitch * (k + 0.5) + glass / 2]
                                 for k in range(columns)], [width]]) - width / 2
    z = np.concatenate([[0.0], *heights, [heights[-1][1] + 0.6]])
    walls, panes, doors = [], [], []

    def upright(x0, x1, z0, z1, y):
        return [(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)]

    for i in range(len(x) - 1):
        for j in range(len(z) - 1):
            is_door = i == 2 * door + 1 and j <= 1
            if not (is_door or (i % 2 == 1 and j % 2 == 1)):
                walls.append(upright(x[i], x[i + 1], z[j], z[j + 1], 0.0))
                continue
            x0, x1, z0, z1 = x[i], x[i + 1], z[j], z[j + 1]
            (doors if is_door else panes).append(upright(x0, x1, z0, z1, depth))
            walls += [[(x0, 0, z0), (x0, depth, z0), (x0, depth, z1), (x0, 0, z1)],
                      [(x1, depth, z0), (x1, 0, z0), (x1, 0, z1), (x1, depth, z1)],
                      [(x0, 0, z0), (x1, 0, z0), (x1, depth, z0), (x0, depth, z0)],
                      [(x0, depth, z1), (x1, depth, z1), (x1, 0, z1), (x0, 0, z1)]]
    sills = [block(f"sill_{k}_{j}", (x[2 * k + 1] - 0.08, -0.12, sill - 0.08),
                   (x[2 * k + 2] + 0.08, 0.02, sill), "trim")
             for j, (sill, _) in enumerate(heights) for k in range(columns) if j > 0 or k != door]
    return [polygons("wall", walls, "plaster"), polygons("panes", panes, "glass"),
            polygons("door", doors, "door"), *sills]


def house(width, storeys, columns, depth=9.0):
    """A house with a gabled roof whose ridge is along the street; its front is at y = 0."""
    heights = [(0.9 + 2.9 * k, 2.4 + 2.9 * k) for k in range(storeys)]
    top, ridge = heights[-1][1] + 0.6, heights[-1][1] + 0.6 + 0.38 * depth
    parts = facade(width, heights, columns, columns // 2)
    x, middle = width / 2, depth / 2
    sides = [[(-x, depth, 0), (-x, 0, 0), (-x, 0, top), (-x, depth, top)],
             [(x, 0, 0), (x, depth, 0), (x, depth, top), (x, 0, top)],
             [(x, depth, 0), (-x, depth, 0), (-x, depth, top), (x, depth, top)]]
    gables = [[(-x, depth, top), (-x, 0, top), (-x, middle, ridge)],
              [(x, 0, top), (x, depth, top), (x, middle, ridge)]]
    eave, drop = 0.45, 0.45 * (ridge - top) / middle
    roof = [[(-x, -eave, top - drop), (x, -eave, top - drop), (x, middle, ridge), (-x, middle, ridge)],
            [(x, depth + eave, top - drop), (-x, depth + eave, top - drop), (-x, middle, ridge),
             (x, middle, ridge)]]
    return [*parts, polygons("sides", sides, "plaster"), polygons("gables", gables, "plaster"),
            polygons("roof", roof, "roof"),
            block("chimney", (0.2 * width, middle + 0.6, ridge - 1.2), (0.2 * width + 0.6, middle + 1.3,
                                                                     ridge + 0.7), "plaster"),
            block("step", (-0.8, -0.5, 0.0), (0.8, 0.0, 0.16), "kerb")]


def extruded(name, outline, half_width, taper, material):
    """A closed outline in x and z drawn out along y, its corners above z = 0.95 moved in by taper."""
    outline = np.asarray(outline)
    half = np.where(outline[:, 1] > 0.95, half_width - taper, half_width)
    left = np.column_stack([outline[:, 0], half, outline[:, 1]])
    right = left * (1.0, -1.0, 1.0)
    around = [(right[k], right[(k + 1) % len(outline)], left[(k + 1) % len(outline)], left[k])
              for k in range(len(outline))]
    middle = outline.mean(axis=0)
    centre = np.array([middle[0], half_width, middle[1]])
    caps = []
    for k in range(len(outline)):
        n = (k + 1) % len(outline)
        caps += [(left[k], left[n], centre),
                 (right[n], right[k], centre * (1.0, -1.0, 1.0))]
    return [polygons(f"{name}_around", around, material), polygons(f"{name}_sides", caps, material)]


def car():
    """A hatchback, 4.2 m long."""
    body = [(2.1, 0.35), (2.08, 0.72), (1.15, 0.92), (-2.0, 0.95), (-2.1, 0.6), (-2.05, 0.32)]
    cabin = [(1.0, 0.90), (0.35, 1.43), (-1.35, 1.47), (-1.95, 0.93)]
    parts = extruded("body", body[::-1], 0.88, 0.0, "paint") + extruded("cabin", cabin[::-1], 0.80, 0.14, "glass")
    for x in (1.32, -1.28):
        for y in (-0.90, 0.70):
            wheel = placed(cylinder("wheel", 0.32, 0.2, 16, "rubber"), turn=rotation(0, -90.0))
            parts.append(placed(wheel, (x, y, 0.32)))
    for y in (-0.98, 0.88):
        parts.append(block("mirror", (0.75, y, 0.92), (0.9, y + 0.1, 1.05), "paint"))
    return parts


def tree(seed=3, leaves=620):
    """A trunk, branches and leaves as small squares, through which beams find their way."""
    profile = [(0.0, 0.0), (0.19, 0.0), (0.14, 0.6), (0.11, 2.4), (0.05, 4.4), (0.0, 4.6)]
    parts = [lathe("trunk", profile, 10, "bark")]
    for k in range(6):
        a = 2.0 * np.pi * (k / 6 + 0.07 * (k % 2))
        end = (1.2 * np.cos(a), 1.2 * np.sin(a), 3.9 + 0.25 * (k % 3))
        parts.append(strut(f"branch_{k}", (0, 0, 2.3 + 0.25 * (k % 3)), end, 0.035, "bark", 6))
    place = directions(seed, leaves) * np.cbrt(0.35 + 0.65 * uniforms(seed + 1, leaves))[:, None]
    lumps = 1.0 + 0.22 * np.sin(4.0 * place[:, 0] + 1.0) * np.cos(5.0 * place[:, 1])
    middle = place * lumps[:, None] * (1.9, 1.9, 1.75) + (0.0, 0.0, 4.5)
    u = np.cross(directions(seed + 2, leaves), directions(seed + 3, leaves))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(u, directions(seed + 4, leaves))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    size = 0.12 + 0.08 * uniforms(seed + 5, leaves)[:, None]
    u, v = u * size, v * size
    corners = np.stack([middle - u - v, middle + u - v, middle + u + v, middle - u + v], axis=1)
    return [*parts, polygons("leaves", corners, "leaf")]


def lamp():
    """A street light, its arm towards -y."""
    return [lathe("post", [(0.0, 0.0), (0.11, 0.0), (0.10, 0.9), (0.06, 1.0), (0.045, 6.2), (0.0, 6.25)], 10,
                  "steel"),
            strut("arm", (0, 0.05, 6.1), (0, -1.5, 6.45), 0.035, "steel"),
            block("head", (-0.14, -2.1, 6.40), (0.14, -1.4, 6.52), "steel")]


def person():
    """Somebody who walks along +x, 1.75 m tall."""
    parts = [lathe("torso", [(0.0, 0.82), (0.16, 0.84), (0.19, 1.2), (0.20, 1.38), (0.08, 1.50), (0.0, 1.51)], 12,
                   "cloth"),
             lathe("head", [(0.0, 1.48), (0.06, 1.50), (0.10, 1.60), (0.10, 1.67), (0.07, 1.74), (0.0, 1.76)], 12,
                   "skin")]
    for side, ahead in ((0.09, 0.24), (-0.09, -0.22)):
        parts.append(strut("leg", (ahead, side, 0.0), (0.0, side, 0.86), 0.075, "cloth", 8))
        parts.append(strut("arm", (-0.8 * ahead, 2.6 * side, 0.85), (0.0, 2.3 * side, 1.40), 0.045, "cloth", 8))
        parts.append(block("shoe", (ahead - 0.08, side - 0.05, 0.0), (ahead + 0.18, side + 0.05, 0.08), "rubber"))
    return parts


def make_street(folder):
    """Writes folder/*.obj and the one .mtl that they share."""
    comment = ["GLIDAR street, made by scripts/make_models.py; metres; z up",
               "SPDX-FileCopyrightText: 2026 The GLIDAR developers",
               "SPDX-License-Identifier: BSD-3-Clause"]
    road, pavements = ground()
    things = {"road": road, "pavement": pavements, "house": house(11.0, 2, 4), "tall_house": house(14.0, 3, 5),
              "car": car(), "tree": tree(), "lamp": lamp(), "person": person()}
    for name, parts in things.items():
        write_obj(folder / f"{name}.obj", parts, comment, "street.mtl")
    write_mtl(folder / "street.mtl", MATERIALS, comment)
