#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/packets.png: a scan that Ouster's SDK decodes from a capture of GLIDAR, as the sensor's own viewer
shows it, and the cloud seen from above.

usage: plot_packets.py GLIDAR_PROGRAM PICTURE.png, by a Python that has ouster-sdk and Matplotlib
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from ouster.sdk import core, open_source

FIELDS = ((core.ChanField.RANGE, "range", "viridis"), (core.ChanField.REFLECTIVITY, "reflectivity", "gray"),
          (core.ChanField.SIGNAL, "signal", "gray"))
SHOWN_PERCENTILES = (1, 97)  # a few very near or bright returns would leave the rest dark


def decoded_scan(program, folder):
    """The first complete scan of a capture of a street, and its points in metres."""
    capture = folder / "street.pcap"
    subprocess.run([program, "render", "examples/street.yaml", "--sensor", "OS1-128", "--duration", "0.2", "--quiet",
                    "-o", str(capture)], check=True)
    source = open_source(str(capture))
    scan = next(iter(source))[0]  # of the only sensor
    info = source.sensor_info[0]
    return info, scan, core.XYZLut(info)(scan)


def draw(info, scan, points, picture):
    figure, axes = plt.subplots(4, 1, figsize=(10, 7), height_ratios=(1, 1, 1, 2.4), layout="constrained")
    for ax, (field, name, colours) in zip(axes, FIELDS):
        image = core.destagger(info, scan.field(field)).astype(float)
        image[image == 0] = np.nan  # no return
        low, high = np.nanpercentile(image, SHOWN_PERCENTILES)
        ax.imshow(image, cmap=colours, vmin=low, vmax=high, aspect="auto", interpolation="nearest")
        ax.set_title(name, loc="left", fontsize=9)
        ax.set_axis_off()
    seen = points[scan.field(core.ChanField.RANGE) > 0]
    axes[3].scatter(seen[:, 0], seen[:, 1], s=0.2, c=seen[:, 2], cmap="viridis", vmin=-2, vmax=6, linewidths=0)
    axes[3].set(xlabel="x (m)", ylabel="y (m)", xlim=(-42, 42), ylim=(-11, 16), aspect="equal")
    figure.savefig(picture, dpi=80)


def main():
    with tempfile.TemporaryDirectory() as folder:
        draw(*decoded_scan(sys.argv[1], Path(folder)), sys.argv[2])


if __name__ == "__main__":
    main()
