# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of frames, and how Jupyter shows what GLIDAR has."""

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


def test_show_has_depth_and_intensity(frame):
    figure = frame.show()
    images = [axis.images[0] for axis in figure.axes if axis.images]
    assert [axis.get_title() for axis in figure.axes[:2]] == ["depth, m", "intensity"]
    assert images[1].get_array().shape == (48, 64)


def test_plot_has_the_hits(frame):
    axis = frame.plot(colour="range", most=500).axes[0]
    drawn = axis.collections[0].get_offsets()
    assert 250 <= len(drawn) <= 500
    assert axis.get_title() == "world"


def test_pictures_of_nothing_are_drawn_too(asteroid, camera):
    empty = glidar.simulate(asteroid, camera, glidar.look_at([0, 0, 9], [0, 0, 99], [1, 0, 0]))
    assert empty.hits == 0
    empty.show()
    empty.plot()
    assert "img" in empty._repr_html_()


def test_html_tells_and_shows(frame):
    text = frame._repr_html_()
    assert "48 x 64" in text
    assert re.search(r"data:image/png;base64,iVBOR", text)
    assert "48 x 64 x 3" in frame.cloud()._repr_html_()
    assert "64 x 48" not in repr(frame)
    for thing in (frame, frame.cloud(), glidar.Scene("builtin:box"), glidar.camera()):
        assert repr(thing).startswith("<glidar.")


def test_plots_of_nothing_or_of_vectors_are_refused(frame):
    for arguments, words in (({"most": 0}, "most: 0"), ({"colour": "xyz"}, "one number per point")):
        with pytest.raises(glidar.Error, match=words):
            frame.plot(**arguments)


def pixels_of(figure, axis):
    return np.ma.filled(figure.axes[axis].images[0].get_array().astype(float), np.nan)


def test_images_have_the_scale_of_all_pictures():
    values = np.linspace(1.0, 2.0, 1000)
    values[7] = 500.0
    scale = glidar._pictures.scale_of(values)
    assert (scale.low, scale.clips_low, scale.clips_high) == (1.0, False, True)
    assert 1.9 < scale.high <= 2.0
    assert scale.ends("m")[1].startswith("\N{GREATER-THAN OR EQUAL TO} 1.9")


@pytest.mark.parametrize("from_zero", [False, True])
def test_the_scale_is_what_the_percentiles_say(from_zero):
    """By NumPy's percentiles with the rule of docs/files/pictures.md."""
    generator = np.random.default_rng(5)
    for values in (generator.normal(10.0, 1.0, 777), generator.lognormal(0.0, 3.0, 5000), np.full(200, 3.0)):
        low = np.percentile(values, 1, method="lower")
        high = np.percentile(values, 99, method="higher")
        close = max(0.25 * (high - low), 0.001 * max(abs(low), abs(high)))
        high = values.max() if values.max() - high <= close else high
        low = values.min() if low - values.min() <= close else low
        scale = glidar._pictures.scale_of(values, from_zero)
        assert (scale.low, scale.high) == (min(0.0, low) if from_zero else low, high)


def test_lidars_are_shown_upright_by_angle(asteroid):
    frame = glidar.simulate(glidar.Scene("builtin:box"), "OS1-32", np.eye(4), seed=1)
    figure = frame.show()
    assert [axis.get_title() for axis in figure.axes[:2]] == ["range, m", "intensity"]
    assert "azimuth" in figure.axes[0].get_xlabel()
    image = pixels_of(figure, 0)
    # The corners of the box are farthest: each row has them in the same columns.
    level = image[14:18]
    corner = np.nanargmax(level[:, : level.shape[1] // 4], axis=1)
    assert np.ptp(corner) <= 2


def test_scanners_of_one_line_are_shown_from_above():
    figure = glidar.simulate(glidar.Scene("builtin:box"), "TiM781", np.eye(4)).show()
    assert figure.axes[0].get_xlabel() == "x, m"
    assert np.isfinite(pixels_of(figure, 0)).any()


@pytest.mark.parametrize("colour_by", ["height", "range", "intensity", "ring", "class", "instance"])
def test_clouds_have_pictures_from_above_and_in_perspective(colour_by, tmp_path):
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


def test_pictures_of_clouds_refuse_what_cannot_be(frame):
    for action, words in (
        (lambda: frame.bird_eye(colour_by="ring"), "a camera has no rings"),
        (lambda: frame.bird_eye(colour_by="heat"), "colour_by: 'heat'; allowed: height, range"),
        (lambda: frame.bird_eye(size=(10, 1000)), "picture size: 10 x 1000 pixels"),
        (lambda: frame.perspective(eye=[1, 2, 3], target=[1, 2, 3]), "view_eye: it is where"),
        (lambda: frame.perspective(eye=[1, 2]), "view_eye"),
    ):
        with pytest.raises(glidar.Error, match=words):
            action()


def test_a_picture_is_saved_whole_or_not_at_all(frame, tmp_path):
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
