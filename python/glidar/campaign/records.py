# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads and checks campaign.json, receipts and manifests.

Parts of a campaign come from other machines and people, so these files are not trusted: the values that these functions
return have the keys, types and bounds that the other modules rely on.
"""

import re
import reprlib

from glidar import Error
from glidar._errors import excerpt
from glidar.campaign import files, names
from glidar.campaign.beneath import Inside

MAX_TRIALS = 1 << 32
MAX_SHARD_TRIALS = 1 << 16
SHA256 = re.compile("[0-9a-f]{64}", re.ASCII)
MAX_SHARDS = 1 << 22
MAX_BYTES = 1 << 62  # of a file
MIN_RECEIPT_VALUES = 1 << 16
MAX_TRIAL_VALUES = 1 << 8  # in a receipt, on average


class _Record:
    """A value of a JSON file, with its location for errors."""

    def __init__(self, file, location, value):
        self.file, self.location, self.value = file, location, value

    def reject(self, allowed):
        where = f"{self.file}: {self.location}" if self.location else str(self.file)
        raise Error(where, f"it is {excerpt(reprlib.repr(self.value))}", allowed,
                    "the file was not written by this version of glidar campaign, or was changed")

    def of(self, kind, allowed):
        # bool is a subclass of int, but not accepted as one
        if not isinstance(self.value, kind) or isinstance(self.value, bool) and kind is not bool:
            self.reject(allowed)
        return self.value

    def map(self):
        return self.of(dict, "a map")

    def at(self, key):
        if key not in self.map():
            raise Error(str(self.file), f"the key '{f'{self.location}.{key}'.strip('.')}' is missing",
                        "a file that glidar campaign wrote", "")
        return _Record(self.file, f"{self.location}.{key}".strip("."), self.value[key])

    def items(self):
        self.of(list, "a list")
        return [_Record(self.file, f"{self.location}[{i}]", value) for i, value in enumerate(self.value)]

    def whole(self, minimum, maximum):
        allowed = f"a whole number from {minimum} to {maximum}"
        if not minimum <= self.of(int, allowed) <= maximum:
            self.reject(allowed)
        return self.value

    def text(self):
        return self.of(str, "a string")

    def flag(self):
        return self.of(bool, "true or false")

    def sha256(self):
        if not SHA256.fullmatch(self.of(str, "a SHA-256 hash")):
            self.reject("a SHA-256 hash of 64 digits")
        return self.value


def _read(path, max_values=files.MAX_JSON_VALUES):
    return _Record(path, "", files.read_json(path, max_values))


def _check_listed(listed):
    """A map of names to [hash, size]."""
    for name in listed.map():
        entry = listed.at(name)
        if len(entry.items()) != 2:
            entry.reject("[SHA-256, size in bytes]")
        hashed, size = entry.items()
        hashed.sha256()
        size.whole(0, MAX_BYTES)
    return listed.value


def _check_counts(record):
    trials = record.at("trials").whole(0, MAX_TRIALS)
    record.at("failed").whole(0, trials)


def _check_vector(record):
    if record.value is not None and len(record.items()) != 3:
        record.reject("three numbers")
    for one in record.items() if record.value is not None else []:
        one.of((int, float), "a number")


def _check_spec(campaign):
    """Checks the parts of the campaign's spec that finishing and reporting read."""
    campaign.at("name").text()
    campaign.at("method").text()
    campaign.at("seed").whole(0, (1 << 64) - 1)
    outputs = campaign.at("outputs")
    for key in ("tum", "kitti"):
        outputs.at(key).flag()
    pose = campaign.at("pose")
    for key, part in (("target", pose.at("orientation")), ("centre", pose.at("position"))):
        if key in part.map():
            _check_vector(part.at(key))


def _check_plan(plan):
    plan.at("glidar").text()
    _check_spec(plan.at("campaign"))
    for key in ("scenes", "sensors"):
        for source in plan.at(key).items():
            source.at("name").text()
            source.at("unreadable").flag()


def read_campaign(path):
    """The content of campaign.json of a campaign's folder."""
    record = _read(path)
    record.at("hash").sha256()
    trials = record.at("trials").whole(1, MAX_TRIALS)
    shard_trials = record.at("shard_trials").whole(1, MAX_SHARD_TRIALS)
    shards = -(-trials // shard_trials)
    record.at("shards").whole(shards, min(shards, MAX_SHARDS))
    record.at("one_shape").flag()
    _check_plan(record.at("plan"))
    return record.value


def shard_trials(described, shard):
    """The trials of a shard."""
    first = shard * described["shard_trials"]
    return range(first, min(first + described["shard_trials"], described["trials"]))


def read_receipt(path, described):
    """The content of a receipt of this campaign, whose campaign.json is `described`."""
    shard = names.receipt_shard(path)
    record = _read(path, MIN_RECEIPT_VALUES + MAX_TRIAL_VALUES * described["shard_trials"])
    _check_counts(record)
    listed = _check_listed(record.at("files"))
    if shard is None:
        names.require_once_files(path, listed)
        return record.value
    if shard >= described["shards"]:
        raise Error(str(path), f"a receipt of shard {shard}", f"shards from 0 to {described['shards'] - 1}", "remove it")
    record.at("shard").whole(shard, shard)
    trials = shard_trials(described, shard)
    record.at("trials").whole(len(trials), len(trials))
    names.require_shard_files(path, listed, shard, trials)
    return record.value


def read_manifest(path):
    """The manifest of a finished campaign."""
    record = _read(path)
    record.at("campaign").sha256()
    _check_counts(record)
    _check_plan(record.at("plan"))
    versions = record.at("versions")
    for name in versions.map():
        versions.at(name).text()
    names.require_manifest_files(path, _check_listed(record.at("files")))
    return record.value


def receipts_in(root):
    """The places of a folder's receipts."""
    return Inside(root, "receipts").children(".json")
