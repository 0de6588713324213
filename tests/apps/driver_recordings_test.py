#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Messages of `--as` beside recordings of real sensors (GLIDAR_DATA): a VLP-16 and Ouster sensors as velodyne-decoder and
ouster-sdk read them, a bag of a Hesai XT32, and a bag of a RealSense D435. rosbags reads the bags. No recording has a cloud of a
maker's ROS driver: names of topics and frames are compared with the sources of drivers in ros_drivers_test.py.
The built program is found in PATH."""

import os
import sqlite3
import struct
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from skipping import importing, skip

DATA = Path(os.environ.get("GLIDAR_DATA", "/nonexistent"))
if not DATA.exists():
    skip("GLIDAR_DATA is not set", "set it to a folder with real data")
with importing():
    import velodyne_decoder as vd
    from ouster.sdk import open_source
    from ouster.sdk.core import SensorInfo, XYZLut, destagger
    from rosbags.highlevel import AnyReader

from driver_support import ROOM, DriverTest, np, points_of

VLP16 = DATA / "recordings/velodyne/sample_velodyne_vlp16_gps.pcap"
OUSTER = {"OS-0-128-U1_v2.3.0_1024x10": "OS-0-128-U1_v2.3.0_1024x10.pcap", "OS-1-128_v2.3.0_1024x10": "OS-1-128_v2.3.0_1024x10_lb_n3.pcap"}
XT32 = DATA / "depth/nebula/xt32.db3"
D435 = DATA / "depth/d435_bag/single_depth_color_640x480.bag"


def first_scan(source):
    for scans in source:
        return scans[0] if not hasattr(scans, "h") else scans


def hesai_packets(blob):
    """The data packets in a message."""
    at, found = blob.find(b"\xee\xff\x06\x01"), []
    while at >= 0:
        found.append(blob[at:at + 1080])
        at = blob.find(b"\xee\xff\x06\x01", at + 1080)
    return found


def azimuths(packets):
    """Of the blocks, in 0.01 degrees."""
    return np.array([struct.unpack_from("<H", packet, 12 + 130 * block)[0] for packet in packets for block in range(8)])


class Recordings(DriverTest):
    BAG = "run.rosbag2"  # which the version of rosbags that ouster-sdk pins reads

    def test_velodyne_clouds_have_fields_and_times_as_from_the_recorded_packets(self):
        config = vd.Config(model=vd.Model.VLP16)
        scans = [points for _, points in vd.read_pcap(str(VLP16), config, as_pcl_structs=True)]
        real = scans[len(scans) // 2]
        self.publish(*ROOM, "--sensor", "VLP-16", "--as", "velodyne", duration="0.2")
        mine = points_of(self.first("/velodyne_points"))
        for name in ("x", "y", "z", "intensity", "time"):
            self.assertEqual(mine.dtype[name], real.dtype[name], name)
        # seconds before the start of the last packet, which ends 24 firings of 55.296 us after it
        self.assertEqual(mine["time"].max(), real["time"].max())
        self.assertAlmostEqual(mine["time"].max(), 23 * 55.296e-6 + 15 * 2.304e-6, 9)
        for name, cloud in (("recorded", real), ("simulated", mine.ravel())):
            # ring 0 is the lowest laser; lasers are up to 11 mm above and below the centre
            flat = np.hypot(cloud["x"], cloud["y"])
            elevation = np.degrees(np.arctan2(cloud["z"], flat))
            self.assertLess(np.abs(elevation - (2.0 * cloud["ring"] - 15))[flat > 2].max(), 0.6, name)
            firings = np.unique(np.round(cloud["time"][cloud["ring"] == 0].astype(float) / 55.296e-6, 1))
            self.assertLess(np.abs(firings - firings[0] - np.round(firings - firings[0])).max(), 0.11, name)
            self.assertTrue(0 <= cloud["intensity"].min() and cloud["intensity"].max() <= 255, name)

    def test_ouster_clouds_have_the_pixels_of_ouster_sdk(self):
        for name, capture in OUSTER.items():
            with self.subTest(name):
                metadata = DATA / f"recordings/ouster/{name}.json"
                scan = first_scan(open_source(str(metadata.with_name(capture)), meta=[str(metadata)]))
                self.write("ouster.yaml", f"name: Ouster OS\noptics: {{type: ouster, file: '{metadata}'}}\n")
                self.publish(*ROOM, "--sensor", "ouster.yaml", "--as", "ouster")
                cloud = self.first("/ouster/points")
                mine = points_of(cloud)
                self.assertEqual((cloud.height, cloud.width), (scan.h, scan.w))
                # Rows are shifted like the recorded ones, by as many columns more or less as put +x into column 0.
                published = SensorInfo(self.first("/ouster/metadata").data)
                shifts = np.subtract(scan.sensor_info.format.pixel_shift_by_row, published.format.pixel_shift_by_row)
                self.assertEqual(len(np.unique(shifts % scan.w)), 1)
                # the points that the SDK makes of our ranges with the recorded metadata are ours, in its frame of the sensor
                theirs = XYZLut(scan.sensor_info)(destagger(published, mine["range"].astype(np.uint32), inverse=True))
                sensor_from_lidar = np.array(scan.sensor_info.lidar_to_sensor_transform)
                if np.abs(sensor_from_lidar[:3, 3]).max() > 1:  # millimetres
                    sensor_from_lidar[:3, 3] *= 1e-3
                xyz = destagger(published, np.stack([mine[axis] for axis in "xyz"], axis=-1).astype(float), inverse=True)
                errors = np.linalg.norm(xyz @ sensor_from_lidar[:3, :3].T + sensor_from_lidar[:3, 3] - theirs, axis=-1)
                self.assertLess(errors.max(), 0.002)  # of whole millimetres
                # times of columns after the first one
                recorded = np.diff(np.asarray(scan.timestamp, np.int64)[np.asarray(scan.timestamp) > 0])
                simulated = np.diff(np.unique(mine["t"].astype(np.int64)))
                self.assertAlmostEqual(np.median(recorded) / np.median(simulated), 1.0, delta=0.01)

    def test_hesai_packets_and_clouds_are_cut_as_the_recorded_ones(self):
        bag = sqlite3.connect(f"file:{XT32}?mode=ro&immutable=1", uri=True)
        turns = [hesai_packets(data) for (data,) in bag.execute("select data from messages order by timestamp")]
        bag.close()
        real = turns[1]
        self.publish(*ROOM[:-1], "--sensor", "XT32", "--returns", "strongest,last", "--as", "hesai", "-o", "x.pcap")
        mine = hesai_packets(Path(self.folder, "x.pcap").read_bytes())
        self.assertEqual({len(packet) for packet in mine}, {len(packet) for packet in real})
        self.assertEqual(len(mine), len(real))
        self.assertEqual({packet[:12] for packet in mine}, {packet[:12] for packet in real})  # both heads
        self.assertEqual({packet[1062] for packet in mine}, {packet[1062] for packet in real})  # return mode
        for packets in (mine, real):
            at = azimuths(packets)
            self.assertTrue((at[::2] == at[1::2]).all())  # the returns of a firing
            self.assertLess(min(at[0], 36000 - at[0]), 150)  # a cloud begins at azimuth 0
            self.assertLess(np.abs(np.diff(at[::2].astype(int)) % 36000 - 18).max(), 3)
        stamps, counts = np.unique(points_of(self.first("/lidar_points"))["timestamp"], return_counts=True)
        self.assertEqual(len(stamps), len(real))  # a time for each packet
        self.assertEqual(set(counts), {8 * 32})

    def test_realsense_images_have_the_form_of_the_recorded_ones(self):
        real = {}
        with AnyReader([D435]) as reader:
            for connection, _, data in reader.messages():
                if connection.msgtype in ("sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"):
                    real[connection.topic] = reader.deserialize(data, connection.msgtype)
        depth, colour = real["/device_0/sensor_0/Depth_0/image/data"], real["/device_0/sensor_1/Color_0/image/data"]
        info = real["/device_0/sensor_0/Depth_0/info/camera_info"]
        width, height = depth.width, depth.height
        self.write("d435.yaml", f"optics: {{type: pinhole, width: {width}, height: {height}, fx: {info.K[0]}, fy: {info.K[4]}, "
                                f"cx: {info.K[2] + 0.5}, cy: {info.K[5] + 0.5}}}\nrate_hz: 30\nlimits: {{near_m: 5.2}}\n")
        self.publish("builtin:box:size=20,16,6", "--eye", "4,0,0", "--target", "10,0,0", "--sensor", "d435.yaml", "--as",
                     "realsense", duration="0.03")
        mine = self.first("/camera/camera/depth/image_rect_raw")
        found = self.first("/camera/camera/depth/camera_info")
        for name in ("width", "height", "step", "is_bigendian"):
            self.assertEqual(getattr(mine, name), getattr(depth, name), name)
        self.assertEqual((depth.encoding, mine.encoding), ("mono16", "16UC1"))  # the names of librealsense and of the ROS driver
        self.assertEqual(len(bytes(mine.data)), len(bytes(depth.data)))
        self.assertLess(np.abs(np.array(found.k) - np.array(info.K)).max(), 1e-4)
        self.assertEqual((len(found.d), np.abs(found.d).max()), (len(info.D), np.abs(info.D).max()))
        rgb = self.first("/camera/camera/color/image_raw")
        self.assertEqual((rgb.encoding, rgb.step, rgb.is_bigendian), (colour.encoding, colour.step, colour.is_bigendian))
        for name, image in (("recorded", depth), ("simulated", mine)):  # millimetres, 0 without a depth
            pixels = np.frombuffer(bytes(image.data), "<u2")
            self.assertTrue((pixels == 0).any(), name)
            self.assertTrue(100 < np.median(pixels[pixels > 0]) < 10_000, name)


if __name__ == "__main__":
    unittest.main()
