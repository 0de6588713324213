# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The report: one HTML page that needs no network."""

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
from glidar.campaign import charts, files, folder as folders, index, npz_output, records, rotations
from glidar.campaign.finish import MANIFEST_FILE

REPORT_FILE = "report.html"
EXAMPLES = 12
MOST_FAULTS = 20
NO_RETURN = 44, 44, 52  # as in PNG files
PICTURE = 160  # pixels, of the longer side
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
    faults = [f' <span class="bad">{escape("cannot be read")}</span>' if i["fault"] else ""
              for i in inputs]
    return ", ".join(_code(i["name"]) + fault for i, fault in zip(inputs, faults))


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


def _log_lines(folder):
    lines = []
    for path in sorted((folder.root / "log").glob("*.jsonl")):
        for text in files.read_bytes(path, files.MOST_JSON_BYTES).decode("utf-8", "replace").splitlines():
            try:
                entry = json.loads(text)
            except (ValueError, RecursionError):
                continue  # the last line of a killed process
            if _is_log_entry(entry):
                lines.append({**entry, "by": path.stem})
    return sorted(lines, key=lambda entry: entry["time_s"])


def _is_log_entry(entry):
    """Whether it has the numbers that are reported; logs say nothing about results, so others are passed over."""
    if not isinstance(entry, dict):
        return False
    keys = ("time_s", "seconds", "trials") if "shard" in entry else ("time_s",)
    values = [entry.get(key) for key in keys]
    return all(isinstance(value, (int, float)) and 0 <= value < 1e15 for value in values)


def _time_at_work(end_s, seconds):
    """When each shard was done, by a clock that stands while none is under way; ends are in order."""
    start_s = np.minimum.accumulate((end_s - seconds)[::-1])[::-1]  # the first start of it and all later ones
    pause_s = np.maximum(start_s[1:] - end_s[:-1], 0.0)
    return end_s - start_s[0] - np.insert(np.cumsum(pause_s), 0, 0.0)


def _speed(folder):
    """Of all runs together, whoever measured: by the time in which some shard was under way."""
    lines = [entry for entry in _log_lines(folder) if "shard" in entry]
    if len(lines) < 2:
        return "<p>Too few shards to tell.</p>"
    time_s = _time_at_work(np.array([entry["time_s"] for entry in lines]),
                           np.array([entry["seconds"] for entry in lines]))
    done = np.cumsum([entry["trials"] for entry in lines])
    rate = done[-1] / max(time_s[-1], 1e-9)
    by = sorted({entry["by"] for entry in lines})
    per_trial = np.array([1e3 * entry["seconds"] / max(entry["trials"], 1) for entry in lines])
    text = (f"<p>{done[-1]} trials in {time_s[-1]:.1f} s, pauses between runs left out: {rate:.4g} trials/s "
            f"by {len(by)} processes ({escape(', '.join(by[:8]))}{' ...' if len(by) > 8 else ''}).</p>")
    return (text + charts.line("trials done over time, s", np.insert(time_s, 0, 0.0),
                               np.insert(done, 0, 0))
            + charts.histogram("ms per trial of a shard, from its start to its receipt", per_trial))


def _failures(table):
    faults = {}
    for trial, text in zip(table["trial"].to_pylist(), table["error"].to_pylist()):
        if text:
            faults.setdefault(text, []).append(trial)
    if not faults:
        return "<p>None.</p>"
    rows = []
    for text, trials in sorted(faults.items(), key=lambda pair: -len(pair[1]))[:MOST_FAULTS]:
        which = ", ".join(str(trial) for trial in trials[:8]) + (" ..." if len(trials) > 8 else "")
        rows.append(f"<tr><td>{len(trials)}</td><td>{which}</td><td>{_code(text)}</td></tr>")
    more = len(faults) - MOST_FAULTS
    note = f"<p>and {more} other texts, see index.parquet</p>" if more > 0 else ""
    return f"<table><tr><th>trials</th><th>which</th><th>why</th></tr>{''.join(rows)}</table>{note}"


def _position(table):
    return np.stack([table[name].to_numpy() for name in index.POSE[:3]], axis=1)


def _target(campaign):
    """What the sensor looks at, or what it is placed about; else the world's origin."""
    pose = campaign["pose"]
    return np.array(pose["orientation"].get("target") or pose["position"].get("centre") or [0, 0, 0],
                    float)


def _single_value(values):
    """The one number that all finite values are; None where they differ or there are none."""
    finite = values[np.isfinite(values)]
    return float(finite[0]) if len(finite) and (finite == finite[0]).all() else None


def _columns(table, campaign):
    """(name, numbers) of all that has a distribution."""
    ok = table["ok"].to_numpy(zero_copy_only=False)
    yield "distance from the target, m", np.linalg.norm(_position(table) - _target(campaign), axis=1)
    facts = set(index.FACTS)
    for name in table.column_names:
        if name in KNOWN or name in index.POSE:
            continue
        values = np.asarray(table[name].to_numpy(), float)
        yield name, values[ok] if name in facts else values


def _distributions(table, campaign):
    """Charts of what differs between trials; what is the same in all is listed."""
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
    around = f"about [{', '.join(f'{a:g}' for a in target)}]; the middle of the map is +x, the top +z"
    parts = [charts.sphere("where the sensor stands", seen_from, around)] if len(seen_from) else []
    parts.append(charts.sphere("where the sensor's z axis points", forward, "in the world"))
    return "".join(parts)


def _colour_picture(values, column):
    """The picture and its scale in words. Near is bright, as in all pictures of GLIDAR; dark grey where
    there is nothing; a few odd values do not spoil the scale."""
    values = np.asarray(values, float)
    seen = np.isfinite(values) & (values > 0)
    is_distance = column != "intensity"
    scale = scale_of(values[seen], from_zero=not is_distance)
    pixels = np.full((*values.shape, 3), NO_RETURN, np.uint8)
    span = scale.high - scale.low
    share = np.clip((values[seen] - scale.low) / span, 0, 1) if span > 0 else (values[seen] > scale.low) * 1.0
    pixels[seen] = charts.colours(1.0 - share) if is_distance else np.rint(255 * share).astype(np.uint8)[:, None]
    return Image.fromarray(pixels), " to ".join(scale.ends("m" if is_distance else ""))


def _shown(picture):
    """An <img> of much the same size whatever the sensor."""
    scale = PICTURE / max(picture.size)
    size = tuple(max(1, round(side * scale)) for side in picture.size)
    buffer = io.BytesIO()
    picture.resize(size, Image.Resampling.NEAREST).save(buffer, "png", optimize=True)
    data = base64.b64encode(buffer.getvalue()).decode()
    return f'<img src="data:image/png;base64,{data}" width="{size[0]}" height="{size[1]}" alt="">'


def _pick(path, trial):
    """(title, picture, its scale) of a trial of an NPZ shard."""
    try:
        with npz_output.opened(path) as file:
            return _picked(file, trial)
    except (ValueError, OSError, IndexError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise Error(str(path), f"it is no NPZ shard: {excerpt(error)}", "a file that glidar campaign wrote",
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
        names = [n for n in receipt["files"] if n.startswith("npz/")]
        if not names:
            return "<p>Pictures are made of NPZ shards, and this campaign writes none.</p>"
        found = _pick(folder.root / names[0], trial)
        if found:
            parts.append(charts.figure(f"trial {trial}: {found[0]}", _shown(found[1]), found[2]))
    return "".join(parts) or "<p>The NPZ shards hold neither depth, range nor intensity.</p>"


def page(root: str | os.PathLike[str]) -> str:
    """The text of the report."""
    folder, described = folders.opened(root)
    if not (folder.root / MANIFEST_FILE).is_file():
        raise Error(str(root), "the campaign is not finished", "a folder with manifest.json",
                    "run glidar campaign run again, or merge its parts")
    manifest = records.read_manifest(folder.root / MANIFEST_FILE)
    campaign = manifest["plan"]["campaign"]
    table = index.read(folder.root / index.INDEX_FILE)
    sections = [("Summary", _summary(manifest)), ("Failures", _failures(table)),
                ("Distributions", _distributions(table, campaign)),
                ("Coverage", _coverage(table, campaign)),
                ("Example views", _examples(folder, table, described)),
                ("Speed", _speed(folder))]
    body = "".join(f"<h2>{title}</h2>{content}" for title, content in sections)
    name = escape(campaign["name"])
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
            f"<style>{STYLE}</style></head><body><h1>Campaign {name}</h1>{body}</body></html>\n")


def _require_foreign(root, path):
    """A report replaces no file of the campaign."""
    root, path = Path(root).resolve(), path.resolve()
    if not path.is_relative_to(root):
        return
    name = path.relative_to(root)
    listed = records.read_manifest(root / MANIFEST_FILE)["files"]
    if name.as_posix() in [*listed, MANIFEST_FILE] or name.parts[:1] in [("receipts",), ("parts",), ("log",)]:
        raise Error(str(path), "it is a file of the campaign", "another name",
                    f"without -o the report is {root / REPORT_FILE}")


def _write_whole(path, text):
    """Under another name beside it first; what is no file, such as a pipe, is written as it is."""
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def write(root: str | os.PathLike[str], path: str | os.PathLike[str] | None = None) -> Path:
    """Writes the report; returns where it is."""
    text = page(root)
    path = Path(path) if path else Path(root) / REPORT_FILE
    _require_foreign(root, path)
    try:
        _write_whole(path, text)
    except OSError as error:
        raise files.write_error(path, error) from None
    return path
