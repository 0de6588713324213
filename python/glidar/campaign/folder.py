# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The campaign folder: where everything lies, and which shards are done.

    campaign.json        what the campaign is; the folder belongs to it
    receipts/000003.json a shard that is done: its files with their hashes; written last
    parts/000003.parquet its rows of the index
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
from glidar.campaign.plan import PLAN_FILE, identity


@dataclass(frozen=True)
class Folder:
    root: Path
    durable: bool = False  # what is written survives a loss of power

    def scratch(self):
        """A folder for what is being written; a context."""
        return files.scratch(self.root, self.durable)

    def plan_file(self):
        return self.root / PLAN_FILE

    def receipt(self, shard):
        return self.root / "receipts" / f"{shard:06}.json"

    def part(self, shard):
        return self.root / "parts" / f"{shard:06}.parquet"

    def extras(self):
        """Receipts of what is written once for the whole campaign."""
        return sorted((self.root / "receipts").glob("once-*.json"))

    def once(self, name):
        return self.root / "receipts" / f"once-{name}.json"

    def log(self):
        return self.root / "log" / f"{socket.gethostname()}-{os.getpid()}.jsonl"


def describe(plan):
    """What campaign.json holds: enough to finish, merge and report without the campaign's inputs."""
    return {"hash": plan.hash(), "trials": plan.spec.trials, "shards": plan.shards,
            "shard_trials": plan.shard_trials, "one_shape": plan.one_shape, "plan": plan.record()}


def claim(folder, plan):
    """Makes the folder the campaign's own, or checks that it is; returns whether it was not before."""
    wanted = describe(plan)
    if folder.plan_file().exists():
        require_same(folder.root, records.read_campaign(folder.plan_file()), wanted)
        return False
    require_empty(folder.root)
    with folder.scratch() as scratch:
        files.write_json(scratch, folder.plan_file(), wanted)
    return True


def require_empty(root):
    """Throws Error where a folder holds anything but what is half written."""
    if root.is_dir() and any(path.name != "tmp" for path in root.iterdir()):
        raise Error(str(root), "the folder is not empty and holds no campaign",
                    "a new folder, or that of this campaign", "choose another with -o")


def release(folder):
    """Gives a folder up in which nothing was measured."""
    try:
        names = {path.name for path in folder.root.iterdir()}
        if not names <= {PLAN_FILE, "log"} or (folder.root / "log").is_dir() and any(
                (folder.root / "log").iterdir()):
            return
        folder.plan_file().unlink(missing_ok=True)
        for path in (folder.root / "log", folder.root):
            if path.is_dir():
                path.rmdir()
    except OSError:
        pass  # another writes there, whose folder it then is


def require_same(root, held, wanted, allowed="a new folder, or that of this campaign",
                 remedy="choose another with -o"):
    """Throws Error where two campaign.json are of different campaigns, with what differs."""
    if held["hash"] != wanted["hash"]:
        told = difference(identity(held["plan"]), identity(wanted["plan"]))
        raise Error(str(root), f"it holds another campaign: {told}", allowed, remedy)


def _words(value):
    return "not there" if value is None else json.dumps(value)[:80]


def _element_name(path, place, old, new):
    """Scenes and sensors go by their names."""
    named = isinstance(old, dict) and isinstance(new, dict) and "name" in old and old["name"] == new.get("name")
    return f"{path}[{old['name'] if named else place}]"


def difference(old, new, path=""):
    """The first thing in which two plans differ, in words."""
    if isinstance(old, dict) and isinstance(new, dict):
        pairs = [(f"{path}.{key}".strip("."), old.get(key), new.get(key))
                 for key in sorted(old.keys() | new.keys())]
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        pairs = [(_element_name(path, i, a, b), a, b) for i, (a, b) in enumerate(zip(old, new))]
    else:
        return f"{path} was {_words(old)}, is {_words(new)}"
    for name, a, b in pairs:
        if a != b:
            return difference(a, b, name)
    return "nothing"


def opened(root):
    """A campaign's folder and its campaign.json."""
    folder = Folder(Path(path_of(root, "folder")))
    if not folder.plan_file().is_file():
        raise Error(str(root), "it holds no campaign", "a folder that glidar campaign run wrote", "")
    return folder, records.read_campaign(folder.plan_file())


def is_done(folder, shard, described):
    """Whether a shard has its receipt, and its files as long as the receipt says; `described`: campaign.json."""
    path = folder.receipt(shard)
    if not path.is_file():
        return False
    for name, (_, size) in records.read_receipt(path, described)["files"].items():
        try:
            if (folder.root / name).stat().st_size != size:
                return False
        except OSError:
            return False
    return True


def missing(folder, shards):
    """Those of the shards that are not done."""
    described = records.read_campaign(folder.plan_file())
    return [shard for shard in shards if not is_done(folder, shard, described)]


def count_missing(folder, described):
    """How many shards are not done: found by the receipts that are there, however many shards there should be."""
    shards = {names.receipt_shard(path) for path in records.receipts_in(folder.root)} - {None}
    return described["shards"] - sum(shard < described["shards"] and is_done(folder, shard, described)
                                     for shard in shards)


def note(folder, **words):
    """A line for the log; a full disk there does no harm."""
    try:
        folder.log().parent.mkdir(parents=True, exist_ok=True)
        with open(folder.log(), "a", encoding="utf-8") as file:
            file.write(json.dumps({"time_s": round(time.time(), 3), **words}) + "\n")
    except OSError:
        pass


def wrong_files(root, listed):
    """The names of files that are missing or not what a receipt or manifest says: {name: (hash, size)}."""
    for name, (digest, size) in listed.items():
        path = Path(root) / name
        if not path.is_file() or path.stat().st_size != size or files.hash_file(path) != digest:
            yield name
