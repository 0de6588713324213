# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Installs the package as ament_python does."""

from setuptools import setup

NAME = "glidar_ros2"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/stream.launch.py", "launch/lockstep.launch.py"]),
    ],
    install_requires=["setuptools"],
    license="BSD-3-Clause",
    description="Launch files and a node for GLIDAR, a simulator of 3D sensors",
    maintainer="The GLIDAR developers",
    maintainer_email="glidar@example.org",
    entry_points={"console_scripts": [f"lockstep = {NAME}.node:main"]},
)
