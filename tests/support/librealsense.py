# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Filters and alignment of librealsense, by pyrealsense2 and its software device."""

import functools

import numpy as np
import pytest

rs = pytest.importorskip("pyrealsense2")


def _stream(kind, number, pixel_format, bytes_per_pixel, camera):
    """A video stream; `camera` has width, height, fx, fy, cx, cy, where whole numbers are centres of pixels."""
    intrinsics = rs.intrinsics()
    intrinsics.width, intrinsics.height = camera["width"], camera["height"]
    intrinsics.fx, intrinsics.fy, intrinsics.ppx, intrinsics.ppy = (camera[key] for key in ("fx", "fy", "cx", "cy"))
    intrinsics.model, intrinsics.coeffs = rs.distortion.brown_conrady, [0.0] * 5
    stream = rs.video_stream()
    stream.type, stream.index, stream.uid, stream.fmt = kind, 0, number, pixel_format
    stream.width, stream.height, stream.fps, stream.bpp = camera["width"], camera["height"], 30, bytes_per_pixel
    stream.intrinsics = intrinsics
    return stream


class Sensor:
    """A sensor of a software device, whose frames have the pixels that it is given."""

    def __init__(self, device, stream, unit_m=0.0):
        self._device, self._unit_m, self._number = device, unit_m, 0
        self._stride, self._bytes = stream.width * stream.bpp, stream.bpp
        self._sensor = device.add_sensor(str(stream.type))
        self.profile = self._sensor.add_video_stream(stream).as_video_stream_profile()

    def add_option(self, option, value):
        self._sensor.add_read_only_option(option, value)

    def start(self, receiver):
        self._sensor.open(self.profile)
        self._sensor.start(receiver)

    def send(self, pixels):
        frame = rs.software_video_frame()
        frame.pixels, frame.stride, frame.bpp = np.ascontiguousarray(pixels), self._stride, self._bytes
        frame.timestamp, frame.frame_number, frame.domain = 33.0 * self._number, self._number, rs.timestamp_domain.system_time
        frame.profile = self.profile
        if self._unit_m > 0:
            frame.depth_units = self._unit_m
        self._number += 1
        self._sensor.on_video_frame(frame)


def depth_sensor(device, camera, unit_m=0.001):
    sensor = Sensor(device, _stream(rs.stream.depth, 0, rs.format.z16, 2, camera), unit_m)
    sensor.add_option(rs.option.depth_units, unit_m)
    return sensor


def _with_options(block, **options):
    for name, value in options.items():
        block.set_option(getattr(rs.option, name), value)
    return block


def _block(type, magnitude=2, min_m=0.1, max_m=4.0, alpha=None, delta=20, persistence=3, hole_filling="none",
           source="farthest", baseline_m=None):
    """The processing block for the keys of a filter."""
    if type == "decimation":
        return _with_options(rs.decimation_filter(), filter_magnitude=magnitude)
    if type == "threshold":
        return _with_options(rs.threshold_filter(), max_distance=max_m, min_distance=min_m)
    if type == "spatial":
        widths = ["none", "2", "4", "8", "16", "unlimited"]
        return _with_options(rs.spatial_filter(), filter_smooth_alpha=alpha or 0.5, filter_smooth_delta=delta,
                             filter_magnitude=magnitude, holes_fill=widths.index(hole_filling))
    if type == "temporal":
        return _with_options(rs.temporal_filter(), filter_smooth_alpha=0.4 if alpha is None else alpha,
                             filter_smooth_delta=delta, holes_fill=persistence)
    if type == "hole_filling":
        return _with_options(rs.hole_filling_filter(), holes_fill=["left", "farthest", "nearest"].index(source))
    return rs.disparity_transform(type == "to_disparity")


@functools.cache
def _camera(width, height, focal_length_px, baseline_m):
    """A depth camera and the queue of its frames; devices take long to start and to end."""
    device, queue = rs.software_device(), rs.frame_queue(10, True)
    camera = {"width": width, "height": height, "fx": focal_length_px, "fy": focal_length_px, "cx": width / 2, "cy": height / 2}
    sensor = depth_sensor(device, camera)
    sensor.add_option(rs.option.stereo_baseline, 1000 * baseline_m)
    sensor.start(queue)
    return sensor, queue


def librealsense_filters(filters, images, focal_length_px, baseline_m):
    """Each image after the filters (dicts with the keys of glidar.DepthFilters)."""
    height, width = images[0].shape
    sensor, queue = _camera(width, height, focal_length_px, baseline_m)
    results = []
    blocks = [_block(**keys) for keys in filters]
    for image in images:
        sensor.send(np.asarray(image, np.uint16))
        frame = queue.wait_for_frame(60_000)
        for block in blocks:
            frame = block.process(frame)
        results.append(np.array(np.asanyarray(frame.get_data()), copy=True))
    return results


def librealsense_aligned(depth, depth_camera, colour_camera, rotation, translation):
    """The depth image at the pixels of the colour camera."""
    device, syncer = rs.software_device(), rs.syncer(10)
    depths = depth_sensor(device, depth_camera)
    colours = Sensor(device, _stream(rs.stream.color, 1, rs.format.rgb8, 3, colour_camera))
    extrinsics = rs.extrinsics()
    extrinsics.rotation, extrinsics.translation = list(np.asarray(rotation).T.ravel()), list(translation)
    depths.profile.register_extrinsics_to(colours.profile, extrinsics)
    device.create_matcher(rs.matchers.default)
    for sensor in (depths, colours):
        sensor.start(syncer)
    black = np.zeros((colour_camera["height"], colour_camera["width"], 3), np.uint8)
    for _ in range(100):  # the first frames are not matched
        depths.send(np.asarray(depth, np.uint16))
        colours.send(black)
        both = syncer.wait_for_frames(60_000)
        if both.get_depth_frame() and both.get_color_frame():
            aligned = rs.align(rs.stream.color).process(both)
            return np.array(np.asanyarray(aligned.get_depth_frame().get_data()), copy=True)
    raise AssertionError("librealsense matched no depth frame with a colour frame")
