# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the files of a complete campaign: index, trajectories and manifest."""

import functools
import importlib.metadata
import json
import platform

import numpy as np

from glidar.campaign import files, index, records, rotations

MANIFEST_FILE = "manifest.json"
PACKAGES = ["numpy", "scipy", "pyarrow", "pillow"]


@functools.cache  # reading them takes as long as some trials
def versions():
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            pass
    return found


def _poses(table):
    numbers = np.stack([table[name].to_numpy() for name in index.POSE], axis=1)
    return numbers[:, :3], numbers[:, 3:]


def _tum_lines(table):
    """Lines of t x y z qx qy qz qw; the time is the trial's number in seconds."""
    position, q = _poses(table)
    for trial, p, (w, x, y, z) in zip(table["trial"].to_pylist(), position, q):
        yield f"{trial} " + " ".join(repr(float(a)) for a in (*p, x, y, z, w)) + "\n"


def _kitti_lines(table):
    """The first three rows of world_from_sensor, row by row."""
    position, q = _poses(table)
    rows = np.concatenate([rotations.matrices(q), position[:, :, None]], axis=2).reshape(-1, 12)
    for row in rows:
        yield " ".join(repr(float(a)) for a in row) + "\n"


def _write_lines(folder, temp, name, lines_of):
    path = temp.path(name.replace("/", "-"))
    try:
        with open(path, "w", encoding="utf-8") as file:
            for table in index.batches(folder.place(index.INDEX_FILE), ["trial", *index.POSE]):
                file.writelines(lines_of(table))
    except OSError as error:
        raise files.write_error(folder.place(name), error) from None
    files.publish(temp, path, folder.place(name))
    return name


def _write_index(folder, temp, described):
    path = temp.path(index.INDEX_FILE)
    try:
        index.join((index.read_part(folder.part(shard), described, records.read_receipt(folder.receipt(shard), described))
                    for shard in range(described["shards"])), path)
    except OSError as error:
        raise files.write_error(folder.place(index.INDEX_FILE), error) from None
    files.publish(temp, path, folder.place(index.INDEX_FILE))
    return index.INDEX_FILE


def _receipts(folder, described):
    """All receipts: those of the shards in order, then those of files that are written once."""
    for shard in range(described["shards"]):
        yield records.read_receipt(folder.receipt(shard), described)
    for path in folder.extras():
        yield records.read_receipt(path, described)


def _write_manifest(folder, temp, described, once):
    """Writes the manifest line by line, because it lists every file of the campaign."""
    path = temp.path(MANIFEST_FILE)
    trials = failed = 0
    head = {"campaign": described["hash"], "plan": described["plan"], "versions": versions()}
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write('{"files": {\n')
            for name in once:
                whole = folder.place(name)
                entry = [files.hash_file(whole), whole.size()]
                file.write(f"{json.dumps(name)}: {json.dumps(entry)},\n")
            for receipt in _receipts(folder, described):
                trials += receipt["trials"]
                failed += receipt["failed"]
                for name, entry in sorted(receipt["files"].items()):
                    if not name.startswith("parts/"):
                        file.write(f"{json.dumps(name)}: {json.dumps(entry)},\n")
            plan_file = folder.plan_file().name
            entry = [files.hash_file(folder.plan_file()), folder.plan_file().size()]
            file.write(f'{json.dumps(plan_file)}: {json.dumps(entry)}\n}},\n')
            rest = files.json_bytes({**head, "trials": trials, "failed": failed}).decode()
            file.write(rest.lstrip("{\n"))
    except OSError as error:
        raise files.write_error(folder.place(MANIFEST_FILE), error) from None
    files.publish(temp, path, folder.place(MANIFEST_FILE))
    return trials, failed


def finish(folder, described):
    """Writes index, trajectories and manifest of a campaign whose shards are all complete; returns (trials,
    failed)."""
    with folder.temp_folder() as temp:
        temp.sync_folders([folder.receipt(0).parent.path])  # a killed run may have written a receipt without this sync
        once = [_write_index(folder, temp, described)]
        outputs = described["plan"]["campaign"]["outputs"]
        if outputs["tum"]:
            once.append(_write_lines(folder, temp, "trajectory.tum", _tum_lines))
        if outputs["kitti"]:
            once.append(_write_lines(folder, temp, "kitti/poses.txt", _kitti_lines))
        return _write_manifest(folder, temp, described, once)
