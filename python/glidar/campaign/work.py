# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures shards in this thread and writes them in another, so that neither waits for the other."""

import queue
import threading
import time
from dataclasses import dataclass

from glidar.campaign import folder as folders, records
from glidar.campaign.measure import Measurer
from glidar.campaign.shard_writer import ShardWriter
from glidar.campaign.trials import draw_trials

PIECES_WAITING = 2  # batches of frames that may wait to be written
ABANDONED = "abandoned"


@dataclass(frozen=True)
class Done:
    """A shard that lies in the folder, receipt and all."""

    shard: int
    trials: int
    failed: int
    seconds: float


class Stopped(Exception):
    """The writer failed; its fault is raised in its place."""


class Writer:
    """The thread that writes. What it raises comes out of the next call."""

    def __init__(self, plan, folder, report):
        self._plan, self._folder, self._report = plan, folder, report
        self._pieces = queue.Queue(PIECES_WAITING)
        self._fault = None
        self._thread = threading.Thread(target=self._run, name="campaign writer", daemon=True)
        self._thread.start()

    def put(self, piece):
        while self._fault is None:
            try:
                self._pieces.put(piece, timeout=0.1)
                return
            except queue.Full:
                continue
        raise Stopped

    def check(self):
        if self._fault is not None:
            raise Stopped

    def abandon(self):
        """Ends without the shard under way."""
        try:
            self.put(ABANDONED)
        except Stopped:
            pass
        self._thread.join()

    def close(self):
        """Waits until all is written; raises what went wrong."""
        try:
            self.put(None)
        except Stopped:
            pass
        self._thread.join()
        if self._fault is not None:
            raise self._fault

    def _run(self):
        try:
            with self._folder.scratch() as scratch:
                while (piece := self._next()) is not None:
                    self._write_shard(scratch, *piece)
        except BaseException as fault:  # it is raised again where the shards come from
            self._fault = fault

    def _next(self):
        piece = self._pieces.get()
        if piece is ABANDONED:
            raise Stopped
        return piece

    def _write_shard(self, scratch, shard, trials, start):
        writer = ShardWriter(self._plan, self._folder, scratch, shard, trials)
        left = len(trials)
        while left:
            rows, frames, error = self._next()
            for i, row in enumerate(rows):
                if error:
                    writer.fail(row, error)
                else:
                    writer.add(row, frames[i])
            left -= len(rows)
        count, failed = writer.commit()
        done = Done(shard, count, failed, time.monotonic() - start)
        folders.note(self._folder, shard=shard, trials=count, failed=failed,
                     seconds=round(done.seconds, 6))
        self._report(done)


def work(plan, folder, shards, threads, report):
    """Measures and writes the shards, an iterable, one after the other; it gives None now and then where it waits
    for the next. `report` hears of each Done, in the writer's thread. `threads` 0: as many as there are cores."""
    measurer = Measurer(plan, threads)
    writer = Writer(plan, folder, report)
    try:
        for shard in shards:
            if shard is None:
                writer.check()
                continue
            trials = draw_trials(plan, *plan.trials_of(shard))
            writer.put((shard, trials, time.monotonic()))
            for piece in measurer.measure(trials):
                writer.put(piece)
    except Stopped:
        pass
    except BaseException:
        writer.abandon()
        raise
    writer.close()


def recall(folder, shard):
    """The Done of a shard that was done before."""
    receipt = records.read_receipt(folder.receipt(shard), records.read_campaign(folder.plan_file()))
    return Done(shard, receipt["trials"], receipt["failed"], 0.0)
