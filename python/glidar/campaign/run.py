# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a campaign from its file to its folder with any executor, and merges parts of campaigns."""

import contextlib
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from glidar import Error
from glidar._inputs import MAX_UINT32, path_of, whole
from glidar.campaign import bop_models, files, finish as finishing, folder as folders, index, names, records
from glidar.campaign.beneath import Inside
from glidar.campaign.folder import CampaignFolder
from glidar.campaign.local import require_guard, run_local
from glidar.campaign.plan import Plan, make_plan
from glidar.campaign.progress import Progress
from glidar.campaign.spec import read_spec
from glidar.campaign.work import ShardResult

StrPath = str | os.PathLike[str]
Execute = Callable[[Plan, CampaignFolder, list[int], Callable[[ShardResult], None]], None]


@dataclass(frozen=True)
class ShardSubset:
    """Part `index` of `count` parts of the shards: those whose number modulo `count` is `index`."""

    index: int = 0
    count: int = 1

    def __post_init__(self) -> None:
        if whole(self.index, "part, index", MAX_UINT32) >= whole(self.count, "part, count", MAX_UINT32):
            raise Error("part", f"{self.index} of {self.count}", "an index from 0 to below the count")

    def shards(self, total: int) -> list[int]:
        return list(range(self.index, total, self.count))


@dataclass(frozen=True)
class Outcome:
    """The result of a run."""

    trials: int
    failed: int
    whole: bool  # whether the campaign is complete, with index and manifest
    missing: int = 0  # number of missing shards
    rate: float = 0.0  # trials per second of this run
    error: str = ""  # the most frequent error of failed trials, with its count


def _prepare(plan: Plan, folder: CampaignFolder) -> bool:
    """Creates or checks the folder. If the models cannot be written, a new folder is removed. Returns whether it is new."""
    is_new: bool = folders.create_or_check(folder, plan)
    files.remove_stale_files(folder.root)
    try:
        if plan.spec.outputs.bop and not folder.once("bop").is_file():
            bop_models.write(plan, folder)
    except Error:
        if is_new:
            folders.remove_unused(folder)
        raise
    return is_new


@contextlib.contextmanager
def opened_for_run(spec_path: StrPath, root: StrPath, is_part: bool = False,
            durable: bool = False) -> Iterator[tuple[Plan, CampaignFolder]]:
    """Reads the campaign and opens its folder. If an error occurs before anything is measured, a new folder is removed,
    except for parts, which may share it."""
    plan = make_plan(read_spec(path_of(spec_path, "campaign")))
    folder = CampaignFolder(Path(path_of(root, "folder")), durable)
    is_new = _prepare(plan, folder)
    try:
        yield plan, folder
    except Error:
        if is_new and not is_part:
            folders.remove_unused(folder)
        raise


def _counts(folder, shards):
    """(trials, failed) of completed shards."""
    described = records.read_campaign(folder.plan_file())
    receipts = [records.read_receipt(folder.receipt(shard), described) for shard in shards]
    return sum(r["trials"] for r in receipts), sum(r["failed"] for r in receipts)


def run(spec_path: StrPath, root: StrPath, part: ShardSubset = ShardSubset(), workers: int = 0,
        execute: Execute | None = None, quiet: bool = False, *, durable: bool = True) -> Outcome:
    """Measures the missing shards of a part of the campaign. When no shard is missing, it finishes the campaign.

    Worker processes import the script that calls this function. Therefore, with several workers, the call must be within
    `if __name__ == "__main__":`.

    Args:
        spec_path: the campaign file.
        root: the folder of the data set; a run in the folder of the same campaign resumes it.
        part: the part of the shards to measure; default: all.
        workers: processes; 0: one, or one per core when scenes or sensors differ between trials.
        execute: the executor, called as `execute(plan, folder, shards, report)`; None: this machine.
        quiet: whether to show no progress.
        durable: whether to sync every file to the disk before a receipt lists it (fsync), so that power loss does not
            damage completed shards.

    Raises:
        Error: bad input, a full disk or a disk error. Failed trials are only counted in the outcome.
    """
    require_guard()
    whole(workers, "workers", MAX_UINT32)
    with opened_for_run(spec_path, root, part.count > 1, durable) as (plan, folder):
        wanted = part.shards(plan.shards)
        todo = folders.missing(folder, wanted)
        done, failed = _counts(folder, sorted(set(wanted) - set(todo)))
        total = sum(plan.trials_of(shard)[1] for shard in wanted)
        progress = Progress(total, done, quiet)
        progress.failed = failed
        _measure(plan, folder, todo, execute, workers, lambda d: progress.advance(d.trials, d.failed))
        progress.finish()
        if part.count > 1:
            return Outcome(progress.done, progress.failed, False, 0, progress.rate(),
                           _most_frequent_error(folder, wanted))
        return _finished(folder, progress.rate())


def _measure(plan: Plan, folder: CampaignFolder, todo: list[int], execute: Execute | None, workers: int,
             report: Callable[[ShardResult], None]) -> None:
    try:
        if todo and execute:
            execute(plan, folder, todo, report)
        elif todo:
            run_local(plan, folder, todo, report, workers)
    finally:
        files.remove_stale_files(folder.root)


def _most_frequent_error(folder: CampaignFolder, shards: Sequence[int]) -> str:
    """The most frequent error of failed trials, with its count."""
    described = records.read_campaign(folder.plan_file())
    receipts = {shard: records.read_receipt(folder.receipt(shard), described) for shard in shards}
    counts = index.count_errors(index.read_part(folder.part(shard), described, receipt)
                                for shard, receipt in receipts.items() if receipt["failed"])
    if not counts:
        return ""
    text, count = counts.most_common(1)[0]
    return f"{count} of {counts.total()}: {text}"


def _finished(folder: CampaignFolder, rate: float = 0.0) -> Outcome:
    described = records.read_campaign(folder.plan_file())
    shards = range(described["shards"])
    missing = folders.count_missing(folder, described)
    if missing:
        return Outcome(0, 0, False, missing, rate)
    trials, failed = finishing.finish(folder, described)
    return Outcome(trials, failed, True, 0, rate, _most_frequent_error(folder, shards) if failed else "")


def _bad_content(path: Inside) -> Error:
    return Error(str(path), "its content differs from its receipt", "files as they were written",
                 "remove its receipt and run the part again")


def _import_file(name, entry, source, target, temp):
    """Copies a file of another folder and checks its hash; returns the copy, or None when the target has the file."""
    digest, _ = entry
    there, here = Inside(source) / name, Inside(target) / name
    if here.is_file() and files.hash_file(here) == digest:
        return None
    path = temp.path(here.name)
    try:
        files.copy(there, path)
    except OSError as error:
        raise files.write_error(here, error) from None
    if files.hash_file(path) != digest:
        raise _bad_content(there)
    return path


def _import_receipt(receipt, target, temp, described):
    """Copies all files of a receipt, and then the receipt."""
    content = records.read_receipt(receipt, described)
    known = Inside(target, *receipt.parts)
    if known.is_file():
        if records.read_receipt(known, described) != content:
            raise Error(str(receipt), f"it differs from {known}", "parts of one campaign give the "
                        "same shard the same content", "check that all parts were run with the same versions")
        return
    copied = {name: _import_file(name, entry, receipt.root, target, temp)
              for name, entry in sorted(content["files"].items())}
    for name in filter(names.is_part, copied):
        index.read_part(copied[name] or Inside(target) / name, described, content)
    places = {name: Inside(target) / name for name in copied}
    files.publish_all(temp, [(path, places[name]) for name, path in copied.items() if path],
                      [places[name] for name, path in copied.items() if not path])
    files.write_bytes(temp, known, files.json_bytes(content))


def _open_target(target, described, temp):
    """Prepares the target folder: creates it, or checks the files of all receipts that it has."""
    if target.plan_file().is_file():
        folders.require_same(target.root, records.read_campaign(target.plan_file()), described)
    else:
        folders.require_empty(target.root)
        files.write_json(temp, target.plan_file(), described)
    for receipt in records.receipts_in(target.root):
        for name in folders.wrong_files(target.root, records.read_receipt(receipt, described)["files"]):
            raise _bad_content(target.place(name))


def merge(sources: Sequence[StrPath], root: StrPath, durable: bool = True) -> Outcome:
    """Merges the parts of a campaign and finishes it.

    Args:
        sources: folders of the parts.
        root: the target folder: one of the parts, or another one.
        durable: as for run().

    Raises:
        Error: parts of different campaigns, or files that differ from their receipts.
    """
    sources, root = [path_of(source, "part") for source in sources], path_of(root, "folder")
    if not sources:
        raise Error("parts", "none are given", "folders of parts of a campaign")
    described = folders.opened(sources[0])[1]
    for source in sources[1:]:
        folders.require_same(source, folders.opened(source)[1], described,
                             f"parts of one campaign, here that of {sources[0]}", "")
    target = CampaignFolder(Path(root), durable)
    with target.temp_folder() as temp:
        _open_target(target, described, temp)
        for source in map(Path, sources):
            if source.resolve() != target.root.resolve():
                for receipt in records.receipts_in(source):
                    _import_receipt(receipt, target.root, temp, described)
                _import_logs(source, target.root, temp)
    files.remove_stale_files(root)
    return _finished(target)


def _import_logs(source, target, temp):
    for log in Inside(source, "log").children():
        if not names.is_log(log):
            files.note(f"{log}: it is not a log of glidar campaign, and is not copied")
            continue
        copied, place = temp.path(log.name), Inside(target, "log", log.name)
        try:
            files.copy(log, copied, files.MAX_JSON_BYTES)
        except OSError as error:
            raise files.write_error(place, error) from None
        files.publish(temp, copied, place)


def check(root: StrPath) -> tuple[int, list[str]]:
    """Compares every file with the manifest; returns (number of files, names of those that differ or are missing)."""
    folder, _ = folders.opened(root)
    listed = records.read_manifest(folder.place(finishing.MANIFEST_FILE))["files"]
    return len(listed), list(folders.wrong_files(folder.root, listed))
