# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs shards on the cores of this machine, in worker processes that may die."""

import multiprocessing
import os
import sys
from collections import deque
from multiprocessing import connection

from glidar import Error
from glidar.campaign import work as works
from glidar.campaign.progress import print_warnings

SHARDS_PER_WORKER = 2  # one is measured while another is written
MAX_DEATHS = 3  # of workers that ran the same shard
WAIT_S = 0.2  # for a shard, before a worker checks its writer thread for errors
MISSING_GUARD = 87  # exit code of a worker whose script calls run() when it is imported


def require_guard():
    """Ends a worker process whose main script, which it imports at start, runs the campaign again."""
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(MISSING_GUARD)


def cores():
    return len(os.sched_getaffinity(0))


def default_workers(plan):
    """One process, which measures with all cores, when trials share their scene and sensor; else one per core,
    because one core prepares each scene."""
    texts = [v for v in plan.spec.vary if not v.is_pose]
    return cores() if texts or len(plan.scenes) * len(plan.sensors) > 1 else 1


def _serve(plan, folder, threads, pipe):
    """A worker process: receives shards through the pipe and sends results back; None ends it."""
    def shards():
        while True:
            if not pipe.poll(WAIT_S):
                yield None
            elif (shard := pipe.recv()) is not None:
                yield shard
            else:
                return

    print_warnings()
    try:
        works.work(plan, folder, shards(), threads, lambda done: pipe.send(("done", done)))
        pipe.send(("end", None))
    except Error as error:
        pipe.send(("error", (error.where, error.found, error.allowed, error.remedy)))
    except (EOFError, BrokenPipeError, KeyboardInterrupt):
        pass  # the main process ended
    except Exception as error:  # raised again by the main process
        pipe.send(("exception", error))


class _Worker:
    def __init__(self, context, plan, folder, threads):
        self.pipe, theirs = context.Pipe()
        self.shards = []
        self.is_ending = False
        self.process = context.Process(target=_serve, args=(plan, folder, threads, theirs), daemon=True)
        self.process.start()
        theirs.close()

    def feed(self, waiting):
        """Keeps the worker busy; without further shards, requests its end."""
        while waiting and len(self.shards) < SHARDS_PER_WORKER:
            self.shards.append(waiting.popleft())
            self.pipe.send(self.shards[-1])
        if not waiting and not self.shards and not self.is_ending:
            self.is_ending = True
            self.pipe.send(None)


class _Pool:
    def __init__(self, plan, folder, report, threads):
        self._plan, self._folder, self._report, self._threads = plan, folder, report, threads
        self._context = multiprocessing.get_context("spawn")
        self._deaths = {}
        self.workers = []

    def start(self):
        self.workers.append(_Worker(self._context, self._plan, self._folder, self._threads))

    def run(self, shards, count):
        waiting = deque(shards)
        for _ in range(min(count, len(waiting))):
            self.start()
        for worker in self.workers:
            self._feed(worker, waiting)
        while self.workers:
            ready = connection.wait([worker.pipe for worker in self.workers])
            for worker in [w for w in self.workers if w.pipe in ready]:
                self._receive(worker, waiting)

    def _feed(self, worker, waiting):
        try:
            worker.feed(waiting)
        except (BrokenPipeError, ConnectionResetError):
            pass  # its death is reported next

    def _receive(self, worker, waiting):
        try:
            kind, content = worker.pipe.recv()
        except (EOFError, ConnectionResetError):
            kind, content = "death", None
        if kind == "death":
            self._replace_dead(worker, waiting)
            return
        if kind == "error":
            raise Error(*content)
        if kind == "exception":
            raise content
        if kind == "end":
            self.workers.remove(worker)
            worker.process.join()
            return
        worker.shards.remove(content.shard)
        self._report(content)
        self._feed(worker, waiting)

    def _replace_dead(self, worker, waiting):
        """Handles the death of a worker: its shards go to others."""
        worker.process.join()
        self.workers.remove(worker)
        if worker.process.exitcode == MISSING_GUARD:
            raise Error(str(getattr(sys.modules["__main__"], "__file__", "run()")),
                        "it runs the campaign when it is imported, and every worker process imports it",
                        "the call within: if __name__ == \"__main__\":", "workers=1 needs no other process")
        for shard in worker.shards:
            self._deaths[shard] = self._deaths.get(shard, 0) + 1
            if self._deaths[shard] == MAX_DEATHS:
                first, trials = self._plan.trials_of(shard)
                raise Error(f"trials {first} to {first + trials - 1}",
                            f"the worker that measured them died {MAX_DEATHS} times "
                            f"(exit code {worker.process.exitcode})", "",
                            "check the available memory; fewer --workers need less")
        waiting.extendleft(reversed(worker.shards))
        if waiting:
            self.start()
            self._feed(self.workers[-1], waiting)

    def stop(self):
        for worker in self.workers:
            worker.process.kill()
            worker.process.join()


def run_local(plan, folder, shards, report, workers):
    """Runs the shards with `workers` processes, which share the cores; 1: this process; 0: the default."""
    workers = workers or default_workers(plan)
    if workers == 1 or len(shards) == 1:
        works.work(plan, folder, shards, 0, report)
        return
    pool = _Pool(plan, folder, report, max(1, cores() // workers))
    try:
        pool.run(shards, workers)
    finally:
        pool.stop()
