# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The report: one HTML page that works offline."""

import base64
import io
import json
import os
import zipfile
import zlib
from html import escape
from pathlib import Path

import numpy as np
from PIL import Image

from glidar import Error
from glidar._errors import excerpt
from glidar._pictures import scale_of
from glidar.campaign import charts, files, folder as folders, index, names, npz_output, records, rotations
from glidar.campaign.beneath import Inside
from glidar.campaign.finish import MANIFEST_FILE

REPORT_FILE = "report.html"
EXAMPLES = 12
MAX_ERRORS = 20
NO_RETURN = 44, 44, 52  # the same as in PNG files
PICTURE = 160  # pixels along the longer side
KNOWN = {"trial", "shard", "ok", "error", "seed", "scene", "sensor"}
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem;
  color: #1b2733; }
h1, h2 { font-weight: 600; } h2 { margin-top: 2.2rem; border-bottom: 1px solid #d5dbe1; }
table { border-collapse: collapse; } td, th { padding: .2rem .8rem .2rem 0; text-align: left;
  vertical-align: top; } th { font-weight: 500; color: #51606e; }
figure { display: inline-block; margin: 0 1rem 1rem 0; vertical-align: top; }
figcaption { text-align: center; font-size: 13px; } small { color: #51606e; }
svg text { font-size: 11px; fill: #51606e; } svg rect { fill: #2c6e9b; }
svg polyline { fill: none; stroke: #2c6e9b; stroke-width: 1.6; }
.axis { fill: none; stroke: #9aa7b3; } img { image-rendering: pixelated; border: 1px solid #d5dbe1; }
code { font-size: 13px; } .bad { color: #a3231f; }
"""


def _table(rows):
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{value}</td></tr>" for name, value in rows)
    return f"<table>{cells}</table>"


def _code(text):
    return f"<code>{escape(str(text))}</code>"


def _names(inputs):
    errors = [f' <span class="bad">{escape("cannot be read")}</span>' if i["unreadable"] else ""
              for i in inputs]
    return ", ".join(_code(i["name"]) + error for i, error in zip(inputs, errors))


def _summary(manifest):
    plan = manifest["plan"]
    campaign = plan["campaign"]
    failed = f"{manifest['failed']} of {manifest['trials']}"
    versions = ", ".join(f"{name} {number}" for name, number in manifest["versions"].items())
    return _table([
        ("trials", str(manifest["trials"])),
        ("failed", f'<span class="bad">{failed}</span>' if manifest["failed"] else failed),
        ("scenes", _names(plan["scenes"])), ("sensors", _names(plan["sensors"])),
        ("sampling", escape(campaign["method"])), ("seed", str(campaign["seed"])),
        ("files", str(len(manifest["files"]))), ("campaign", _code(manifest["campaign"])),
        ("made by", escape(f"GLIDAR {plan['glidar']}, {versions}"))])


def _log_lines(folder, shards):
    room = (1 << 20) + (shards << 10)  # bytes: several runs whose shards all need several lines
    lines = []
    for path in filter(names.is_log, Inside(folder.root, "log").children()):
        data = files.read_bytes(path, room)
        room -= len(data)
        for text in data.decode("utf-8", "replace").splitlines():
            try:
                entry = json.loads(text)
            except (ValueError, RecursionError):
                continue  # an incomplete line of a killed process
            if _is_log_entry(entry):
                lines.append({**entry, "by": path.stem})
    return sorted(lines, key=lambda entry: entry["time_s"])


def _is_log_entry(entry):
    """Whether it has the reported numbers. Logs do not affect results, so invalid entries are skipped."""
    if not isinstance(entry, dict):
        return False
    keys = ("time_s", "seconds", "trials") if "shard" in entry else ("time_s",)
    values = [entry.get(key) for key in keys]
    return all(isinstance(value, (int, float)) and 0 <= value < 1e15 for value in values)


def _time_at_work(end_s, seconds):
    """The completion time of each shard by a clock that stops while no shard is in progress; ends are sorted."""
    start_s = np.minimum.accumulate((end_s - seconds)[::-1])[::-1]  # the earliest start of this and all later shards
    pause_s = np.maximum(start_s[1:] - end_s[:-1], 0.0)
    return end_s - start_s[0] - np.insert(np.cumsum(pause_s), 0, 0.0)


def _speed(folder, shards):
    """The speed of all runs together, relative to the time in which a shard was in progress."""
    try:
        lines = [entry for entry in _log_lines(folder, shards) if "shard" in entry]
    except Error as error:  # logs do not affect results
        return f"<p>The logs cannot be read: {escape(str(error))}</p>"
    if len(lines) < 2:
        return "<p>Too few shards for a speed.</p>"
    time_s = _time_at_work(np.array([entry["time_s"] for entry in lines]),
                           np.array([entry["seconds"] for entry in lines]))
    done = np.cumsum([entry["trials"] for entry in lines])
    rate = done[-1] / max(time_s[-1], 1e-9)
    by = sorted({entry["by"] for entry in lines})
    per_trial = np.array([1e3 * entry["seconds"] / max(entry["trials"], 1) for entry in lines])
    text = (f"<p>{done[-1]} trials in {time_s[-1]:.1f} s, without pauses between runs: {rate:.4g} trials/s "
            f"by {len(by)} processes ({escape(', '.join(by[:8]))}{' ...' if len(by) > 8 else ''}).</p>")
    return (text + charts.line("trials done over time, s", np.insert(time_s, 0, 0.0),
                               np.insert(done, 0, 0))
            + charts.histogram("ms per trial of a shard, from its start to its receipt", per_trial))


def _failures(table):
    errors = {}
    for trial, text in zip(table["trial"].to_pylist(), table["error"].to_pylist()):
        if text:
            errors.setdefault(text, []).append(trial)
    if not errors:
        return "<p>None.</p>"
    rows = []
    for text, trials in sorted(errors.items(), key=lambda pair: -len(pair[1]))[:MAX_ERRORS]:
        which = ", ".join(str(trial) for trial in trials[:8]) + (" ..." if len(trials) > 8 else "")
        rows.append(f"<tr><td>{len(trials)}</td><td>{which}</td><td>{_code(text)}</td></tr>")
    more = len(errors) - MAX_ERRORS
    note = f"<p>and {more} other errors, see index.parquet</p>" if more > 0 else ""
    return f"<table><tr><th>trials</th><th>which</th><th>why</th></tr>{''.join(rows)}</table>{note}"


def _position(table):
    return np.stack([table[name].to_numpy() for name in index.POSE[:3]], axis=1)


def _target(campaign):
    """The target of look_at, or the centre of the sensor's positions; else the world's origin."""
    pose = campaign["pose"]
    return np.array(pose["orientation"].get("target") or pose["position"].get("centre") or [0, 0, 0],
                    float)


def _single_value(values):
    """The value of all finite numbers; None when they differ or there are none."""
    finite = values[np.isfinite(values)]
    return float(finite[0]) if len(finite) and (finite == finite[0]).all() else None


def _columns(table, campaign):
    """(name, numbers) of everything that has a distribution."""
    ok = table["ok"].to_numpy(zero_copy_only=False)
    yield "distance from the target, m", np.linalg.norm(_position(table) - _target(campaign), axis=1)
    facts = set(index.FACTS)
    for name in table.column_names:
        if name in KNOWN or name in index.POSE:
            continue
        values = np.asarray(table[name].to_numpy(), float)
        yield name, values[ok] if name in facts else values


def _distributions(table, campaign):
    """Charts of values that differ between trials, and a list of the others."""
    parts, constants = [], []
    for name, values in _columns(table, campaign):
        value = _single_value(values)
        if value is None:
            parts.append(charts.histogram(name, values))
        else:
            constants.append(f"{name} = {value:.6g}")
    for name in ("scene", "sensor"):
        words, counts = np.unique(table[name].to_numpy(), return_counts=True)
        if len(words) > 1:
            parts.append(charts.bars(name, [str(w) for w in words], [int(c) for c in counts]))
    if constants:
        parts.append(f"<p><small>The same in all trials: {escape('; '.join(constants))}.</small></p>")
    return "".join(parts)


def _unit(vectors):
    length = np.linalg.norm(vectors, axis=1)
    return vectors[length > 0] / length[length > 0, None]


def _coverage(table, campaign):
    target = _target(campaign)
    seen_from = _unit(_position(table) - target)
    q = np.stack([table[name].to_numpy() for name in index.POSE[3:]], axis=1)
    forward = rotations.matrices(q)[:, :, 2]
    around = f"around [{', '.join(f'{a:g}' for a in target)}]; the centre of the map is +x, the top +z"
    parts = [charts.sphere("positions of the sensor", seen_from, around)] if len(seen_from) else []
    parts.append(charts.sphere("directions of the sensor's z axis", forward, "in the world"))
    return "".join(parts)


def _colour_picture(values, column):
    """The image and its scale in words. As in all pictures of GLIDAR, near is bright and pixels without a return are
    dark grey; outliers do not determine the scale."""
    values = np.asarray(values, float)
    seen = np.isfinite(values) & (values > 0)
    is_distance = column != "intensity"
    scale = scale_of(values[seen], from_zero=not is_distance)
    pixels = np.full((*values.shape, 3), NO_RETURN, np.uint8)
    span = scale.high - scale.low
    share = np.clip((values[seen] - scale.low) / span, 0, 1) if span > 0 else (values[seen] > scale.low) * 1.0
    pixels[seen] = charts.colours(1.0 - share) if is_distance else np.rint(255 * share).astype(np.uint8)[:, None]
    return Image.fromarray(pixels), " to ".join(scale.ends("m" if is_distance else ""))


def _shown(image):
    """An <img> of similar size for any sensor."""
    scale = PICTURE / max(image.size)
    size = tuple(max(1, round(side * scale)) for side in image.size)
    buffer = io.BytesIO()
    image.resize(size, Image.Resampling.NEAREST).save(buffer, "png", optimize=True)
    data = base64.b64encode(buffer.getvalue()).decode()
    return f'<img src="data:image/png;base64,{data}" width="{size[0]}" height="{size[1]}" alt="">'


def _pick(path, trial):
    """(title, image, its scale) of a trial of an NPZ shard."""
    try:
        with npz_output.opened(path) as file:
            return _picked(file, trial)
    except (ValueError, OSError, IndexError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise Error(str(path), f"it is not an NPZ shard: {excerpt(error)}", "a file that glidar campaign wrote",
                    "glidar campaign check lists the files that differ") from None


def _picked(file, trial):
    for key in file.files:
        prefix = key[: -len("trial")] if key.endswith("trial") else None
        if prefix is None or trial not in file[key]:
            continue
        row = int(np.flatnonzero(file[key] == trial)[0])
        for column in ("depth", "range", "intensity"):
            if prefix + column in file.files:
                return column, *_colour_picture(file[prefix + column][row], column)
    return None


def _examples(folder, table, described):
    trials = table["trial"].to_numpy()[table["ok"].to_numpy(zero_copy_only=False)]
    if len(trials) == 0:
        return "<p>No trial succeeded.</p>"
    by_trial = dict(zip(table["trial"].to_pylist(), table["shard"].to_pylist()))
    chosen = np.unique(trials[np.linspace(0, len(trials) - 1, EXAMPLES).astype(int)])
    parts = []
    for trial in chosen:
        receipt = records.read_receipt(folder.receipt(by_trial[trial]), described)
        shards = [n for n in receipt["files"] if n.startswith("npz/")]
        if not shards:
            return "<p>Example views require NPZ shards, which this campaign does not write.</p>"
        found = _pick(folder.place(shards[0]), trial)
        if found:
            parts.append(charts.figure(f"trial {trial}: {found[0]}", _shown(found[1]), found[2]))
    return "".join(parts) or "<p>The NPZ shards contain neither depth, range nor intensity.</p>"


def page(root: str | os.PathLike[str]) -> str:
    """The HTML of the report."""
    folder, described = folders.opened(root)
    if not folder.place(MANIFEST_FILE).is_file():
        raise Error(str(root), "the campaign is not finished", "a folder with manifest.json",
                    "run glidar campaign run again, or merge its parts")
    manifest = records.read_manifest(folder.place(MANIFEST_FILE))
    campaign = manifest["plan"]["campaign"]
    table = index.read(folder.place(index.INDEX_FILE), described["trials"])
    sections = [("Summary", _summary(manifest)), ("Failures", _failures(table)),
                ("Distributions", _distributions(table, campaign)),
                ("Coverage", _coverage(table, campaign)),
                ("Example views", _examples(folder, table, described)),
                ("Speed", _speed(folder, described["shards"]))]
    body = "".join(f"<h2>{title}</h2>{content}" for title, content in sections)
    name = escape(campaign["name"])
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
            f"<style>{STYLE}</style></head><body><h1>Campaign {name}</h1>{body}</body></html>\n")


def _require_foreign(root, path):
    """Raises Error when the report would replace a file of the campaign."""
    root, path = Path(root).resolve(), path.resolve()
    if not path.is_relative_to(root):
        return
    name = path.relative_to(root)
    listed = records.read_manifest(Inside(root) / MANIFEST_FILE)["files"]
    if name.as_posix() in [*listed, MANIFEST_FILE] or name.parts[:1] in [("receipts",), ("parts",), ("log",)]:
        raise Error(str(path), "it is a file of the campaign", "another name",
                    f"without -o the report is {root / REPORT_FILE}")


def _write_whole(path, text):
    """Writes a regular file atomically, and others, such as a pipe, directly. So are links, which stay: /dev/stdout is one."""
    if path.is_symlink() or path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def write(root: str | os.PathLike[str], path: str | os.PathLike[str] | None = None) -> Path:
    """Writes the report; returns its path."""
    text = page(root)
    own = Inside(root) / REPORT_FILE
    path = Path(path) if path else own.path
    try:
        if path == own.path:
            own.write(text)
            return path
        _require_foreign(root, path)
        _write_whole(path, text)
    except OSError as error:
        raise files.write_error(path, error) from None
    return path
