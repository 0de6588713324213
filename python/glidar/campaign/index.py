# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The index: one row per trial, as Parquet."""

import contextlib
from collections import Counter

import numpy as np

from glidar import Error
from glidar._errors import excerpt
from glidar.campaign import files, pages, records, rotations

INDEX_FILE = "index.parquet"
FACTS = ["beams", "hits", "range_min_m", "range_max_m", "intensity_mean"]
POSE = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
HIT = 0  # value in the column status
NO_BEAM = 4
WRITE_BYTES = 1 << 20  # size of the buffer for writing
TEXTS = ["error", "scene", "sensor"]
MAX_TEXT_BYTES = 1 << 12  # of a row in one column, on average
MAX_ROW_BYTES = 1 << 16
MIN_TABLE_BYTES = 1 << 24


def facts_of(frame):
    """Summary values of a frame, in the order of FACTS; NaN without hits."""
    status, range_m, intensity = frame.status, frame.range_m, frame.intensity
    hits = int(np.count_nonzero(status == HIT))
    beams = status.size - int(np.count_nonzero(status == NO_BEAM))
    if hits == 0:
        return beams, 0, np.nan, np.nan, np.nan
    # fmin and fmax skip NaN, the range of beams without a return
    return (beams, hits, np.fmin.reduce(range_m, axis=None), np.fmax.reduce(range_m, axis=None),
            float(intensity.sum(dtype=np.float64)) / hits)


def _varied(plan, trials):
    """Columns of the varied values; a pose has seven."""
    columns = {}
    for variation in plan.spec.vary:
        values = trials.values[variation.path]
        if variation.is_pose:
            columns.update(_pose_columns(values, f"{variation.path}."))
        else:
            columns[variation.path] = np.asarray(values, np.float64)
    return columns


def _pose_columns(poses, prefix=""):
    numbers = np.concatenate([poses[:, :3, 3], rotations.quaternions(poses[:, :3, :3])], axis=1)
    return {prefix + name: np.ascontiguousarray(numbers[:, i]) for i, name in enumerate(POSE)}


def rows(plan, shard, trials, errors, facts):
    """The shard's rows of the index as a table."""
    import pyarrow as pa

    count = len(trials)
    scenes = [source.name for source in plan.scenes]
    sensors = [source.name for source in plan.sensors]
    columns = {
        "trial": trials.number.astype(np.int64),
        "shard": np.full(count, shard, np.int32),
        "ok": np.array([not text for text in errors]),
        "error": errors,
        "seed": trials.seed,
        "scene": [scenes[i] for i in trials.scene],
        "sensor": [sensors[i] for i in trials.sensor],
        **_pose_columns(trials.world_from_sensor),
        **_varied(plan, trials),
    }
    for i, name in enumerate(FACTS):
        whole = name in ("beams", "hits")
        columns[name] = np.nan_to_num(facts[:, i]).astype(np.int64) if whole else facts[:, i]
    return pa.table(columns)


def _buffered(path):
    """The file for writing. Arrow writes a column in many small pieces, each a system call without the buffer."""
    import pyarrow as pa

    return pa.output_stream(path, compression=None, buffer_size=WRITE_BYTES)


def write_part(path, table):
    import pyarrow.parquet as pq

    with _buffered(path) as sink:
        pq.write_table(table, sink, compression="zstd")


def join(parts, path):
    """Concatenates the tables of all parts in order, with only one in memory."""
    import pyarrow.parquet as pq

    with contextlib.ExitStack() as stack:
        writer = None
        for table in parts:
            if writer and table.schema != writer.schema:
                raise Error(f"part of trial {table['trial'][0]}", "its columns differ from those of the other parts",
                            "parts of one campaign", "remove its receipt and run the part again")
            if writer is None:
                sink = stack.enter_context(_buffered(path))
                writer = stack.enter_context(pq.ParquetWriter(sink, table.schema, compression="zstd"))
            writer.write_table(table)


def count_errors(parts):
    """How often each error text occurs in the tables of parts."""
    counts = Counter()
    for table in parts:
        counts.update(text for text in table["error"].to_pylist() if text)
    return counts


def batches(path, columns=None):
    """The index in batches, each a table."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    with files.open_input(path) as opened, _native(opened) as source, pq.ParquetFile(source) as file:
        for batch in file.iter_batches(columns=columns):
            yield pa.table(batch)


def _native(opened):
    """The same file for Arrow alone. Arrow's threads keep their source a little longer. With a Python file object, a
    thread that releases it while Python exits would abort the program (apache/arrow issue 34314)."""
    import pyarrow as pa

    return pa.OSFile(f"/proc/self/fd/{opened.fileno()}")


def _no_index(path, what):
    return Error(str(path), f"it is not an index of trials: {excerpt(what)}", "a file that glidar campaign wrote",
                 "glidar campaign check lists the files that differ")


def _check_size(path, opened, metadata, rows):
    """Raises Error unless the file claims this number of rows, and its pages have a size that rows can have."""
    if metadata.num_rows != rows:
        raise Error(str(path), f"{metadata.num_rows} rows", f"{rows}, one for each trial",
                    "copy the part again from its source; this one may be corrupt or forged")
    size = pages.uncompressed_bytes(opened, metadata)
    allowed = MIN_TABLE_BYTES + rows * MAX_ROW_BYTES
    if size > allowed:
        raise Error(str(path), f"a table of {size >> 20} MiB", f"at most {allowed >> 20} MiB for {rows} rows", "")


def read(path, rows):
    """An index or a part of one with this number of rows, after checking the columns that all of them have. The others
    have numbers."""
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    try:
        with files.open_input(path) as opened, _native(opened) as source:
            with pq.ParquetFile(source) as file:
                _check_size(path, opened, file.metadata, rows)
                _check_columns(path, file.schema_arrow)
            # texts as dictionaries: a long one that is repeated needs its memory once
            table = pq.read_table(source, read_dictionary=TEXTS)
    except (pa.ArrowException, OSError, ValueError) as error:  # ValueError: malformed pages, names that are not UTF-8
        raise _no_index(path, error) from None
    for name in [*TEXTS, *POSE, "trial", "shard", "ok"]:
        if table[name].null_count:
            raise _no_index(path, f"column {name} has gaps")
    for name in POSE:
        if pc.any(pc.is_inf(table[name])).as_py():  # NaN: the trial failed because it has no pose
            raise _no_index(path, f"column {name} has an infinite number")
    if table.num_rows != rows:
        raise _no_index(path, f"{table.num_rows} rows instead of {rows}")
    return _with_plain_texts(path, table)


def _check_columns(path, schema):
    import pyarrow as pa

    kinds = {"trial": pa.types.is_integer, "shard": pa.types.is_integer, "ok": pa.types.is_boolean}
    kinds |= dict.fromkeys(POSE, pa.types.is_floating) | dict.fromkeys(TEXTS, pa.types.is_string)
    for name, is_right in kinds.items():
        if schema.names.count(name) != 1 or not is_right(schema.field(name).type):
            raise _no_index(path, f"column {name}")
    for field in schema:
        if field.name not in kinds and not (pa.types.is_integer(field.type) or pa.types.is_floating(field.type)):
            raise _no_index(path, f"column {field.name}")


def _with_plain_texts(path, table):
    import pyarrow as pa
    import pyarrow.compute as pc

    for name in TEXTS:
        column = table[name]
        if pa.types.is_dictionary(column.type):
            size = sum(pc.sum(pc.take(pc.binary_length(chunk.dictionary), chunk.indices)).as_py() or 0
                       for chunk in column.chunks)
            if size > MIN_TABLE_BYTES + table.num_rows * MAX_TEXT_BYTES:
                raise _no_index(path, f"column {name} has {size >> 20} MiB of text")
            table = table.set_column(table.schema.get_field_index(name), name, column.cast(pa.string()))
    return table


def read_part(path, described, receipt):
    """The rows of a shard, which must be those of its receipt's trials; `described`: campaign.json."""
    trials = records.shard_trials(described, receipt["shard"])
    table = read(path, len(trials))
    failed = len(trials) - sum(table["ok"].to_pylist())
    for name, is_right in (("trial", table["trial"].to_pylist() == list(trials)),
                           ("shard", set(table["shard"].to_pylist()) == {receipt["shard"]}),
                           ("ok", failed == receipt["failed"])):
        if not is_right:
            raise Error(str(path), f"its column {name} differs from its receipt",
                        f"trials {trials[0]} to {trials[-1]} of shard {receipt['shard']}, of which {receipt['failed']} failed",
                        "copy the part again from its source; this one may be corrupt or forged")
    return table
