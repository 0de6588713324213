# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Shards on Dask's workers, which see the campaign's folder under the same path.

A worker may die: Dask gives its task to another, and shards with a receipt are passed over.
"""

import dataclasses

from glidar import Error
from glidar.campaign import folder as folders, work as works

TASKS_PER_WORKER = 4  # so that the last ones end together
CONNECT_S = 10


def run_shards(plan, folder, shards):
    """The task of one thread of a worker: what each of the shards came to."""
    done = []
    works.work(plan, folder, folders.missing(folder, shards), 1, done.append)
    known = {d.shard: d for d in done}
    return [known.get(shard) or works.recall(folder, shard) for shard in shards]


def _tasks(shards, count):
    """Runs of shards of much the same length."""
    length = max(1, len(shards) // max(1, count))
    return [shards[i : i + length] for i in range(0, len(shards), length)]


def dask_executor(address):
    """Runs shards on the workers of the scheduler at this address."""
    from distributed import CancelledError, Client, KilledWorker, as_completed

    if not address:
        raise Error("--executor dask", "no scheduler is named", "", "give --scheduler tcp://HOST:8786")

    def execute(plan, folder, shards, report):
        try:
            client = Client(address, timeout=CONNECT_S, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise Error("--scheduler", f"no Dask scheduler answers at {address} ({error})", "",
                        "start it with: dask scheduler") from None
        with client:
            workers = max(1, sum(client.nthreads().values()))
            absolute = dataclasses.replace(folder, root=folder.root.resolve())
            futures = [client.submit(run_shards, plan, absolute, run, pure=False)
                       for run in _tasks(shards, TASKS_PER_WORKER * workers)]
            try:
                for future in as_completed(futures, loop=client.loop):
                    for done in future.result():
                        report(done)
            except (KilledWorker, CancelledError) as error:
                raise Error("--executor dask", f"workers or scheduler were lost ({error})", "",
                            "run the same command again: it goes on where it stopped") from None

    return execute
