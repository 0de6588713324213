# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names of a campaign's files, as receipts and manifests list them.

Such a list may come from an untrusted source. A name is joined to a folder only if it has the form of the names that a
campaign writes. Then it cannot refer to a file outside the folder, nor replace files of another shard.
"""

import re

from glidar import Error
from glidar._errors import excerpt

HASH = "[0-9a-f]{16}"
IMAGES = "depth|gray|mask|mask_visib"
OF_SHARDS = re.compile(
    rf"parts/(?P<part>\d{{6,}})\.parquet|npz/shard-(?P<npz>\d{{6,}})-{HASH}\.npz"
    rf"|bop/(?:train|val|test)/(?P<bop>\d{{6,}})/(?:(?:{IMAGES})/\d{{6,}}(?:_\d{{6,}})?\.png"
    r"|scene_(?:boxes|camera|gt|gt_info)\.json)", re.ASCII)
OF_TRIALS = re.compile(
    r"pcd/(?P<pcd>\d{9,})\.pcd|ply/(?P<ply>\d{9,})\.ply|exr/(?P<exr>\d{9,})\.exr"
    r"|mcap/(?P<mcap>\d{9,})\.mcap"
    r"|kitti/(?:velodyne|labels|label_2|calib)/(?P<kitti>\d{9,})\.(?:bin|label|txt)", re.ASCII)
ONCE = re.compile(r"bop/models/(?:obj_\d{6,}\.ply|models_info\.json)|bop/camera\.json", re.ASCII)
WHOLE = {"campaign.json", "index.parquet", "trajectory.tum", "kitti/poses.txt"}
RECEIPT = re.compile(r"(?P<shard>\d{6,})\.json|once-bop\.json", re.ASCII)
LOG = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,254}\.jsonl", re.ASCII)


def _number(match):
    """The number in a name; None when the name does not have this form."""
    found = [text for text in match.groupdict().values() if text] if match else []
    return int(found[0]) if found and len(found[0]) <= 18 else None


def _fits_shard(name, shard, trials):
    """Whether a shard writes such a file; `trials`: the range of its trials."""
    if _number(OF_SHARDS.fullmatch(name)) == shard:
        return True
    number = _number(OF_TRIALS.fullmatch(name))
    return number is not None and number in trials


def _reject(path, name, allowed):
    raise Error(str(path), f"it lists the file '{excerpt(name)}'", allowed,
                "copy the part again from its source; this one may be corrupt or forged")


def require_shard_files(path, listed, shard, trials):
    """Raises Error when the receipt of a shard lists a file that the shard does not write."""
    for name in listed:
        if not _fits_shard(name, shard, trials):
            _reject(path, name, f"files that shard {shard} writes, such as npz/shard-{shard:06}-HASH.npz")


def require_once_files(path, listed):
    """The same for the receipt of files that are written once for all shards."""
    for name in listed:
        if not ONCE.fullmatch(name):
            _reject(path, name, "files of bop/models, and bop/camera.json")


def require_manifest_files(path, listed):
    """The same for a manifest, which lists all files of a campaign."""
    for name in listed:
        known = name in WHOLE or any(form.fullmatch(name) for form in (OF_SHARDS, OF_TRIALS, ONCE))
        if not known:
            _reject(path, name, "files that glidar campaign writes, such as npz/shard-000000-HASH.npz")


def receipt_shard(path):
    """The shard of a receipt; None for files that are written once. Raises Error for another file name."""
    match = RECEIPT.fullmatch(path.name)
    if not match:
        raise Error(str(path), "it is not a receipt, but it is in their folder", "000003.json, once-bop.json", "remove it")
    return _number(match)


def is_part(name):
    """Whether it is the name of a shard's rows of the index."""
    match = OF_SHARDS.fullmatch(name)
    return match is not None and match["part"] is not None


def is_log(path):
    return LOG.fullmatch(path.name) is not None
