# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""OpenEXR images of campaigns, read by the OpenEXR project's own Python package."""

import subprocess

import numpy as np
import pytest

OpenEXR = pytest.importorskip("OpenEXR")


def channels(path):
    (part,) = OpenEXR.File(str(path), separate_channels=True).parts
    return {name: channel.pixels for name, channel in part.channels.items()}


def test_images_contain_the_arrays_of_the_same_trials(campaign):
    if "OpenEXR" not in subprocess.run(["glidar", "--version"], capture_output=True, text=True, check=True).stdout:
        pytest.skip("this build has no OpenEXR; install libopenexr-dev and build again")
    campaign.add("outputs: {exr: {columns: [instance, range], every: 3}, npz: {columns: [depth, instance, range]}}\n")
    campaign.run("out")
    images = sorted((campaign.folder / "out" / "exr").iterdir())
    assert [path.name for path in images] == [f"{trial:09}.exr" for trial in range(0, 40, 3)]
    arrays = {}
    for path in sorted((campaign.folder / "out" / "npz").iterdir()):
        with np.load(path) as shard:
            arrays.update({trial: {n: shard[n][row] for n in ("depth", "instance", "range")}
                           for row, trial in enumerate(shard["trial"].tolist())})  # fmt: skip
    for path in images:
        found, wanted = channels(path), arrays[int(path.stem)]
        assert set(found) == {"Z", "instance", "range"}
        np.testing.assert_array_equal(found["Z"], wanted["depth"])
        np.testing.assert_array_equal(found["range"], wanted["range"])
        np.testing.assert_array_equal(found["instance"], wanted["instance"])
        assert np.isfinite(found["Z"]).any()
    campaign.call("check", "out")
