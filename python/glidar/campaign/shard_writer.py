# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes one shard: its outputs, its rows of the index, and finally its receipt."""

import numpy as np

from glidar.campaign import files, index
from glidar.campaign.bop_output import BopOutput, TrialError
from glidar.campaign.cloud_output import CloudOutput, KittiOutput
from glidar.campaign.npz_output import NpzOutput

NAME_DIGITS = 16  # number of hash digits in a file's name


def make_outputs(plan, temp, shard):
    chosen = plan.spec.outputs
    outputs = [BopOutput(plan, temp, shard)] if chosen.bop else []  # first, because it may reject a frame
    outputs += [NpzOutput(plan, temp, shard)] if chosen.npz else []
    for suffix, options in (("pcd", chosen.pcd), ("ply", chosen.ply), ("exr", chosen.exr), ("mcap", chosen.mcap)):
        if options:
            outputs.append(CloudOutput(suffix, f".{suffix}", options, temp))
    if chosen.kitti:
        outputs.append(KittiOutput(temp))
    return outputs


class ShardWriter:
    """Accepts the frames of a shard in any order; the files depend on the trials only."""

    def __init__(self, plan, folder, temp, shard, trials):
        self._plan, self._folder, self._temp, self._shard = plan, folder, temp, shard
        self._trials = trials
        self._outputs = make_outputs(plan, temp, shard)
        self._errors = [""] * len(trials)
        self._facts = np.full((len(trials), len(index.FACTS)), np.nan)

    def add(self, row, frame):
        try:
            for output in self._outputs:
                output.add(row, int(self._trials.number[row]), frame)
        except TrialError as error:
            self.fail(row, str(error))
            return
        except OSError as error:
            raise files.write_error(self._temp.newest, error) from None
        self._facts[row] = index.facts_of(frame)

    def fail(self, row, text):
        self._errors[row] = text

    def commit(self):
        """Publishes everything, the receipt last. For a durable folder everything else is on the disk before it.
        Returns (trials, failures)."""
        try:
            written = [pair for output in self._outputs for pair in output.finish()]
            part = self._temp.path("part.parquet")
            rows = index.rows(self._plan, self._shard, self._trials, self._errors, self._facts)
            index.write_part(part, rows)
        except OSError as error:
            raise files.write_error(self._temp.newest, error) from None
        listed, published = {}, []
        for name, path in written + [(self._part_name(), part)]:
            digest, size = files.hash_file(path), path.stat().st_size
            name = name.replace("{hash}", digest[:NAME_DIGITS])
            listed[name] = [digest, size]
            published.append((path, self._folder.place(name)))
        files.publish_all(self._temp, published)
        failed = sum(1 for text in self._errors if text)
        receipt = {"shard": self._shard, "trials": len(self._trials), "failed": failed,
                   "files": listed}
        files.write_json(self._temp, self._folder.receipt(self._shard), receipt)
        return len(self._trials), failed

    def _part_name(self):
        return self._folder.part(self._shard).relative
