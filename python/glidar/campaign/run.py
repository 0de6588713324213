# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign from its file to its folder, by any executor; and parts of it merged."""

import os
import shutil
from dataclasses import dataclass
from pathlib import Path

from glidar import Error
from glidar.campaign import bop_models, files, finish as finishing, folder as folders
from glidar.campaign.folder import Folder
from glidar.campaign.local import run_local
from glidar.campaign.plan import make_plan
from glidar.campaign.progress import Progress
from glidar.campaign.spec import read_spec


@dataclass(frozen=True)
class Part:
    """Of the shards, those whose number leaves this remainder: part `index` of `count`."""

    index: int = 0
    count: int = 1

    def shards(self, total):
        return list(range(self.index, total, self.count))


@dataclass(frozen=True)
class Outcome:
    """What a run left behind."""

    trials: int
    failed: int
    whole: bool  # the campaign is complete, with index and manifest
    missing: int = 0  # shards that are not there yet
    rate: float = 0.0  # trials a second of this run


def prepare(spec_path, root):
    """Reads the campaign and claims its folder."""
    plan = make_plan(read_spec(spec_path))
    folder = Folder(Path(root))
    folders.claim(folder, plan)
    files.remove_leftovers(root)
    if plan.spec.outputs.bop and not folder.once("bop").is_file():
        bop_models.write(plan, folder)
    return plan, folder


def _counts(folder, shards):
    """(trials, failed) of shards that are done."""
    receipts = [files.read_json(folder.receipt(shard)) for shard in shards]
    return sum(r["trials"] for r in receipts), sum(r["failed"] for r in receipts)


def run(spec_path, root, part=Part(), workers=0, execute=None, quiet=False):
    """Measures what is missing of a part of the campaign, and finishes the campaign when nothing
    is. `execute(plan, folder, shards, report)` runs the shards; default: this machine's cores."""
    plan, folder = prepare(spec_path, root)
    wanted = part.shards(plan.shards)
    todo = folders.missing(folder, wanted)
    done, failed = _counts(folder, sorted(set(wanted) - set(todo)))
    total = sum(plan.trials_of(shard)[1] for shard in wanted)
    progress = Progress(total, done, quiet)
    progress.failed = failed
    if todo:
        if execute:
            execute(plan, folder, todo, lambda d: progress.advance(d.trials, d.failed))
        else:
            run_local(plan, folder, todo, lambda d: progress.advance(d.trials, d.failed), workers)
    progress.finish()
    if part.count > 1:
        return Outcome(progress.done, progress.failed, False, 0, progress.rate())
    return _finished(folder, progress.rate())


def _finished(folder, rate=0.0):
    described = files.read_json(folder.plan_file())
    missing = folders.missing(folder, range(described["shards"]))
    if missing:
        return Outcome(0, 0, False, len(missing), rate)
    trials, failed = finishing.finish(folder, described)
    return Outcome(trials, failed, True, 0, rate)


def _adopt(name, entry, source, target, scratch):
    """Takes a file over from another folder, if it is what its receipt says."""
    digest, size = entry
    if (target / name).is_file() and (target / name).stat().st_size == size:
        return
    path = scratch.path(Path(name).name)
    try:
        shutil.copyfile(source / name, path)
    except OSError as error:
        raise files.write_error(target / name, error) from None
    if files.hash_file(path) != digest:
        path.unlink()
        raise Error(str(source / name), "its content is not what its receipt says",
                    "files as they were written", "remove its receipt and run that part again")
    files.publish(path, target / name)


def _adopt_receipt(receipt, source, target, scratch):
    """Takes over all files of a receipt, and then the receipt."""
    relative = receipt.relative_to(source)
    content = files.read_json(receipt)
    known = target / relative
    if known.is_file():
        if files.read_json(known) != content:
            raise Error(str(receipt), f"it differs from {known}", "parts of one campaign give the "
                        "same shard the same content", "were they run by the same versions?")
        return
    for name, entry in sorted(content["files"].items()):
        _adopt(name, entry, source, target, scratch)
    files.write_bytes(scratch, known, receipt.read_bytes())


def merge(sources, root):
    """Brings the parts of a campaign together and finishes it."""
    described = folders.opened(sources[0])[1]
    for source in sources[1:]:
        other = folders.opened(source)[1]
        if other["hash"] != described["hash"]:
            raise Error(str(source), "it holds another campaign than " + str(sources[0]) + ": "
                        + folders.difference(described["plan"], other["plan"]),
                        "parts of one campaign", "")
    target = Folder(Path(root))
    scratch = files.Scratch(target.root)
    if not target.plan_file().is_file():
        if target.root.is_dir() and os.listdir(target.root):
            raise Error(str(root), "the folder is not empty and holds no campaign",
                        "a new folder, or that of this campaign", "choose another with -o")
        files.write_bytes(scratch, target.plan_file(),
                          Folder(Path(sources[0])).plan_file().read_bytes())
    elif files.read_json(target.plan_file())["hash"] != described["hash"]:
        raise Error(str(root), "it holds another campaign", "a new folder, or that of this campaign",
                    "choose another with -o")
    for source in map(Path, sources):
        if source.resolve() != target.root.resolve():
            for receipt in sorted((source / "receipts").glob("*.json")):
                _adopt_receipt(receipt, source, target.root, scratch)
            _adopt_logs(source, target.root)
    scratch.remove()
    return _finished(target)


def _adopt_logs(source, target):
    for log in (source / "log").glob("*.jsonl"):
        (target / "log").mkdir(parents=True, exist_ok=True)
        shutil.copyfile(log, target / "log" / log.name)


def check(root):
    """Names of files that differ from the manifest, or are missing."""
    folder, _ = folders.opened(root)
    manifest = files.read_json(folder.root / finishing.MANIFEST_FILE)
    wrong = []
    for name, (digest, size) in manifest["files"].items():
        path = folder.root / name
        if not path.is_file() or path.stat().st_size != size or files.hash_file(path) != digest:
            wrong.append(name)
    return len(manifest["files"]), wrong
