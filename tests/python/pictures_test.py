# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of frames, and their display in Jupyter."""

import re
import struct

import numpy as np
import pytest

import glidar

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


@pytest.fixture(scope="module")
def frame(asteroid, camera):
    return glidar.simulate(asteroid, camera)


def test_show_draws_depth_and_intensity(frame):
    figure = frame.show()
    images = [axis.images[0] for axis in figure.axes if axis.images]
    assert [axis.get_title() for axis in figure.axes[:2]] == ["depth, m", "intensity"]
    assert images[1].get_array().shape == (48, 64)


def test_plot_draws_the_hits(frame):
    axis = frame.plot(colour="range", max_points=500).axes[0]
    drawn = axis.collections[0].get_offsets()
    assert 250 <= len(drawn) <= 500
    assert axis.get_title() == "world"


def test_frames_without_hits_can_be_drawn(asteroid, camera):
    empty = glidar.simulate(asteroid, camera, glidar.look_at([0, 0, 9], [0, 0, 99], [1, 0, 0]))
    assert empty.hits == 0
    empty.show()
    empty.plot()
    assert "img" in empty._repr_html_()


def test_html_contains_a_table_and_a_preview(frame):
    text = frame._repr_html_()
    assert "48 x 64" in text
    assert re.search(r"data:image/png;base64,iVBOR", text)
    assert "48 x 64 x 3" in frame.cloud()._repr_html_()
    assert "64 x 48" not in repr(frame)
    for thing in (frame, frame.cloud(), glidar.Scene("builtin:box"), glidar.camera()):
        assert repr(thing).startswith("<glidar.")


def test_plot_rejects_zero_points_and_vector_columns(frame):
    for arguments, words in (({"max_points": 0}, "max_points: 0"), ({"colour": "xyz"}, "one number per point")):
        with pytest.raises(glidar.Error, match=words):
            frame.plot(**arguments)


def pixels_of(figure, axis):
    return np.ma.filled(figure.axes[axis].images[0].get_array().astype(float), np.nan)


def test_images_use_the_common_colour_scale():
    values = np.linspace(1.0, 2.0, 1000)
    values[7] = 500.0
    scale = glidar._pictures.scale_of(values)
    assert (scale.low, scale.clips_low, scale.clips_high) == (1.0, False, True)
    assert 1.9 < scale.high <= 2.0
    assert scale.ends("m")[1].startswith("\N{GREATER-THAN OR EQUAL TO} 1.9")


@pytest.mark.parametrize("from_zero", [False, True])
def test_the_colour_scale_follows_the_percentiles(from_zero):
    """By NumPy's percentiles with the rule of docs/files/images.md."""
    generator = np.random.default_rng(5)
    for values in (generator.normal(10.0, 1.0, 777), generator.lognormal(0.0, 3.0, 5000), np.full(200, 3.0)):
        low = np.percentile(values, 1, method="lower")
        high = np.percentile(values, 99, method="higher")
        close = max(0.25 * (high - low), 0.001 * max(abs(low), abs(high)))
        high = values.max() if values.max() - high <= close else high
        low = values.min() if low - values.min() <= close else low
        scale = glidar._pictures.scale_of(values, from_zero)
        assert (scale.low, scale.high) == (min(0.0, low) if from_zero else low, high)


def test_frames_of_lidars_are_shown_by_azimuth_and_elevation(asteroid):
    frame = glidar.simulate(glidar.Scene("builtin:box"), "OS1-32", np.eye(4), seed=1)
    figure = frame.show()
    assert [axis.get_title() for axis in figure.axes[:2]] == ["range, m", "intensity"]
    assert "azimuth" in figure.axes[0].get_xlabel()
    image = pixels_of(figure, 0)
    # The edges of the box have the maximum range: in the same columns of every row.
    level = image[14:18]
    corner = np.nanargmax(level[:, : level.shape[1] // 4], axis=1)
    assert np.ptp(corner) <= 2


def test_frames_of_single_line_scanners_are_shown_from_above():
    figure = glidar.simulate(glidar.Scene("builtin:box"), "TiM781", np.eye(4)).show()
    assert figure.axes[0].get_xlabel() == "x, m"
    assert np.isfinite(pixels_of(figure, 0)).any()


@pytest.mark.parametrize("colour_by", ["height", "range", "intensity", "ring", "class", "instance"])
def test_clouds_can_be_drawn_from_above_and_in_perspective(colour_by, tmp_path):
    frame = glidar.simulate(glidar.Scene("builtin:box"), "VLP-16", np.eye(4))
    for picture in (
        frame.bird_eye(colour_by=colour_by, size=(400, 300)),
        frame.perspective(colour_by=colour_by, size=(400, 300), eye=[-3, 0, 4], target=[0, 0, 0]),
    ):
        assert picture._repr_png_() == picture.data
        assert struct.unpack(">II", picture.data[16:24]) == (400, 300)
        picture.save(tmp_path / "a.png")
        assert (tmp_path / "a.png").read_bytes() == picture.data
        assert repr(picture) == "<glidar.Picture of 400 x 300 pixels>"


def test_pictures_of_clouds_reject_invalid_options(frame):
    for action, words in (
        (lambda: frame.bird_eye(colour_by="ring"), "a camera has no rings"),
        (lambda: frame.bird_eye(colour_by="radial_velocity"), "the sensor does not measure it"),
        (lambda: frame.bird_eye(colour_by="heat"), "colour_by: 'heat'; allowed: height, range"),
        (lambda: frame.bird_eye(size=(10, 1000)), "picture size: 10 x 1000 pixels"),
        (lambda: frame.perspective(eye=[1, 2, 3], target=[1, 2, 3]), "view_eye: it equals"),
        (lambda: frame.perspective(eye=[1, 2]), "view_eye"),
    ):
        with pytest.raises(glidar.Error, match=words):
            action()


def test_a_picture_is_saved_atomically(frame, tmp_path):
    picture = frame.bird_eye()
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == picture.data
    with pytest.raises(glidar.Error, match="nonexistent/x.png"):
        picture.save("/nonexistent/x.png")
    with pytest.raises(glidar.Error, match="path: a float"):
        picture.save(1.5)
    tmp_path.joinpath("folder.png").mkdir()
    with pytest.raises(glidar.Error, match="folder.png"):
        picture.save(tmp_path / "folder.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png", "folder.png"]
