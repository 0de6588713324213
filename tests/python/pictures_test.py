# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of frames, and how Jupyter shows what GLIDAR has."""

import re

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
