# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The campaign folder: its files, and which shards are complete.

    campaign.json        the plan of the campaign that the folder belongs to
    receipts/000003.json a completed shard: its files with their hashes; written last
    parts/000003.parquet the shard's rows of the index
    log/*.jsonl          speeds and machines: the only files that differ from run to run
"""

import json
import os
import socket
import time
from dataclasses import dataclass
from pathlib import Path

from glidar import Error
from glidar._inputs import path_of
from glidar.campaign import files, names, records
from glidar.campaign.beneath import Inside
from glidar.campaign.plan import PLAN_FILE, identity


@dataclass(frozen=True)
class CampaignFolder:
    """Its files are places in the folder (beneath.py), which may come from others."""

    root: Path
    durable: bool = False  # files survive power loss

    def place(self, name):
        """The place of a file that a receipt or manifest lists."""
        return Inside(self.root) / name

    def temp_folder(self):
        """A temporary folder for files that are being written; a context manager."""
        return files.temp_folder(self.root, self.durable)

    def plan_file(self):
        return self.place(PLAN_FILE)

    def receipt(self, shard):
        return self.place(f"receipts/{shard:06}.json")

    def part(self, shard):
        return self.place(f"parts/{shard:06}.parquet")

    def extras(self):
        """Receipts of files that are written once for the whole campaign."""
        return [place for place in records.receipts_in(self.root) if place.name.startswith("once-")]

    def once(self, name):
        return self.place(f"receipts/once-{name}.json")

    def log(self):
        return self.place(f"log/{socket.gethostname()}-{os.getpid()}.jsonl")


def describe(plan):
    """The content of campaign.json: enough to finish, merge and report without the campaign's inputs."""
    return {"hash": plan.hash(), "trials": plan.spec.trials, "shards": plan.shards,
            "shard_trials": plan.shard_trials, "one_shape": plan.one_shape, "plan": plan.record()}


def create_or_check(folder, plan):
    """Creates the folder of a campaign, or checks that it belongs to it; returns whether it is new."""
    wanted = describe(plan)
    if folder.plan_file().is_file():
        require_same(folder.root, records.read_campaign(folder.plan_file()), wanted)
        return False
    require_empty(folder.root)
    with folder.temp_folder() as temp:
        files.write_json(temp, folder.plan_file(), wanted)
    return True


def require_empty(root):
    """Raises Error when a folder contains anything but temporary files."""
    if any(place.name != "tmp" for place in Inside(root).children()):
        raise Error(str(root), "the folder is not empty and contains no campaign",
                    "a new folder, or that of this campaign", "choose another with -o")


def remove_unused(folder):
    """Removes a folder in which nothing was measured."""
    try:
        log = Inside(folder.root, "log")
        if not {place.name for place in Inside(folder.root).children()} <= {PLAN_FILE, "log"} or log.children():
            return
        folder.plan_file().unlink()
        log.remove_empty()
        folder.root.rmdir()
    except OSError:
        pass  # another process has started to write there


def require_same(root, held, wanted, allowed="a new folder, or that of this campaign",
                 remedy="choose another with -o"):
    """Raises Error with the first difference when two campaign.json describe different campaigns."""
    if held["hash"] != wanted["hash"]:
        found = difference(identity(held["plan"]), identity(wanted["plan"]))
        raise Error(str(root), f"it contains another campaign: {found}", allowed, remedy)


def _json_text(value):
    return "missing" if value is None else json.dumps(value)[:80]


def _element_name(path, index, old, new):
    """Scenes and sensors are identified by their names."""
    named = isinstance(old, dict) and isinstance(new, dict) and "name" in old and old["name"] == new.get("name")
    return f"{path}[{old['name'] if named else index}]"


def difference(old, new, path=""):
    """The first difference between two plans, in values."""
    if isinstance(old, dict) and isinstance(new, dict):
        pairs = [(f"{path}.{key}".strip("."), old.get(key), new.get(key))
                 for key in sorted(old.keys() | new.keys())]
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        pairs = [(_element_name(path, i, a, b), a, b) for i, (a, b) in enumerate(zip(old, new))]
    else:
        return f"{path} was {_json_text(old)}, is {_json_text(new)}"
    for name, a, b in pairs:
        if a != b:
            return difference(a, b, name)
    return "nothing"


def opened(root):
    """A campaign's folder and the content of its campaign.json."""
    folder = CampaignFolder(Path(path_of(root, "folder")))
    if not folder.plan_file().is_file():
        raise Error(str(root), "it contains no campaign", "a folder that glidar campaign run wrote", "")
    return folder, records.read_campaign(folder.plan_file())


def is_done(folder, shard, described):
    """Whether a shard has its receipt, and its files have the sizes in it; `described`: campaign.json."""
    path = folder.receipt(shard)
    if not path.is_file():
        return False
    for name, (_, size) in records.read_receipt(path, described)["files"].items():
        try:
            if folder.place(name).size() != size:
                return False
        except OSError:
            return False
    return True


def missing(folder, shards):
    """The shards that are not complete."""
    described = records.read_campaign(folder.plan_file())
    return [shard for shard in shards if not is_done(folder, shard, described)]


def count_missing(folder, described):
    """The number of incomplete shards. It depends on the existing receipts only, not on the number of shards."""
    shards = {names.receipt_shard(path) for path in records.receipts_in(folder.root)} - {None}
    return described["shards"] - sum(shard < described["shards"] and is_done(folder, shard, described)
                                     for shard in shards)


def append_log(folder, **values):
    """Appends a line to the log; a full disk is ignored there."""
    try:
        folder.log().append(json.dumps({"time_s": round(time.time(), 3), **values}) + "\n")
    except OSError:
        pass


def wrong_files(root, listed):
    """Names of files that are missing or differ from a receipt or manifest: {name: (hash, size)}."""
    for name, (digest, size) in listed.items():
        place = Inside(root) / name
        if place.size() != size or files.hash_file(place) != digest:
            yield name
