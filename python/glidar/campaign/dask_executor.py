# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs shards on Dask workers, which access the campaign's folder by the same path.

When a worker dies, Dask passes its task to another one, which skips shards that have a receipt.
"""

import dataclasses

from glidar import Error
from glidar.campaign import folder as folders, work as works

TASKS_PER_WORKER = 4  # so that all workers finish at about the same time
CONNECT_S = 10


def run_shards(plan, folder, shards):
    """The task of one thread of a worker; returns the results of its shards."""
    done = []
    works.work(plan, folder, folders.missing(folder, shards), 1, done.append)
    known = {d.shard: d for d in done}
    return [known.get(shard) or works.result_of(folder, shard) for shard in shards]


def _tasks(shards, count):
    """Consecutive shards, divided into tasks of similar length."""
    length = max(1, len(shards) // max(1, count))
    return [shards[i : i + length] for i in range(0, len(shards), length)]


def dask_executor(address):
    """An executor for the workers of the scheduler at this address."""
    from distributed import CancelledError, Client, KilledWorker, as_completed

    if not address:
        raise Error("--executor dask", "no scheduler is given", "", "add --scheduler tcp://HOST:8786")

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
                raise Error("--executor dask", f"the connection to workers or scheduler was lost ({error})", "",
                            "run the same command again to resume") from None

    return execute
