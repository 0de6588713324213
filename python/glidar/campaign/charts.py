# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""SVG charts of the report."""

from html import escape

import numpy as np

WIDTH, HEIGHT = 300, 150
LEFT, RIGHT, TOP, BOTTOM = 44, 8, 8, 22
BINS = 40
MIN_ROWS, MAX_ROWS = 6, 18  # rows of the sphere's cells; there are twice as many columns
TRIALS_PER_CELL = 4  # approximately, within these limits
COLOURS = np.array([[0.267, 0.005, 0.329], [0.229, 0.322, 0.546], [0.128, 0.567, 0.551],
                    [0.369, 0.789, 0.383], [0.993, 0.906, 0.144]])  # matplotlib's viridis
CELL_SIDE = np.array([0.0, 0.25, 0.5, 0.75, 0.9, 1.0])  # vertices along a cell's curved sides
EMPTY = "#e4e7ea"


def colours(fraction):
    """N x 3 bytes of colours for N numbers from 0 to 1."""
    place = np.clip(np.asarray(fraction, float), 0.0, 1.0) * (len(COLOURS) - 1)
    mixed = [np.interp(place, np.arange(len(COLOURS)), channel) for channel in COLOURS.T]
    return np.rint(255.0 * np.stack(mixed, axis=-1)).astype(np.uint8)


def _hex(fraction):
    return "#" + bytes(colours(fraction)).hex()


def _label(x, y, text, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _svg(parts, title, width=WIDTH, height=HEIGHT):
    return (f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
            f'aria-label="{escape(title, quote=True)}">{"".join(parts)}</svg>')


def figure(title, svg, note=""):
    caption = escape(title) + (f"<br><small>{escape(note)}</small>" if note else "")
    return f"<figure>{svg}<figcaption>{caption}</figcaption></figure>"


def _axes(minimum, maximum, top):
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    return [f'<path class="axis" d="M{LEFT} {TOP}V{bottom}H{right}"/>',
            _label(LEFT, HEIGHT - 6, f"{minimum:.4g}", "start"), _label(right, HEIGHT - 6, f"{maximum:.4g}", "end"),
            _label(LEFT - 4, TOP + 8, f"{top:.4g}", "end"), _label(LEFT - 4, bottom, "0", "end")]


def _finite(values):
    """The finite rows, and a note with the number of the others."""
    whole = np.isfinite(values).all(axis=tuple(range(1, values.ndim)))
    left_out = int(np.count_nonzero(~whole))
    return values[whole], f"{left_out} without a value" if left_out else ""


def _nothing(title, note):
    return figure(title, _svg([_label(WIDTH / 2, HEIGHT / 2, "no values")], title), note)


def histogram(title, values):
    """A histogram; values that are not finite are omitted and counted in the note."""
    finite, note = _finite(values)
    if len(finite) == 0:
        return _nothing(title, note)
    minimum, maximum = float(finite.min()), float(finite.max())
    if minimum == maximum:
        text = f"all are {minimum:.6g}"
        return figure(title, _svg([_label(WIDTH / 2, HEIGHT / 2, text)], title), note)
    counts, _ = np.histogram(finite, BINS, (minimum, maximum))
    wide, high = (WIDTH - LEFT - RIGHT) / BINS, HEIGHT - TOP - BOTTOM
    bars = [f'<rect x="{LEFT + i * wide:.2f}" y="{TOP + high * (1 - n / counts.max()):.2f}" '
            f'width="{wide - 0.6:.2f}" height="{high * n / counts.max():.2f}"/>'
            for i, n in enumerate(counts) if n]
    return figure(title, _svg(_axes(minimum, maximum, int(counts.max())) + bars, title), note)


def bars(title, names, counts):
    """A bar chart of the counts of named values."""
    parts, row, maximum = [], 18, max(counts)
    for i, (name, count) in enumerate(zip(names, counts)):
        parts.append(_label(118, 14 + i * row, name[:18], "end"))
        parts.append(f'<rect x="122" y="{4 + i * row}" width="{120 * count / maximum:.1f}" height="12"/>')
        parts.append(_label(126 + 120 * count / maximum, 14 + i * row, str(count), "start"))
    return figure(title, _svg(parts, title, height=max(HEIGHT, row * len(names) + 6)))


def line(title, x, y, note=""):
    """A curve; both axes start at 0."""
    right, bottom = float(x.max()) or 1.0, float(y.max()) or 1.0
    px = LEFT + (WIDTH - LEFT - RIGHT) * x / right
    py = HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * y / bottom
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(px, py))
    return figure(title, _svg(_axes(0, right, bottom) + [f'<polyline points="{points}"/>'], title), note)


def rows_for(trials):
    """The number of rows of cells on the sphere."""
    return int(np.clip(np.sqrt(trials / (2 * TRIALS_PER_CELL)), MIN_ROWS, MAX_ROWS))


def cells_of(directions, rows):
    """The sphere's cells that contain unit vectors: azimuth by sine of elevation, so that cells have equal areas
    (Archimedes)."""
    azimuth = np.arctan2(directions[:, 1], directions[:, 0]) / (2 * np.pi) + 0.5
    column = np.minimum((azimuth * 2 * rows).astype(int), 2 * rows - 1)
    row = np.clip(((directions[:, 2] + 1) / 2 * rows).astype(int), 0, rows - 1)
    return row * 2 * rows + column


def _mollweide(azimuth, sine, radius):
    """Mollweide's equal-area projection (Snyder, "Map projections", USGS 1395, 1987, p. 251)."""
    elevation = np.arcsin(np.clip(sine, -1, 1))
    theta = elevation.copy()
    for _ in range(30):  # Newton: 2 t + sin 2t = pi sin(elevation)
        slope = np.maximum(2 + 2 * np.cos(2 * theta), 1e-9)
        theta -= (2 * theta + np.sin(2 * theta) - np.pi * sine) / slope
    theta = np.where(np.abs(sine) > 1 - 1e-12, np.sign(sine) * np.pi / 2, theta)
    return 2 * azimuth / np.pi * np.cos(theta) * radius, -np.sin(theta) * radius


def sphere(title, directions, note=""):
    """A map of how many directions are in each cell of the sphere; directions that are not finite are omitted and
    counted in the note."""
    directions, left_out = _finite(directions)
    note = ". ".join(filter(None, [note, left_out]))
    if len(directions) == 0:
        return _nothing(title, note)
    rows = rows_for(len(directions))
    counts = np.bincount(cells_of(directions, rows), minlength=2 * rows * rows)
    radius, width, height = 130.0, 540, 280
    parts = []
    for cell, count in enumerate(counts):
        row, column = divmod(cell, 2 * rows)
        a = (np.repeat([0, 1], len(CELL_SIDE)) + column) / rows * np.pi - np.pi
        s = (np.concatenate([CELL_SIDE, CELL_SIDE[::-1]]) + row) / rows * 2 - 1
        x, y = _mollweide(a, s, radius)
        points = " ".join(f"{width / 2 + p:.1f},{height / 2 + q:.1f}" for p, q in zip(x, y))
        fill = _hex(count / counts.max()) if count else EMPTY
        parts.append(f'<polygon points="{points}" fill="{fill}"/>')
    filled = int(np.count_nonzero(counts))
    summary = f"{filled} of {len(counts)} cells of equal area contain a trial; at most {counts.max()} in one cell"
    return figure(title, _svg(parts, title, width, height), f"{summary}. {note}".strip())
