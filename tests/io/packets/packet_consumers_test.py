#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads packets with velodyne-decoder and ouster-sdk, and compares their points with those that were encoded;
reads recordings of real sensors with both (GLIDAR_DATA).

usage: packet_consumers_test.py PACKET_FILES_PROGRAM
"""

import datetime
import os
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from skipping import importing

with importing():
    import numpy as np
    import velodyne_decoder as vd
    import yaml
    from ouster.sdk import open_source
    from ouster.sdk.core import XYZLut
    from scipy.spatial import cKDTree

EPOCH = 1_700_001_234.567891  # kPacketEpoch_ns
MODELS = {  # preset: model, calibration, unit in metres
    "VLP-16": (vd.Model.VLP16, "VLP-16.yml", 0.002),
    "Puck-Hi-Res": (vd.Model.PuckHiRes, "Puck Hi-Res.yml", 0.002),
    "VLP-32C": (vd.Model.VLP32C, "VLP-32C.yml", 0.004),
    "HDL-32E": (vd.Model.HDL32E, "HDL-32E.yml", 0.002),
    "HDL-64E-S3": (vd.Model.HDL64E_S2, "HDL-64E_S3-VeloView.yml", 0.002),  # S2: the period of one return
    "VLS-128": (vd.Model.VLS128, "Alpha Prime.yml", 0.004),
}
FOLDER = None
PROGRAM = None
DATA = Path(os.environ.get("GLIDAR_DATA", "/nonexistent"))


def encoded_returns(name):
    """x y z stamp ring range of every return, by ring, time and range."""
    return np.fromfile(FOLDER / f"{name}.returns").reshape(-1, 6)


def calibration_lasers(file):
    """The lasers in a calibration of the decoder, by number."""
    data = yaml.safe_load((Path(os.path.dirname(vd.__file__)) / "calibrations" / file).read_text())
    return sorted(data["lasers"], key=lambda laser: laser["laser_id"])


def calibration_of(file):
    """The decoder's calibration without distance corrections, which are of one unit."""
    source = Path(os.path.dirname(vd.__file__)) / "calibrations" / file
    data = yaml.safe_load(source.read_text())
    for laser in data["lasers"]:
        for key in ("dist_correction", "dist_correction_x", "dist_correction_y"):
            if key in laser:
                laser[key] = 0.0
    cleaned = FOLDER / file
    cleaned.write_text(yaml.safe_dump(data))
    return vd.Calibration.read(str(cleaned))


def velodyne_points(name, preset, dual):
    model, file, _ = MODELS[preset]
    if dual and preset == "HDL-64E-S3":
        model = vd.Model.HDL64E_S3
    config = vd.Config(model=model, calibration=calibration_of(file))
    rows = []
    for stamp, points in vd.read_pcap(str(FOLDER / f"{name}.pcap"), config, as_pcl_structs=True):
        xyz = np.stack([points["x"], points["y"], points["z"]], 1).astype(float)
        start = (stamp.device if hasattr(stamp, "device") else stamp) - EPOCH
        # the device's time counts from the hour
        start -= 3600.0 * np.round(start / 3600.0)
        time = points["time"].astype(float) + start
        rows.append(np.column_stack([xyz, time * 1e9, points["ring"]]))
    return np.concatenate(rows)


def with_vertical_origins(xyz, rings):
    """Points of the VLP-16 whose lasers start above and below the centre, by the vertical correction of its manual (63-9243):
    -41.91 mm tan(elevation), printed to 0.1 mm. The decoder leaves it out."""
    elevation = np.radians(2 * rings - 15)
    moved = xyz.copy()
    moved[:, 2] += np.round(-41.91 * np.tan(elevation), 1) * 1e-3
    return moved


def with_one_empty_slot(found):
    """Points of the VLS-128 as its manual times them (63-9483, 9.3.1): 2.665 us from group to group and one empty slot after
    the eighth group. The decoder has the table of VeloView, with two slots of 2.66666 us, and turns the head on by as much."""
    lasers = yaml.safe_load((FOLDER / MODELS["VLS-128"][1]).read_text())["lasers"]
    laser = np.argsort([one["vert_correction"] for one in lasers])[found[:, 4].astype(int)]  # rings count upwards
    late_us = (laser // 8 + laser // 64 * 2) * 2.66666 - (laser // 8 + laser // 64) * 2.665
    angle = 2 * np.pi * 10 * late_us * 1e-6  # clockwise at 10 turns per second
    x, y = found[:, 0].copy(), found[:, 1].copy()
    moved = found.copy()
    moved[:, 0], moved[:, 1] = x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)
    moved[:, 3] -= late_us * 1e3
    return moved


def nearest_errors(found, encoded):
    """Distance and time from every found point to the encoded return of its ring: those of the same pulse."""
    errors = []
    for ring in np.unique(encoded[:, 4]):
        mine, theirs = encoded[encoded[:, 4] == ring], found[found[:, 4] == ring]
        order = np.argsort(mine[:, 3])
        mine = mine[order]
        at = np.searchsorted(mine[:, 3], theirs[:, 3])
        best = np.full(len(theirs), np.inf)
        time = np.zeros(len(theirs))
        bound = np.zeros(len(theirs))
        for step in range(-4, 5):
            index = np.clip(at + step, 0, len(mine) - 1)
            far = np.linalg.norm(mine[index, :3] - theirs[:, :3], axis=1)
            near = far < best
            best[near], time[near] = far[near], (theirs[:, 3] - mine[index, 3])[near]
            bound[near] = mine[index, 5][near]
        errors.append(np.column_stack([best, time, bound, np.full(len(theirs), ring), theirs[:, 3]]))
    return np.concatenate(errors)


class Velodyne(unittest.TestCase):
    def check(self, preset, dual):
        name = preset + ("-dual" if dual else "")
        encoded, unit = encoded_returns(name), MODELS[preset][2]
        found = velodyne_points(name, preset, dual)
        if preset == "VLS-128":
            found = with_one_empty_slot(found)
        if preset == "VLP-16":
            found[:, :3] = with_vertical_origins(found[:, :3], found[:, 4])
        single = encoded[:, 3]
        if not dual:
            self.assertEqual(len(found), len(single))
        error = nearest_errors(found, encoded)
        angle_deg, time_limit = 0.0105, 1100
        if preset == "VLS-128":
            # The decoder takes the rotation from the packets before, so the first have none.
            error = error[error[:, 4] > 1e6]
        excess = error[:, 0] - (unit / 2 + np.radians(angle_deg) * error[:, 2] + 2e-6)
        time = error[:, 1]
        print(f"{name}: {len(found)} points, position at most {error[:, 0].max() * 1e3:.2f} mm, "
              f"time at most {np.abs(time).max():.0f} ns")
        self.assertLess(excess.max(), 0.0)
        self.assertLess(np.abs(time).max(), time_limit)

    def test_hdl64_status_states_the_calibration(self):
        capture = str(FOLDER / "HDL-64E-S3-calibration.pcap")
        model, _ = vd.hdl64e.read_calibration_from_pcap(capture)
        self.assertEqual(model, vd.Model.HDL64E_S3)
        status = vd.hdl64e.read_status_info(vd.hdl64e.iter_pcap_packets(capture))
        self.assertEqual((status["RPM"], status["FOV Max"], status["Multiple Return Status"]), (600, 36000, "Strongest"))
        seconds = status["Current Time"].replace(tzinfo=datetime.timezone.utc).timestamp() - EPOCH
        self.assertTrue(-1 < seconds < 1.5, seconds)
        shipped = calibration_lasers("HDL-64E_S3-VeloView.yml")
        found = vd.hdl64e.status_info_to_calib_dict(status)["lasers"]
        for mine, theirs in zip(sorted(found, key=lambda laser: laser["laser_id"]), shipped, strict=True):
            for key in ("rot_correction", "vert_correction"):
                self.assertAlmostEqual(mine[key], theirs[key], delta=np.radians(0.00501))
            for key in ("vert_offset_correction", "horiz_offset_correction"):
                self.assertAlmostEqual(mine[key], theirs[key], delta=0.00051)

    def test_telemetry_is_read(self):
        packets = [data for _, data in vd.util.iter_pcap(str(FOLDER / "VLP-16.pcap")) if len(data) == 512]
        self.assertGreater(len(packets), 10)
        telemetry = vd.TelemetryPacket(packets[0])
        self.assertTrue(telemetry.nmea_sentence.startswith("$GPRMC"))
        position = telemetry.parse_nmea()
        self.assertAlmostEqual(position.latitude, 37.3875, places=5)
        self.assertAlmostEqual(position.longitude, -121.9723, places=5)


for preset_name in MODELS:
    for is_dual in (False, True):
        def test(self, preset=preset_name, dual=is_dual):
            self.check(preset, dual)
        title = preset_name.replace("-", "_").lower() + ("_dual" if is_dual else "")
        setattr(Velodyne, f"test_{title}", test)


class Ouster(unittest.TestCase):
    def check(self, profile, limit_mm):
        base = FOLDER / f"OS1-128-{profile}"
        encoded = encoded_returns(base.name)
        worst, count = 0.0, 0
        for scans in open_source(str(base) + ".pcap", meta=[str(base) + ".json"]):
            scan = scans[0] if not hasattr(scans, "h") else scans
            lut = XYZLut(scan.sensor_info)
            for field in ("RANGE", "RANGE2") if profile.endswith("DUAL") else ("RANGE",):
                ranges = scan.field(field)
                xyz = lut(ranges)
                stamp = np.broadcast_to(scan.timestamp.astype(np.int64)[None, :], ranges.shape)
                ring = np.broadcast_to(np.arange(scan.h)[:, None], ranges.shape)
                seen = ranges > 0
                found = np.column_stack([xyz[seen], (stamp[seen] - int(EPOCH * 1e6) * 1000).astype(float), ring[seen]])
                error = nearest_errors(found, encoded)
                worst, count = max(worst, error[:, 0].max() * 1e3), count + len(found)
        print(f"{profile}: {count} points, position at most {worst:.3f} mm")
        self.assertEqual(count, len(encoded))
        self.assertLess(worst, limit_mm)

    def test_legacy(self):
        self.check("LEGACY", 0.51)

    def test_single(self):
        self.check("RNG19_RFL8_SIG16_NIR16", 0.51)

    def test_dual(self):
        self.check("RNG19_RFL8_SIG16_NIR16_DUAL", 0.51)

    def test_low_data(self):
        self.check("RNG15_RFL8_NIR8", 4.5)

    def test_colour(self):
        for profile in ("RNG19_RFL8_SIG16_NIR16_RGB16", "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"):
            self.check(profile, 0.51)
            base = FOLDER / f"OS1-128-{profile}"
            for scans in open_source(str(base) + ".pcap", meta=[str(base) + ".json"]):
                scan = scans[0] if not hasattr(scans, "h") else scans
                share = (scan.field("REFLECTIVITY").astype(np.float32) / np.float32(255))[..., None]  # packet_fixture.hpp
                wanted = np.concatenate([share, 1 - share, share / 2], axis=2)
                error = np.abs(scan.field("RGB").astype(np.float32) - wanted)[scan.field("RANGE") > 0]
                self.assertLess(error.max(), 2**-11, profile)  # half precision below 2


def decode(capture, source, *options):
    """The returns that GLIDAR decodes from a capture file."""
    target = FOLDER / "decoded.returns"
    subprocess.run([PROGRAM, "decode", capture, source, target, *options], check=True)
    return np.fromfile(target).reshape(-1, 6)


def write_capture(path, payloads):
    """A capture file of UDP datagrams to port 2368: (nanoseconds, bytes) each."""
    with open(path, "wb") as file:
        file.write(struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 101))
        for stamp, payload in payloads:
            udp = struct.pack(">HHHH", 2368, 2368, 8 + len(payload), 0) + payload
            ip = struct.pack(">BBHHHBBHII", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0, 1, 1) + udp
            file.write(struct.pack("<IIII", stamp // 10**9, stamp % 10**9, len(ip), len(ip)) + ip)


def spherical(points):
    """Azimuth, elevation, range."""
    flat = np.hypot(points[:, 0], points[:, 1])
    return np.column_stack([np.arctan2(points[:, 1], points[:, 0]), np.arctan2(points[:, 2], flat),
                            np.hypot(flat, points[:, 2])])


def distances_to_driver(mine, theirs):
    """Distance from every point of Hesai's driver to the point with the same range and block azimuth, where that has the
    angles of the unit. The driver's points state these: their elevations are 32 numbers, and their azimuths are whole
    centidegrees, as blocks have them, and an offset per channel, of which the one that finds the most points is taken."""
    ours, angles = np.degrees(spherical(mine[:, :3])), np.degrees(spherical(theirs))
    azimuth, steps = np.round(-100 * ours[:, 0]).astype(int) % 36000, np.round(mine[:, 5] / 0.004).astype(int)
    channel = np.round(15 - angles[:, 1]).astype(int)  # the unit's elevations are within 0.1 degrees of the nominal ones
    distance = np.full(len(theirs), np.inf)
    for ring in range(32):
        points = channel == ring
        elevation = np.median(angles[points, 1])
        theirs_cdeg, length = -100 * angles[points, 0], np.linalg.norm(theirs[points], axis=1)
        fraction = np.angle(np.mean(np.exp(2j * np.pi * theirs_cdeg))) / (2 * np.pi)
        rows = mine[:, 4] == ring_of_channel(mine, ours, ring)
        known = azimuth[rows] * 65536 + steps[rows]
        keys = {k: (np.round(theirs_cdeg - fraction - k).astype(int) % 36000) * 65536 + np.round(length / 0.004).astype(int)
                for k in range(-30, 31)}
        best = max(keys, key=lambda k: np.isin(keys[k], known).sum())
        found = np.isin(keys[best], known)
        placed = np.radians(np.column_stack([-(keys[best] // 65536 + best + fraction) / 100,
                                             np.full(len(length), elevation)]))
        exact = cartesian(np.column_stack([placed, np.round(length / 0.004) * 0.004]))
        distance[points] = np.where(found, np.linalg.norm(exact - theirs[points], axis=1), np.inf)
    return distance


def ring_of_channel(points, angles_deg, channel):
    """The ring of the channel with the nominal elevation 15 degrees - channel."""
    return points[np.argmin(np.abs(angles_deg[:, 1] - (15 - channel))), 4]


def cartesian(angles):
    azimuth, elevation, length = angles.T
    return np.column_stack([length * np.cos(elevation) * np.cos(azimuth), length * np.cos(elevation) * np.sin(azimuth),
                            length * np.sin(elevation)])


def nearest_distances(points, others):
    """Distance from each point to the nearest of the others."""
    return cKDTree(others).query(points)[0]


@unittest.skipUnless(DATA.exists(), "GLIDAR_DATA is not set; set it to a folder with real data")
class Recordings(unittest.TestCase):
    def test_velodyne_is_decoded_as_by_velodyne_decoder(self):
        capture = DATA / "recordings/velodyne/sample_velodyne_vlp16_gps.pcap"
        mine = decode(capture, "VLP-16")
        config = vd.Config(model=vd.Model.VLP16, calibration=calibration_of("VLP-16.yml"))
        theirs = np.concatenate([
            np.column_stack([points["x"], points["y"], points["z"], points["ring"]]).astype(float)
            for _, points in vd.read_pcap(str(capture), config, as_pcl_structs=True)])
        self.assertEqual(len(mine), len(theirs))
        theirs[:, :3] = with_vertical_origins(theirs[:, :3], theirs[:, 3])
        distance = nearest_distances(theirs[:, :3], mine[:, :3])
        print(f"recorded VLP-16: {len(mine)} points, at most {distance.max() * 1e3:.2f} mm apart")
        # it rounds azimuths to 0.01 degrees and has one rotation rate per packet
        limit = 1e-4 + np.radians(0.02) * np.linalg.norm(theirs[:, :3], axis=1)
        self.assertLess((distance - limit).max(), 0.0)

    def check_ouster(self, name):
        base = DATA / "recordings/ouster" / name[0]
        capture = base.with_name(name[1])
        mine = decode(capture, f"{base}.json")
        theirs = []
        for scans in open_source(str(capture), meta=[f"{base}.json"]):
            scan = scans[0] if not hasattr(scans, "h") else scans
            height = scan.sensor_info.lidar_to_sensor_transform[2, 3]
            ranges = scan.field("RANGE")
            points = XYZLut(scan.sensor_info)(ranges)[ranges > 0]
            theirs.append(points - [0, 0, height * (1e-3 if abs(height) > 1 else 1)])
        theirs = np.concatenate(theirs)
        self.assertEqual(len(mine), len(theirs))
        order = [np.lexsort(np.round(points[:, :3], 4).T) for points in (mine, theirs)]
        distance = np.linalg.norm(mine[order[0], :3] - theirs[order[1]], axis=1)
        print(f"recorded {name[1]}: {len(mine)} points, 99.9 % within {np.quantile(distance, 0.999) * 1e3:.4f} mm")
        self.assertLess(np.quantile(distance, 0.999), 1e-4)

    def test_ouster_os0_is_decoded_as_by_ouster_sdk(self):
        self.check_ouster(("OS-0-128-U1_v2.3.0_1024x10", "OS-0-128-U1_v2.3.0_1024x10.pcap"))

    def test_ouster_os1_is_decoded_as_by_ouster_sdk(self):
        self.check_ouster(("OS-1-128_v2.3.0_1024x10", "OS-1-128_v2.3.0_1024x10_lb_n3.pcap"))

    def test_hesai_is_decoded_as_by_its_driver(self):
        bag = sqlite3.connect(f"file:{DATA}/depth/nebula/xt32.db3?mode=ro&immutable=1", uri=True)
        payloads = []
        for (data,) in bag.execute("select data from messages order by timestamp"):
            at = data.index(b"\xee\xff\x06\x01")
            while at >= 0:
                stamp = struct.unpack_from("<Q", data, at - 12)[0] if at >= 12 else 0
                seconds, nanoseconds = struct.unpack("<II", struct.pack("<Q", stamp))
                payloads.append((seconds * 10**9 + nanoseconds % 10**9, data[at:at + 1080]))
                at = data.find(b"\xee\xff\x06\x01", at + 1080)
        write_capture(FOLDER / "xt32.pcap", payloads)
        mine = decode(FOLDER / "xt32.pcap", "XT32", "dual", "still")
        raw = (DATA / "depth/nebula/xt32_last_turn.pcd").read_bytes()
        theirs = np.frombuffer(raw[raw.index(b"DATA binary\n") + 12:], "<f4").reshape(-1, 3).astype(float)
        theirs = np.column_stack([theirs[:, 1], -theirs[:, 0], theirs[:, 2]])  # its y is forward
        # The driver has the angles of this unit, the preset the nominal ones.
        distance = distances_to_driver(mine, theirs)
        limit = 0.002 + np.radians(0.01) * np.linalg.norm(theirs, axis=1)
        print(f"recorded XT32: {len(payloads)} packets, {len(theirs)} points of the driver, "
              f"{np.mean(distance < limit) * 100:.3f} % within the limit, at most {distance.max() * 1e3:.3f} mm")
        self.assertEqual(len(theirs), 63021)
        self.assertLess((distance - limit).max(), 0.0)
        self.assertLess(distance.max(), 1e-4)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = Path(folder)
        subprocess.run([PROGRAM, "write", folder], check=True)
        unittest.main()
