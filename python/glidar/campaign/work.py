# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures shards in this thread and writes them in another one, concurrently."""

import queue
import threading
import time
from dataclasses import dataclass

from glidar.campaign import folder as folders, records
from glidar.campaign.measure import Measurer
from glidar.campaign.shard_writer import ShardWriter
from glidar.campaign.trials import draw_trials

MAX_QUEUED_BATCHES = 2
ABANDONED = "abandoned"


@dataclass(frozen=True)
class ShardResult:
    """The result of a completed shard."""

    shard: int
    trials: int
    failed: int
    seconds: float


class WriterStopped(Exception):
    """The writer thread failed; its exception is raised instead."""


class Writer:
    """The writer thread. Its exceptions are raised by the next call."""

    def __init__(self, plan, folder, report):
        self._plan, self._folder, self._report = plan, folder, report
        self._batches = queue.Queue(MAX_QUEUED_BATCHES)
        self._error = None
        self._thread = threading.Thread(target=self._run, name="campaign writer", daemon=True)
        self._thread.start()

    def put(self, batch):
        while self._error is None:
            try:
                self._batches.put(batch, timeout=0.1)
                return
            except queue.Full:
                continue
        raise WriterStopped

    def check(self):
        if self._error is not None:
            raise WriterStopped

    def abandon(self):
        """Ends without completing the current shard."""
        try:
            self.put(ABANDONED)
        except WriterStopped:
            pass
        self._thread.join()

    def close(self):
        """Waits until everything is written; raises the exception of the thread."""
        try:
            self.put(None)
        except WriterStopped:
            pass
        self._thread.join()
        if self._error is not None:
            raise self._error

    def _run(self):
        try:
            with self._folder.temp_folder() as temp:
                while (batch := self._next()) is not None:
                    self._write_shard(temp, *batch)
        except BaseException as error:  # raised again by the caller's thread
            self._error = error

    def _next(self):
        batch = self._batches.get()
        if batch is ABANDONED:
            raise WriterStopped
        return batch

    def _write_shard(self, temp, shard, trials, start):
        writer = ShardWriter(self._plan, self._folder, temp, shard, trials)
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
        done = ShardResult(shard, count, failed, time.monotonic() - start)
        folders.append_log(self._folder, shard=shard, trials=count, failed=failed,
                     seconds=round(done.seconds, 6))
        self._report(done)


def work(plan, folder, shards, threads, report):
    """Measures and writes the shards of an iterable one after the other. The iterable yields None while it waits for
    the next shard. `report` is called with each ShardResult, in the writer's thread. `threads` 0: one per core."""
    measurer = Measurer(plan, threads)
    writer = Writer(plan, folder, report)
    try:
        for shard in shards:
            if shard is None:
                writer.check()
                continue
            trials = draw_trials(plan, *plan.trials_of(shard))
            writer.put((shard, trials, time.monotonic()))
            for batch in measurer.measure(trials):
                writer.put(batch)
    except WriterStopped:
        pass
    except BaseException:
        writer.abandon()
        raise
    writer.close()


def result_of(folder, shard):
    """The result of a shard that was completed before."""
    receipt = records.read_receipt(folder.receipt(shard), records.read_campaign(folder.plan_file()))
    return ShardResult(shard, receipt["trials"], receipt["failed"], 0.0)
