// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Calibrations against the formulas of the manufacturers' drivers, on the packets that are sent.
#include "../packets/packet_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <support/test_folder.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

namespace glidar::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What a calibration states of a laser of a Velodyne sensor: radians and metres.
struct Laser {
  double rot, vert, dist, vert_offset, horiz_offset;
};

/// A sensor whose every number differs from the preset's and from its neighbour's.
Laser made_laser(std::size_t i) {
  const double elevation_deg = i % 2 == 0 ? -15.0 + static_cast<double>(i) : static_cast<double>(i);
  const auto n = static_cast<double>(i);
  return {0.003 * n - 0.02, (elevation_deg + 0.05 * n) * kDegree, 0.1 + 0.015 * n, 0.02 - 0.003 * n,
          0.026 - 0.002 * n};
}

std::string velodyne_yaml(std::size_t lasers, const std::string& more = "") {
  std::string text = "lasers:\n";
  for (std::size_t i = lasers; i-- > 0;) {  // their order is that of laser_id, not of the file
    const Laser laser = made_laser(i);
    text += fmt::format(
        "- {{dist_correction: {}, dist_correction_x: {}, dist_correction_y: {}, focal_distance: 0, "
        "focal_slope: 0, horiz_offset_correction: {}, laser_id: {}, rot_correction: {}, "
        "vert_correction: {}, vert_offset_correction: {}{}}}\n",
        laser.dist, laser.dist, laser.dist, laser.horiz_offset, i, laser.rot, laser.vert,
        laser.vert_offset, more);
  }
  return text + fmt::format("num_lasers: {}\ndistance_resolution: 0.002\n", lasers);
}

/// Encodes a frame of the room; returns its points, by time, and the packets.
struct Sent {
  std::vector<Eigen::Vector3d> points;  ///< rows x columns of the frame
  DecodedFrame frame;
  std::vector<UdpPacket> packets;
};

Sent send_room(const Sensor& sensor) {
  Sent sent{{}, room_frame(sensor, 0), {}};
  const Beams& beams = sent.frame.beams;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Eigen::Vector3d origin =
        beams.origins_m.empty() ? Eigen::Vector3d(0.0, 0.0, 0.0) : beams.origins_m[i];
    sent.points.push_back(origin + beams.directions[i] * sent.frame.frame.range_m[i]);
  }
  const auto encoder = make_packet_encoder(sensor, {});
  encoder->encode(sent.frame.frame, beams, sent.packets);
  encoder->finish(sent.packets);
  return sent;
}

/// The row of the frame whose ring is that of a laser.
std::size_t row_of(const Sent& sent, const Sensor& sensor, std::size_t laser) {
  const std::uint16_t ring = std::get<Spinning>(sensor.optics).channels[laser].ring;
  const Beams& beams = sent.frame.beams;
  for (std::size_t row = 0; row < beams.rows; ++row)
    if (beams.rings[row * beams.cols] == ring) return row;
  return beams.rows;
}

/// velodyne_pointcloud, rawdata.cc, unpack(): azimuth clockwise, x forward, y left.
Eigen::Vector3d driver_point(const Laser& laser, double azimuth_rad, double distance_m) {
  const double d = distance_m + laser.dist;
  const double a = azimuth_rad - laser.rot;
  const double xy = d * std::cos(laser.vert) - laser.vert_offset * std::sin(laser.vert);
  const double x = xy * std::sin(a) - laser.horiz_offset * std::cos(a);
  const double y = xy * std::cos(a) + laser.horiz_offset * std::sin(a);
  return {y, -x, d * std::sin(laser.vert) + laser.vert_offset * std::cos(laser.vert)};
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(VelodyneCalibration, PacketsGiveTheTruePointsByTheFormulaOfTheDriver) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("VLP-16", false);
  apply_calibration(folder.write("c.yaml", velodyne_yaml(16)), sensor);
  EXPECT_THAT(sensor.notes, IsEmpty());
  const Sent sent = send_room(sensor);
  std::size_t column = 0;
  std::size_t compared = 0;
  double excess_m = -1.0;
  for (const UdpPacket& sent_packet : sent.packets) {
    if (sent_packet.payload.size() != 1206) continue;
    const VelodynePacket packet = decode_velodyne_packet(sent_packet.payload);
    for (std::size_t firing = 0; firing < 24; ++firing, ++column) {
      if (column >= sent.frame.beams.cols) break;
      const std::size_t block = firing / 2;
      for (std::size_t laser = 0; laser < 16; ++laser) {
        const std::uint16_t units = packet.blocks[block].distance[firing % 2 * 16 + laser];
        const std::size_t entry = row_of(sent, sensor, laser) * sent.frame.beams.cols + column;
        ASSERT_EQ(units > 0, sent.frame.frame.status[entry] == Status::hit) << column;
        if (units == 0) continue;
        // the head turns on by 0.2 degrees in the 55.296 us of a firing
        const double at_us =
            55.296 * static_cast<double>(firing % 2) + 2.304 * static_cast<double>(laser);
        const double azimuth_rad =
            0.01 * kDegree * packet.blocks[block].azimuth + kTwoPi * 10.0 * at_us * 1e-6;
        const Eigen::Vector3d point = driver_point(made_laser(laser), azimuth_rad, 0.002 * units);
        const double limit_m = 0.0011 + 0.0105 * kDegree * point.norm();
        excess_m = std::max(excess_m, (point - sent.points[entry]).norm() - limit_m);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 10'000U);
  EXPECT_LE(excess_m, 0.0);
}

TEST(VelodyneCalibration, RingsCountByElevationLikeThoseOfThePreset) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("VLP-16", false);
  apply_calibration(folder.write("c.yaml", velodyne_yaml(16)), sensor);
  const auto& channels = std::get<Spinning>(sensor.optics).channels;
  for (const SpinningChannel& one : channels)
    for (const SpinningChannel& other : channels)
      EXPECT_EQ(one.ring < other.ring, one.elevation_rad < other.elevation_rad);
  EXPECT_DOUBLE_EQ(channels[3].fire_time_ns, 3 * 2304.0);  // as in the preset
}

TEST(VelodyneCalibration, NotesNumbersThatAreNotUsed) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("VLP-16", false);
  std::string text = velodyne_yaml(16, ", two_pt_correction_available: true, min_intensity: 40");
  text.replace(text.find("dist_correction_x: 0"), 20, "dist_correction_x: 2");
  text.replace(text.find("focal_slope: 0"), 14, "focal_slope: 2");
  apply_calibration(folder.write("c.yaml", text), sensor);
  EXPECT_THAT(sensor.notes,
              ElementsAre(HasSubstr("dist_correction_x and dist_correction_y of 1 laser is not"),
                          HasSubstr("focal_distance and focal_slope of 1 laser is not"),
                          HasSubstr("min_intensity and max_intensity of 16 lasers are not")));
}

TEST(VelodyneCalibration, IsRefusedWithItsLineWhenItDoesNotFit) {
  const TestFolder folder;
  const auto message = [&](const std::string& text) {
    Sensor sensor = packet_sensor("VLP-16", false);
    const auto file = folder.write("c.yaml", text);
    return message_of([&] { apply_calibration(file, sensor); });
  };
  EXPECT_THAT(message(velodyne_yaml(15)),
              HasSubstr("c.yaml: num_lasers: 15 channels; allowed: 16"));
  std::string text = velodyne_yaml(16);
  EXPECT_THAT(
      message(text.replace(text.find("0.002\n"), 5, "0.004")),
      HasSubstr("c.yaml:19:22: distance_resolution: 0.004; allowed: 0.002, as in packets of "
                "a VLP-16"));
  text = velodyne_yaml(16);
  EXPECT_THAT(message(text.replace(text.find("laser_id: 15"), 12, "laser_id: 14")),
              HasSubstr("c.yaml:2:1: lasers: laser_id 14; allowed: each number from 0 to 15 once"));
  text = velodyne_yaml(16);
  EXPECT_THAT(message(text.replace(text.find("rot_correction"), 14, "rot_corection")),
              HasSubstr("c.yaml:2:"));
  text = velodyne_yaml(16);
  EXPECT_THAT(message(text.replace(text.find("num_lasers: 16"), 14, "num_lasers: 17")),
              HasSubstr("c.yaml:18:13: num_lasers: 17, but 16 lasers"));
}

std::string hesai_angles() {
  std::string text = "Channel,Elevation,Azimuth\r\n";
  for (int i = 1; i <= 32; ++i)
    text += fmt::format("{},{},{}\r\n", i, 15.07 - 0.99 * i, 0.4 - 0.03 * i);
  return text;
}

std::string hesai_times() {
  std::string text = "Channel,fire time(us)\n";
  for (int i = 32; i >= 1; --i) text += fmt::format("{},{}\n", i, 5.5 + 1.4 * i);
  return text;
}

TEST(HesaiCalibration, PacketsGiveTheTruePointsByTheFormulaOfTheSdk) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("XT32", false);
  apply_calibration(folder.write("angles.csv", hesai_angles()), sensor);
  apply_calibration(folder.write("times.csv", hesai_times()), sensor);
  EXPECT_THAT(sensor.files, ::testing::Contains((folder / "times.csv").string()));
  const Sent sent = send_room(sensor);
  const HesaiModel& model = *find_hesai_model(sensor);
  std::size_t column = 0;
  std::size_t compared = 0;
  double excess_m = -1.0;
  for (const UdpPacket& sent_packet : sent.packets) {
    const HesaiPacket packet = decode_hesai_packet(sent_packet.payload, model);
    for (const HesaiPacket::Block& block : packet.blocks) {
      if (column == sent.frame.beams.cols) break;
      for (int laser = 1; laser <= 32; ++laser) {
        const std::size_t at = static_cast<std::size_t>(laser) - 1;
        if (block.points[at].distance == 0) continue;
        // HesaiLidar_SDK_2.0, GetFiretimesCorrection(): us times rpm times 6e-6 degrees
        const double azimuth_deg =
            0.01 * block.azimuth + (5.5 + 1.4 * laser) * 600.0 * 6e-6 + (0.4 - 0.03 * laser);
        const double a = azimuth_deg * kDegree;
        const double e = (15.07 - 0.99 * laser) * kDegree;
        const double d = 0.004 * block.points[at].distance;
        const Eigen::Vector3d point(d * std::cos(e) * std::cos(a), -d * std::cos(e) * std::sin(a),
                                    d * std::sin(e));
        const std::size_t entry = row_of(sent, sensor, at) * sent.frame.beams.cols + column;
        const double limit_m = 0.0021 + 0.0105 * kDegree * d;
        excess_m = std::max(excess_m, (point - sent.points[entry]).norm() - limit_m);
        ++compared;
      }
      ++column;
    }
  }
  EXPECT_GT(compared, 10'000U);
  EXPECT_LE(excess_m, 0.0);
}

TEST(HesaiCalibration, TakesAVersionLineAChecksumAndOtherTitles) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("XT32", false);
  std::string text = hesai_angles();
  text.replace(0, 7,
               "\xEF\xBB\xBF"
               "EEFF,1,1\nLaser id");
  apply_calibration(folder.write("angles.csv", text + "d41d8cd98f00b204e9800998ecf8427e\n"),
                    sensor);
  EXPECT_DOUBLE_EQ(std::get<Spinning>(sensor.optics).channels[1].elevation_rad,
                   (15.07 - 1.98) * kDegree);
  EXPECT_DOUBLE_EQ(std::get<Spinning>(sensor.optics).channels[1].azimuth_offset_rad,
                   -(0.4 - 0.06) * kDegree);
}

TEST(HesaiCalibration, LoopsThatTheSensorDoesNotHaveAreNoted) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("XT32", false);
  std::string text = "laser_id,loop0_firetime,loop1_firetime\n";
  for (int i = 1; i <= 32; ++i) text += fmt::format("{},{},{}\n", i, i, 100 + i);
  apply_calibration(folder.write("times.csv", text), sensor);
  EXPECT_DOUBLE_EQ(std::get<Spinning>(sensor.optics).channels[31].fire_time_ns, 32'000.0);
  EXPECT_THAT(sensor.notes, ElementsAre(HasSubstr("1 further firing loops are not used")));
}

TEST(HesaiCalibration, IsRefusedWithItsLineWhenItDoesNotFit) {
  const TestFolder folder;
  const auto message = [&](const std::string& text) {
    Sensor sensor = packet_sensor("XT32", false);
    const auto file = folder.write("c.csv", text);
    return message_of([&] { apply_calibration(file, sensor); });
  };
  EXPECT_THAT(message("Channel,Elevation,Azimuth\n1,0,0\n2,1,0\n"),
              HasSubstr("c.csv: 2 channels; allowed: 32, as the sensor"));
  std::string text = hesai_angles();
  EXPECT_THAT(message(text.replace(text.find("\n7,"), 3, "\n6,")),
              HasSubstr("c.csv:8: channel 6; allowed: each number of a channel from 1 to 32 once"));
  text = hesai_angles();
  EXPECT_THAT(message(text.replace(text.find("\n3,"), 3, "\n3,x")), HasSubstr("c.csv:4: 'x1"));
  text = hesai_times();
  EXPECT_THAT(message(text.replace(text.find(",50.3"), 5, ",nan")), HasSubstr("c.csv:2: 'nan'"));
  EXPECT_THAT(message("a,b\n1,2\n"), HasSubstr("c.csv:1: a table of other columns; allowed: "));
  EXPECT_THAT(message(""), HasSubstr("c.csv"));
  Sensor scanner;
  scanner.optics = LineScan{};
  const auto file = folder.write("c.csv", hesai_times());
  EXPECT_THAT(message_of([&] { apply_calibration(file, scanner); }),
              HasSubstr("a calibration of a sensor with the optics line_scan; allowed: a camera or "
                        "a spinning LiDAR"));
}

TEST(OusterCalibration, ReplacesTheOpticsOfAPreset) {
  const TestFolder folder;
  Sensor sensor = packet_sensor("OS1-16", false);
  std::string angles;
  for (int i = 0; i < 16; ++i) angles += fmt::format("{}{}", i == 0 ? "" : ",", 15.5 - 2 * i);
  const std::string text =
      R"({"lidar_mode": "512x20", "prod_line": "OS-1-16", "beam_altitude_angles": [)" + angles +
      R"(], "beam_azimuth_angles": [)" + angles + "]}";
  apply_calibration(folder.write("m.json", text), sensor);
  const auto& spinning = std::get<Spinning>(sensor.optics);
  EXPECT_EQ(sensor.rate_hz, 20.0);
  EXPECT_EQ(spinning.columns_per_turn, 512U);
  EXPECT_DOUBLE_EQ(spinning.channels[1].elevation_rad, 13.5 * kDegree);
  EXPECT_DOUBLE_EQ(spinning.beam_origin_m, 0.015806);
  EXPECT_THAT(sensor.notes, ElementsAre(HasSubstr("15.806 mm")));
}

TEST(SpinningKeys, CalibrationFilesOfASensorFileReplaceItsNumbersAndRoundTrip) {
  const TestFolder folder;
  (void)folder.write("c.yaml", velodyne_yaml(16));
  (void)folder.write("angles.csv", hesai_angles());
  (void)folder.write("times.csv", hesai_times());
  const Sensor velodyne = load_sensor_file(folder.write(
      "v.yaml", "optics: {type: spinning, columns_per_turn: 1800, calibration_file: c.yaml}\n"));
  const auto& channels = std::get<Spinning>(velodyne.optics).channels;
  ASSERT_EQ(channels.size(), 16U);
  EXPECT_DOUBLE_EQ(channels[5].distance_correction_m, made_laser(5).dist);
  EXPECT_DOUBLE_EQ(channels[5].azimuth_offset_rad, made_laser(5).rot);
  const Sensor again = parse_sensor(sensor_document(velodyne));
  EXPECT_EQ(sensor_document(again), sensor_document(velodyne));
  for (std::size_t i = 0; i < 16; ++i) {
    const SpinningChannel& one = std::get<Spinning>(again.optics).channels[i];
    EXPECT_EQ(one.elevation_rad, channels[i].elevation_rad);
    EXPECT_EQ(one.distance_correction_m, channels[i].distance_correction_m);
    EXPECT_EQ(one.origin_m, channels[i].origin_m);
  }
  std::string elevations = "[0";
  for (int i = 1; i < 32; ++i) elevations += fmt::format(", {}", i);
  const Sensor hesai = load_sensor_file(folder.write(
      "h.yaml",
      "optics: {type: spinning, columns_per_turn: 1800, fire_time_us: 3, elevation_deg: " +
          elevations + "], calibration_file: angles.csv, fire_time_file: times.csv}\n"));
  const auto& lasers = std::get<Spinning>(hesai.optics).channels;
  EXPECT_DOUBLE_EQ(lasers[0].elevation_rad, (15.07 - 0.99) * kDegree);
  EXPECT_DOUBLE_EQ(lasers[0].fire_time_ns, 6900.0);
  EXPECT_THAT(hesai.files,
              ElementsAre((folder / "angles.csv").string(), (folder / "times.csv").string(),
                          (folder / "h.yaml").string()));
}

TEST(PinholeKeys, EveryCameraModelRoundTrips) {
  for (const std::string model :
       {"{model: radial_tangential, k1: -0.3, s1: 0.01, s2: 0.02, s3: 0.03, s4: 0.04, tau_x: 0.05, "
        "tau_y: -0.06}",
        "{model: omni, xi: 1.2, k1: -0.2, k2: 0.1, p1: 0.001, p2: 0.002}",
        "{model: double_sphere, xi: -0.2, alpha: 0.6}", "{model: eucm, alpha: 0.6, beta: 1.1}",
        "{model: fov, w: 0.93}", "{model: equirectangular}"}) {
    const Sensor sensor = parse_sensor(
        "optics: {type: pinhole, width: 64, height: 48, fx: 60, fy: 61, skew: 0.3, distortion: " +
        model + "}\n");
    EXPECT_EQ(std::get<Pinhole>(sensor.optics).skew_px, 0.3);
    const std::string document = sensor_document(sensor);
    const Sensor again = parse_sensor(document);
    EXPECT_EQ(sensor_document(again), document);
    const Beams beams = make_beams(sensor);
    const Beams same = make_beams(again);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (!beams.directions[i].allFinite()) continue;
      ASSERT_EQ(same.directions[i], beams.directions[i]);
    }
  }
}

TEST(PinholeKeys, PanoramasNeedNoFocalLengthAndTakeNoFieldOfView) {
  const std::string panorama =
      "optics: {width: 64, height: 32, distortion: {model: equirectangular}";
  const Sensor sensor = parse_sensor(panorama + "}\n");
  EXPECT_DOUBLE_EQ(std::get<Pinhole>(sensor.optics).intrinsics.fx, 64 / kTwoPi);
  EXPECT_DOUBLE_EQ(std::get<Pinhole>(sensor.optics).intrinsics.fy, 32 / std::numbers::pi);
  EXPECT_THAT(message_of([&] { parse_sensor(panorama + ", fov_x_deg: 90}\n"); }),
              HasSubstr("fov_x_deg: given for an equirectangular image; allowed: fx and fy"));
}

TEST(KalibrCalibration, IsRefusedWithItsLineWhenItDoesNotFit) {
  const TestFolder folder;
  const auto message = [&](const std::string& text, const std::string& name = "") {
    Sensor sensor;
    const auto file = folder.write("c.yaml", text);
    return message_of([&] { apply_calibration(file.string() + name, sensor); });
  };
  const std::string rest = "  resolution: [64, 48]\n";
  EXPECT_THAT(message("cam0:\n  camera_model: ds\n  intrinsics: [1, 2, 3, 4]\n" + rest),
              HasSubstr("c.yaml:3:15: cam0.intrinsics: 4 numbers; allowed: 6 numbers"));
  EXPECT_THAT(message("cam0:\n  camera_model: ds\n  intrinsics: [-2, 0.5, 3, 4, 5, 6]\n" + rest),
              HasSubstr("c.yaml:3:15: cam0.intrinsics: a number out of range"));
  EXPECT_THAT(message("cam0:\n  camera_model: eucm\n  distortion_model: radtan\n" + rest),
              HasSubstr("c.yaml:3:21: cam0.distortion_model: 'radtan' with the camera model eucm"));
  EXPECT_THAT(
      message("cam0:\n  camera_model: pinhole\n  intrinsics: [1, 2, 3, 4]\n" + rest, "#cam3"),
      HasSubstr("cam3"));
  EXPECT_THAT(message("a: 1\n"), HasSubstr("cam0"));
}

}  // namespace
}  // namespace glidar::testing
