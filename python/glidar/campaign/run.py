# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign from its file to its folder, by any executor; and parts of it merged."""

import contextlib
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from glidar import Error
from glidar._inputs import MAX_UINT32, path_of, whole
from glidar.campaign import bop_models, files, finish as finishing, folder as folders, index, names, records
from glidar.campaign.folder import Folder
from glidar.campaign.local import require_guard, run_local
from glidar.campaign.plan import Plan, make_plan
from glidar.campaign.progress import Progress
from glidar.campaign.spec import read_spec
from glidar.campaign.work import Done

StrPath = str | os.PathLike[str]
Execute = Callable[[Plan, Folder, list[int], Callable[[Done], None]], None]


@dataclass(frozen=True)
class Part:
    """Of the shards, those whose number leaves this remainder: part `index` of `count`."""

    index: int = 0
    count: int = 1

    def __post_init__(self) -> None:
        if whole(self.index, "part, index", MAX_UINT32) >= whole(self.count, "part, count", MAX_UINT32):
            raise Error("part", f"{self.index} of {self.count}", "an index from 0 to below the count")

    def shards(self, total: int) -> list[int]:
        return list(range(self.index, total, self.count))


@dataclass(frozen=True)
class Outcome:
    """What a run left behind."""

    trials: int
    failed: int
    whole: bool  # the campaign is complete, with index and manifest
    missing: int = 0  # shards that are not there yet
    rate: float = 0.0  # trials a second of this run
    error: str = ""  # of failed trials the commonest, with their number


def _prepare(plan: Plan, folder: Folder) -> bool:
    """Claims the folder, which it gives up again where it has nothing to begin with; returns whether it is new."""
    is_new: bool = folders.claim(folder, plan)
    files.remove_leftovers(folder.root)
    try:
        if plan.spec.outputs.bop and not folder.once("bop").is_file():
            bop_models.write(plan, folder)
    except Error:
        if is_new:
            folders.release(folder)
        raise
    return is_new


@contextlib.contextmanager
def claimed(spec_path: StrPath, root: StrPath, is_part: bool = False,
            durable: bool = False) -> Iterator[tuple[Plan, Folder]]:
    """Reads the campaign and claims its folder; where an error comes before anything is measured, for nothing.
    Parts may share the folder, and leave it."""
    plan = make_plan(read_spec(path_of(spec_path, "campaign")))
    folder = Folder(Path(path_of(root, "folder")), durable)
    is_new = _prepare(plan, folder)
    try:
        yield plan, folder
    except Error:
        if is_new and not is_part:
            folders.release(folder)
        raise


def _counts(folder, shards):
    """(trials, failed) of shards that are done."""
    described = records.read_campaign(folder.plan_file())
    receipts = [records.read_receipt(folder.receipt(shard), described) for shard in shards]
    return sum(r["trials"] for r in receipts), sum(r["failed"] for r in receipts)


def run(spec_path: StrPath, root: StrPath, part: Part = Part(), workers: int = 0,
        execute: Execute | None = None, quiet: bool = False, *, durable: bool = True) -> Outcome:
    """Measures what is missing of a part of the campaign, and finishes the campaign when nothing is.

    Worker processes import the script that calls this: the call stands below `if __name__ == "__main__":`, unless
    there is one worker.

    Args:
        spec_path: the campaign file.
        root: the folder of the data set; one that holds a part of the same campaign goes on.
        workers: processes; 0: one, and where scenes or sensors differ from trial to trial one per core.
        execute: runs shards: `execute(plan, folder, shards, report)`; None: this machine does.
        quiet: shows no progress.
        durable: syncs every file to the disk before a receipt lists it (fsync), so that a loss of power undoes
            nothing that is done.

    Raises:
        Error: bad input, no room, or a disk that fails; trials that fail are counted in the outcome.
    """
    require_guard()
    whole(workers, "workers", MAX_UINT32)
    with claimed(spec_path, root, part.count > 1, durable) as (plan, folder):
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
                           _commonest(folder, wanted))
        return _finished(folder, progress.rate())


def _measure(plan: Plan, folder: Folder, todo: list[int], execute: Execute | None, workers: int,
             report: Callable[[Done], None]) -> None:
    try:
        if todo and execute:
            execute(plan, folder, todo, report)
        elif todo:
            run_local(plan, folder, todo, report, workers)
    finally:
        files.remove_leftovers(folder.root)


def _commonest(folder: Folder, shards: Sequence[int]) -> str:
    """Of the errors of failed trials the commonest, in words."""
    described = records.read_campaign(folder.plan_file())
    failing = (folder.part(s) for s in shards if records.read_receipt(folder.receipt(s), described)["failed"])
    counts = index.count_errors(failing)
    if not counts:
        return ""
    text, count = counts.most_common(1)[0]
    return f"{count} of {counts.total()}: {text}"


def _finished(folder: Folder, rate: float = 0.0) -> Outcome:
    described = records.read_campaign(folder.plan_file())
    shards = range(described["shards"])
    missing = folders.count_missing(folder, described)
    if missing:
        return Outcome(0, 0, False, missing, rate)
    trials, failed = finishing.finish(folder, described)
    return Outcome(trials, failed, True, 0, rate, _commonest(folder, shards) if failed else "")


def _bad_content(path: Path) -> Error:
    return Error(str(path), "its content is not what its receipt says", "files as they were written",
                 "remove its receipt and run that part again")


def _adopt(name, entry, source, target, scratch):
    """Copies a file of another folder, if it is what its receipt says; None: it has its place already."""
    digest, _ = entry
    for root in (source, target):
        names.require_inside(root, root / name)
    if (target / name).is_file() and files.hash_file(target / name) == digest:
        return None
    path = scratch.path(Path(name).name)
    try:
        files.copy(source / name, path)
    except OSError as error:
        raise files.write_error(target / name, error) from None
    if files.hash_file(path) != digest:
        raise _bad_content(source / name)
    return path


def _adopt_receipt(receipt, source, target, scratch, described):
    """Takes over all files of a receipt, and then the receipt."""
    relative = receipt.relative_to(source)
    content = records.read_receipt(receipt, described)
    known = target / relative
    for root in (source, target):
        names.require_inside(root, root / relative)
    if known.is_file():
        if records.read_receipt(known, described) != content:
            raise Error(str(receipt), f"it differs from {known}", "parts of one campaign give the "
                        "same shard the same content", "were they run by the same versions?")
        return
    copied = {name: _adopt(name, entry, source, target, scratch) for name, entry in sorted(content["files"].items())}
    files.publish_all(scratch, [(path, target / name) for name, path in copied.items() if path],
                      [target / name for name, path in copied.items() if not path])
    files.write_bytes(scratch, known, files.json_bytes(content))


def _open_target(target, described, scratch):
    """The folder of the whole: a new one, or one of the campaign whose files are what their receipts say."""
    if target.plan_file().is_file():
        folders.require_same(target.root, records.read_campaign(target.plan_file()), described)
    else:
        folders.require_empty(target.root)
        files.write_json(scratch, target.plan_file(), described)
    for receipt in records.receipts_in(target.root):
        for name in folders.wrong_files(target.root, records.read_receipt(receipt, described)["files"]):
            raise _bad_content(target.root / name)


def merge(sources: Sequence[StrPath], root: StrPath, durable: bool = True) -> Outcome:
    """Brings the parts of a campaign together and finishes it.

    Args:
        sources: folders of the parts.
        root: folder of the whole: one of the parts, or another.
        durable: as in run().

    Raises:
        Error: parts of different campaigns, and files that are not what their receipts say.
    """
    sources, root = [path_of(source, "part") for source in sources], path_of(root, "folder")
    if not sources:
        raise Error("parts", "there are none", "folders of parts of a campaign")
    described = folders.opened(sources[0])[1]
    for source in sources[1:]:
        folders.require_same(source, folders.opened(source)[1], described,
                             f"parts of one campaign, here that of {sources[0]}", "")
    target = Folder(Path(root), durable)
    with target.scratch() as scratch:
        _open_target(target, described, scratch)
        for source in map(Path, sources):
            if source.resolve() != target.root.resolve():
                for receipt in records.receipts_in(source):
                    _adopt_receipt(receipt, source, target.root, scratch, described)
                _adopt_logs(source, target.root)
    files.remove_leftovers(root)
    return _finished(target)


def _adopt_logs(source, target):
    for log in filter(names.is_log, (source / "log").glob("*.jsonl")):
        copied = target / "log" / log.name
        names.require_inside(source, log)
        names.require_inside(target, copied)
        try:
            copied.parent.mkdir(parents=True, exist_ok=True)
            files.copy(log, copied)
        except OSError as error:
            raise files.write_error(copied, error) from None


def check(root: StrPath) -> tuple[int, list[str]]:
    """Compares every file with the manifest: (how many there are, names of those that differ or are missing)."""
    folder, _ = folders.opened(root)
    listed = records.read_manifest(folder.root / finishing.MANIFEST_FILE)["files"]
    return len(listed), list(folders.wrong_files(folder.root, listed))
