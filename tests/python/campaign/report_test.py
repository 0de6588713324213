# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The HTML report and its charts."""

import base64
import io
import json
import re
import resource
from html.parser import HTMLParser

import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image
from scipy import stats

from glidar.campaign import charts, philox, report as campaign_report, rotations
from glidar.campaign.folder import CampaignFolder

VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """Checks that every element is closed, and collects texts and images."""

    def __init__(self, text):
        super().__init__()
        self.open, self.titles, self.sources, self.text = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        (self.titles if self.open and self.open[-1] == "h2" else self.text).append(data)


def report(campaign):
    campaign.call("report", "out")
    text = (campaign.folder / "out" / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"https?://", text)
    return Page(text)


def test_a_report_is_one_file_with_failures_views_and_coverage(campaign):
    campaign.write("broken.yaml", "models:\n  - {model: '<none>.obj'}\n")
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "scene: scene.yaml", "name: a & <b>\nscene: {grid: [scene.yaml, broken.yaml]}"))
    campaign.run("out", code=1)
    page = report(campaign)
    assert page.titles == ["Summary", "Failures", "Distributions", "Coverage", "Example views", "Speed"]
    words = "".join(page.text)
    assert "Campaign a & <b>" in words and "20 of 40" in words
    assert "<none>.obj" in words and "cells of equal area contain a trial" in words
    assert "distance from the target, m" in words and "range_min_m" in words
    pictures = [source for source in page.sources if source.startswith("data:image/png;base64,")]
    assert len(pictures) == len(page.sources) == 12
    for source in pictures:
        image = Image.open(io.BytesIO(base64.b64decode(source.split(",")[1])))
        assert max(image.size) == 160 and len(np.unique(np.asarray(image))) > 5  # the rock is visible


def test_trials_without_a_look_at_direction_fail_and_are_counted_in_the_charts(campaign):
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "{shell: {radius_m: [3, 5]}}", "{grid: {min: [-4, 0, 0], max: [4, 0, 0], counts: [5, 1, 1]}}"))
    campaign.environment["PYTHONWARNINGS"] = "error"
    campaign.run("out", "--workers", "1", code=1)
    index = pq.read_table(campaign.folder / "out" / "index.parquet").to_pydict()
    texts = {text for x, text in zip(index["x_m"], index["error"]) if x == 0}
    assert len(texts) == 1 and "pose: the position is the target of look_at" in texts.pop()
    assert [ok == (x != 0) for x, ok in zip(index["x_m"], index["ok"])] == [True] * 40
    words = "".join(report(campaign).text)
    assert "in the world. 8 without a value" in words and "8 of 40" in words


def test_trials_with_a_model_without_a_look_at_direction_fail(campaign):
    campaign.add("vary:\n  scene.models[moon].pose:\n    position: {point: [1, 2, 0]}\n"
                 "    orientation: {look_at: {target: [1, 2, 0]}}\n")
    assert "40 trials, 40 failed" in campaign.run("out", "--workers", "1", code=1)
    words = "".join(report(campaign).text)
    assert "vary.scene.models[moon].pose: the position is the target of look_at" in words


@pytest.mark.parametrize("directions", [np.full((3, 3), np.nan), np.array([[np.nan] * 3, [0, 0, 1.0]])])
def test_maps_omit_undefined_directions(directions):
    assert f"{np.isnan(directions[:, 0]).sum()} without a value" in charts.sphere("title", directions)


def test_reports_work_without_npz_and_failures(campaign):
    campaign.add("outputs: {tum: true}\n")
    campaign.run("out")
    words = "".join(report(campaign).text)
    assert "this campaign does not write" in words and "None." in words


def test_an_unfinished_campaign_has_no_report(campaign):
    campaign.run("out", "--shard", "0/2")
    assert "not finished" in campaign.call("report", "out", code=2)


@pytest.mark.parametrize("name", ["manifest.json", "index.parquet", "campaign.json", "receipts/000003.json"])
def test_a_report_does_not_overwrite_files_of_its_campaign(campaign, name):
    campaign.run("out")
    before = campaign.contents("out")
    assert "it is a file of the campaign" in campaign.call("report", "out", "-o", f"out/{name}", code=2)
    assert campaign.contents("out") == before
    campaign.call("report", "out", "-o", "out/mine.html")
    campaign.call("report", "out", "-o", "out/mine.html")
    assert (campaign.folder / "out" / "mine.html").read_text().startswith("<!doctype html>")


def test_a_report_is_written_atomically(campaign):
    campaign.run("out")

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))

    (campaign.folder / "own").mkdir()
    (campaign.folder / "own" / "report.html").write_text("before")
    reported = campaign.call("report", "out", "-o", "own/report.html", code=2, preexec_fn=limit)
    assert "cannot be written" in reported
    assert [p.read_text() for p in (campaign.folder / "own").iterdir()] == ["before"]
    assert "<!doctype html>" in campaign.call("report", "out", "-o", "/dev/stdout", apart=True)


def test_a_link_is_written_through_and_stays(campaign):
    campaign.run("out")
    link, page = campaign.folder / "link.html", campaign.folder / "page.html"
    page.write_text("before")
    link.symlink_to(page)
    campaign.call("report", "out", "-o", "link.html")
    assert link.is_symlink() and page.read_text().startswith("<!doctype html>")


def test_speed_excludes_pauses_between_runs(campaign):
    # Two runs, a day apart: two workers for 3 s, one for 2 s; shards of 10 trials.
    log = campaign.folder / "log"
    log.mkdir()
    runs = {"a": [(102.0, 2.0), (103.0, 1.0)], "b": [(102.5, 2.5)], "c": [(90001.0, 1.0), (90002.0, 1.0)]}
    for name, shards in runs.items():
        (log / f"{name}.jsonl").write_text("".join(
            json.dumps({"time_s": end, "shard": 0, "trials": 10, "seconds": took}) + "\n" for end, took in shards))
    text = campaign_report._speed(CampaignFolder(campaign.folder), 5)
    assert "50 trials in 5.0 s" in text and "10 trials/s by 3 processes" in text


def test_logs_that_are_too_large_for_the_shards_are_not_read(campaign):
    log = campaign.folder / "log"
    log.mkdir()
    for name in "ab":
        (log / f"{name}.jsonl").write_text("\n" * 600_000)
    text = campaign_report._speed(CampaignFolder(campaign.folder), 5)
    assert "cannot be read" in text and "b.jsonl" in text


def test_cells_of_the_sphere_have_equal_areas():
    count = 200_000
    u = philox.uniforms(1, np.arange(count), "test", 2)
    unit = rotations.directions_in_cone((0, 0, 1), np.pi, u)
    rows = charts.rows_for(count)
    counts = np.bincount(charts.cells_of(unit, rows), minlength=2 * rows * rows)
    assert rows == 18 and charts.rows_for(3) == 6
    assert stats.chisquare(counts).pvalue > 1e-3


def area(x, y):
    """Of a polygon, by the shoelace formula."""
    return 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))


@pytest.mark.parametrize("sine", [(-1.0, -0.9), (-0.1, 0.1), (0.6, 0.8), (0.97, 1.0)])
def test_the_map_projection_preserves_areas(sine):
    edge = np.linspace(*sine, 400)
    x, y = charts._mollweide(np.repeat([0.3, 0.5], 400), np.concatenate([edge, edge[::-1]]), 1.0)
    # Of the whole map, pi R^2 sqrt 2 ... here an ellipse with half-axes 2 and 1, area 2 pi, the part
    # is that of the sphere: width / 2 pi times height / 2.
    assert area(x, y) / (2 * np.pi) == pytest.approx(0.2 / (2 * np.pi) * (sine[1] - sine[0]) / 2, rel=1e-3)


def test_near_is_bright_and_outliers_do_not_determine_the_scale():
    depth = np.linspace(2.0, 4.0, 400).reshape(20, 20)
    depth[10, 10], depth[0, 1] = 100.0, np.nan
    picture, scale = campaign_report._colour_picture(depth, "depth")
    pixels = np.asarray(picture).astype(int)
    assert pixels[0, 0].sum() > 3 * pixels[19, 19].sum()  # viridis: yellow and purple
    assert (pixels[10, 10] == pixels[19, 19]).all() and tuple(pixels[0, 1]) == campaign_report.NO_RETURN
    assert scale.startswith("2 to \N{GREATER-THAN OR EQUAL TO} 3.9") and scale.endswith("m")


def test_intensity_is_grey_with_a_scale_from_zero():
    picture, scale = campaign_report._colour_picture(np.array([[1.0, 2.0], [0.5, np.nan]]), "intensity")
    assert np.asarray(picture)[:, :, 0].tolist() == [[128, 255], [64, 44]] and scale == "0 to 2"


def test_constant_values_have_no_chart(campaign):
    campaign.run("out")
    text = (campaign.call("report", "out"), (campaign.folder / "out" / "report.html").read_text("utf-8"))[1]
    assert "all are" not in text.split("<h2>Speed")[0]


def test_constant_values_are_listed():
    assert campaign_report._single_value(np.array([2.0, np.nan, 2.0])) == 2.0
    assert campaign_report._single_value(np.array([2.0, 3.0])) is None
    assert campaign_report._single_value(np.array([np.nan])) is None


def test_the_colour_scale_increases_in_brightness():
    brightness = charts.colours(np.linspace(0, 1, 20)).astype(int).sum(axis=1)
    assert brightness[-1] > brightness[0] and (np.diff(brightness) >= -8).all()
