// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_files.hpp"

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <support/data.hpp>

#include <array>
#include <cstring>

namespace glidar {
namespace {

Sensor sensor_of(const std::string& content) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", content));
}

TEST(LidarFile, ReadsEveryKeyOfSpinningOptics) {
  const Sensor sensor = sensor_of(R"(
rate_hz: 20
wavelength_nm: 905
limits: {near_m: 0.5, far_m: 50, along: depth}
optics:
  type: spinning
  rotation_direction: counterclockwise
  start_azimuth_deg: 90
  firing_period_us: 50
  elevation_deg: [-10, 10]
  azimuth_right_deg: [1, -2]
  fire_time_us: [0, 2.5]
  channel_order: rising_elevation
  beam_origin_radial_mm: 1
  beam_origin_tangential_mm: [2, 3]
  beam_origin_axial_mm: 4
  beam_origin_mm: 15
  azimuth_range: {from_deg: -60, to_deg: 30}
)");
  EXPECT_EQ(sensor.rate_hz, 20.0);
  EXPECT_DOUBLE_EQ(sensor.wavelength_m, 905e-9);
  EXPECT_EQ(sensor.limits.along, Limits::Along::depth);
  const auto& s = std::get<Spinning>(sensor.optics);
  EXPECT_EQ(s.rotation_hz, 20.0);
  EXPECT_EQ(s.rotation_direction, Spinning::RotationDirection::counterclockwise);
  EXPECT_DOUBLE_EQ(s.start_azimuth_rad.value(), 90 * kDegree);
  EXPECT_EQ(s.firing_period_ns, 50'000.0);
  ASSERT_EQ(s.channels.size(), 2U);
  EXPECT_DOUBLE_EQ(s.channels[0].elevation_rad, -10 * kDegree);
  EXPECT_DOUBLE_EQ(s.channels[1].azimuth_offset_rad, 2 * kDegree);  // right is negative
  EXPECT_EQ(s.channels[1].fire_time_ns, 2500.0);
  EXPECT_EQ(s.channels[1].ring, 1U);
  EXPECT_TRUE(s.channels[1].origin_m.isApprox(Eigen::Vector3d(0.001, 0.003, 0.004)));
  EXPECT_DOUBLE_EQ(s.beam_origin_m, 0.015);
  EXPECT_DOUBLE_EQ(s.azimuth_start_rad, -60 * kDegree);
  EXPECT_DOUBLE_EQ(s.azimuth_width_rad, 90 * kDegree);
}

TEST(LidarFile, ReadsRastersAndPrisms) {
  const Sensor sensor = sensor_of(
      "rate_hz: 15\noptics: {type: line_scan, azimuth_deg: {from: -1, to: 1, count: 3}, "
      "elevation_deg: [5, 6], point_us: 10, line_us: 100, bidirectional: true}\n");
  const auto& raster = std::get<LineScan>(sensor.optics);
  EXPECT_EQ(raster.scan_hz, 15.0);
  ASSERT_EQ(raster.azimuths_rad.size(), 3U);
  EXPECT_DOUBLE_EQ(raster.azimuths_rad[2], kDegree);
  EXPECT_DOUBLE_EQ(raster.elevations_rad[1], 6 * kDegree);
  EXPECT_EQ(raster.line_ns, 100'000.0);
  EXPECT_TRUE(raster.bidirectional);
  const Sensor livox = sensor_of(
      "optics: {type: prism, pulse_hz: 1000, incidence_deg: [1, 2], prisms: "
      "[{rotation_hz: -3, apex_deg: 20, phase_deg: 90, refractive_index: 1.4, slope: exit}]}\n");
  const auto& prism = std::get<Prism>(livox.optics);
  EXPECT_EQ(livox.rate_hz, 10.0);
  EXPECT_DOUBLE_EQ(prism.incidence_rad[1], 2 * kDegree);
  EXPECT_EQ(prism.prisms[0].rotation_hz, -3.0);
  EXPECT_DOUBLE_EQ(prism.prisms[0].phase_rad, 90 * kDegree);
  EXPECT_EQ(prism.prisms[0].slope, RisleyPrism::Slope::exit);
}

TEST(LidarFile, ReadsLivoxTables) {
  const TestFolder folder;
  (void)folder.write("scan.csv",
                     "Time/s,Azimuth/deg,Zenith/deg\r\n0.1,0,90\r\n0.2,90,60\r\n"
                     "0.3,10,100\r\n0.4,20,80\r\n");
  const auto file = folder.write("s.yaml", "optics: {type: table, file: scan.csv}\n");
  const auto table = std::get<RayTable>(load_sensor_file(file).optics);
  ASSERT_EQ(table.cols, 4U);
  EXPECT_LT((table.directions[0] - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((table.directions[1] - direction_at(90 * kDegree, 30 * kDegree)).norm(), 1e-15);
  EXPECT_NEAR(table.times_ns[3], 0.3e9, 1e-3);
  EXPECT_NEAR(table.period_ns, 0.4e9, 1e-3);  // the first shot comes one step after the last
  const auto timed =
      folder.write("t.yaml", "optics: {type: table, file: scan.csv, point_us: 10, rows: 2}\n");
  const auto other = std::get<RayTable>(load_sensor_file(timed).optics);
  EXPECT_EQ(other.rows, 2U);
  EXPECT_EQ(other.times_ns[3], 30'000.0);
}

std::string npy(std::vector<std::size_t> shape, const std::vector<double>& numbers) {
  std::string bytes = npy_header("<f8", shape);
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  return bytes;
}

TEST(LidarFile, ReadsArraysOfRays) {
  const TestFolder folder;
  (void)folder.write("rays.npy", npy({2, 6}, {1, 2, 3, 0, 0, 1, 4, 5, 6, 0, 2, 0}));
  const auto file = folder.write("s.yaml", "optics: {type: table, file: rays.npy}\n");
  const auto table = std::get<RayTable>(load_sensor_file(file).optics);
  EXPECT_EQ(table.origins_m[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(table.directions[1], Eigen::Vector3d(0, 2, 0));
  (void)folder.write("rays.npy", npy({2, 1, 3}, {1, 0, 0, 0, 1, 0}));
  const auto grid = std::get<RayTable>(load_sensor_file(file).optics);
  EXPECT_EQ(grid.rows, 2U);
  EXPECT_TRUE(grid.origins_m.empty());
  const std::string numbers("\0\0\1\0\xFE\0", 6);  // 0, 0, 1, 0, -2, 0
  (void)folder.write("rays.npy", npy_header("|i1", std::array<std::size_t, 2>{2, 3}) + numbers);
  const auto whole = std::get<RayTable>(load_sensor_file(file).optics);
  EXPECT_EQ(whole.directions[1], Eigen::Vector3d(0, -2, 0));
}

TEST(LidarFile, HostileRayFilesAreRefused) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "optics: {type: table, file: rays.npy}\n");
  const std::string good = npy({1, 3}, {1, 0, 0});
  std::string huge = npy_header("<f8", std::array<std::size_t, 2>{std::size_t{1} << 60U, 3});
  for (const std::string& bytes :
       {std::string(), std::string("no array at all"), good.substr(0, 20),
        good.substr(0, good.size() - 1), npy({3, 1}, {1, 0, 0}), npy({0, 3}, {}), huge,
        npy_header("<c8", std::array<std::size_t, 2>{1, 3}) + std::string(24, '\0')}) {
    (void)folder.write("rays.npy", bytes);
    EXPECT_NE(error_of(folder, [&] { load_sensor_file(file); }).find("rays.npy"),
              std::string::npos);
  }
}

struct BadLidarFile : ::testing::TestWithParam<BadFile> {};

TEST_P(BadLidarFile, IsReportedWithLocationAndReason) {
  const TestFolder folder;
  (void)folder.write("bad.csv", "Time/s,Azimuth/deg,Zenith/deg\n0,1,2\n0,x,2\n");
  (void)folder.write("falling.csv", "1,1,2\n0,1,2\n");
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadLidarFile,
    ::testing::Values(
        BadFile{
            "type", "optics: {type: spining}\n",
            "s.yaml:1:16: optics.type: 'spining'; allowed: pinhole, spinning, line_scan, prism, "
            "wedge_mirror, table, ouster; did you mean 'spinning'?"},
        BadFile{"counts",
                "optics: {type: spinning, firing_period_us: 5, elevation_deg: [1, 2], "
                "fire_time_us: [0]}\n",
                "s.yaml:1:84: optics.fire_time_us: a list of 1; allowed: one number, or 2: one "
                "for each of elevation_deg"},
        BadFile{
            "both",
            "optics: {type: spinning, firing_period_us: 5, columns_per_turn: 9, elevation_deg: "
            "[1]}\n",
            "s.yaml:1:44: optics.firing_period_us: given beside 'columns_per_turn'; allowed: one "
            "of columns_per_turn and firing_period_us; remove one of them"},
        BadFile{"csv", "optics: {type: table, file: bad.csv}\n",
                "bad.csv:3: no three numbers; allowed: Time/s,Azimuth/deg,Zenith/deg"},
        BadFile{"falling", "optics: {type: table, file: falling.csv}\n",
                "falling.csv: the times fall at shot 2; allowed: times that rise; give "
                "'point_us', the time from shot to shot, to ignore the file's"},
        BadFile{"missing", "optics: {type: table, file: none.csv}\n", "none.csv: no such file"},
        BadFile{"source", "optics: {width: 1, height: 1, fov_deg: 9}\nsource: {optics.wdth: x}\n",
                "s.yaml:2:23: source.optics.wdth: 'optics.wdth' is no key of this file; allowed: "
                "a key such as optics.elevation_deg; did you mean 'optics.width'?"}),
    bad_file_name);

TEST(OusterFile, ReadsMetadataOfRealSensors) {
  GLIDAR_NEEDS_DATA();
  const TestFolder folder;
  const auto read = [&](const std::string& name) {
    const auto path = testing::data_folder() / "recordings/ouster" / name;
    return load_sensor_file(
        folder.write("s.yaml", "optics: {type: ouster, file: " + path.string() + "}\n"));
  };
  const Sensor old_layout = read("OS-1-128_v2.3.0_1024x10.json");
  const auto& s = std::get<Spinning>(old_layout.optics);
  EXPECT_EQ(old_layout.rate_hz, 10.0);
  EXPECT_EQ(s.columns_per_turn, 1024U);
  EXPECT_DOUBLE_EQ(s.beam_origin_m, 0.015806);
  ASSERT_EQ(s.channels.size(), 128U);
  EXPECT_DOUBLE_EQ(s.channels[0].elevation_rad, 20.95 * kDegree);
  EXPECT_DOUBLE_EQ(s.channels[0].azimuth_offset_rad, -4.21 * kDegree);
  EXPECT_EQ(make_beams(old_layout).cols, 1024U);
  const Sensor new_layout = read("crc_test.json");
  EXPECT_EQ(make_beams(new_layout).cols, 512U);
  EXPECT_DOUBLE_EQ(std::get<Spinning>(new_layout.optics).beam_origin_m, 0.027116);
}

/// Metadata of firmware 1: flat, without the numbers that later firmware states.
std::string old_metadata(const std::string& rows, const std::string& more) {
  return R"({"lidar_mode": "1024x10", "beam_altitude_angles": )" + rows +
         R"(, "beam_azimuth_angles": )" + rows + more + "}";
}

TEST(OusterFile, FirmwareOneHasTheDefaultOriginsOfTheManufacturersLibrary) {
  // ouster-sdk, metadata.cpp: default_lidar_origin_to_beam_origin()
  for (const auto& [line, origin_mm] :
       {std::pair("", 12.163), std::pair("OS-0-64", 27.67), std::pair("OS-1-64", 15.806),
        std::pair("OS-2-64", 13.762), std::pair("OS1-64", 12.163)}) {
    const std::string more = *line == '\0' ? "" : R"(, "prod_line": ")" + std::string(line) + "\"";
    const OusterMetadata read = parse_ouster_metadata(old_metadata("[3, 1]", more), "m.json");
    EXPECT_DOUBLE_EQ(read.spinning.beam_origin_m, origin_mm * 1e-3) << line;
    ASSERT_EQ(read.notes.size(), 1U);
    EXPECT_EQ(read.notes[0],
              "m.json: no lidar_origin_to_beam_origin_mm: " + number_text(origin_mm) +
                  " mm, the manufacturer's default for the product line");
  }
}

TEST(OusterFile, SectionsAndOldNamesOfSectionsAreFlat) {
  const std::string rows = R"("beam_altitude_angles": [3, 1], "beam_azimuth_angles": [3, 1])";
  for (const std::string& text :
       {R"({"lidar_mode": "512x20", "lidar_origin_to_beam_origin_mm": 15, )" + rows + "}",
        R"({"config_params": {"lidar_mode": "512x20"}, "beam_intrinsics": )"
        R"({"lidar_origin_to_beam_origin_mm": 15, )" +
            rows + "}}",
        R"({"config_txt": {"lidar_mode": "512x20"}, "beam_intrinsics": )"
        R"({"lidar_origin_to_beam_origin_mm": 15, )" +
            rows + "}}",
        R"({"lidar_data_format": {"columns_per_frame": 512, "fps": 20}, "beam_intrinsics": )"
        R"({"lidar_origin_to_beam_origin_mm": 15, )" +
            rows + "}}"}) {
    const OusterMetadata read = parse_ouster_metadata(text, "m.json");
    EXPECT_EQ(read.spinning.columns_per_turn, 512U) << text;
    EXPECT_EQ(read.spinning.rotation_hz, 20.0) << text;
    EXPECT_DOUBLE_EQ(read.spinning.beam_origin_m, 0.015) << text;
    EXPECT_EQ(read.spinning.start_azimuth_rad, std::numbers::pi);
    EXPECT_EQ(read.spinning.azimuth_width_rad, kTwoPi);
    EXPECT_TRUE(read.notes.empty()) << read.notes.front();
  }
}

TEST(OusterFile, SixteenUsedRowsOfSixtyFourKeepTheirSlots) {
  std::string rows = "[";
  for (int row = 0; row < 64; ++row)
    rows += (row == 0 ? "" : ",") + std::string(row % 4 == 2 ? std::to_string(20 - row) : "0");
  const OusterSource source = parse_ouster_source(old_metadata(rows + "]", ""), "m.json");
  const auto& spinning = std::get<Spinning>(source.sensor.optics);
  ASSERT_EQ(spinning.channels.size(), 16U);
  EXPECT_DOUBLE_EQ(spinning.channels[15].elevation_rad, (20 - 62) * kDegree);
  EXPECT_EQ(spinning.channels[15].ring, 15U);
  EXPECT_EQ(source.format.rows, 64U);
  EXPECT_EQ(source.format.slots[15], 62U);
  EXPECT_EQ(source.sensor.notes.front(),
            "m.json: 48 of 64 rows have no beam: both of their angles are 0");
  // a packet with a distance of 1 m + 10 mm per slot
  OusterPacket packet;
  packet.columns.resize(16);
  for (std::size_t i = 0; i < 16; ++i) {
    OusterColumn& column = packet.columns[i];
    column.measurement = static_cast<std::uint16_t>(i);
    column.stamp_ns = 1'000'000 + 97'656 * i;
    column.is_valid = true;
    for (std::uint32_t slot = 0; slot < 64; ++slot)
      column.pixels.push_back({.range_mm = 1000 + 10 * slot});
  }
  const UdpPacket sent{0, kOusterLidarPort, kOusterLidarPort, encode(packet, source.format, 1024)};
  const auto decoder = make_ouster_decoder(source);
  std::vector<DecodedFrame> frames;
  decoder->decode(sent, frames);
  decoder->finish(frames);
  ASSERT_EQ(frames.size(), 1U);
  const DecodedFrame& frame = frames.front();
  ASSERT_EQ(frame.beams.rows, 16U);
  for (std::size_t i = 0; i < frame.frame.range_m.size(); ++i) {
    const std::size_t slot = 4U * frame.beams.rings[i] + 2;
    EXPECT_NEAR(frame.frame.range_m[i] + 0.012163, 1.0 + 0.01 * static_cast<double>(slot), 1e-12);
  }
}

TEST(OusterFile, BeamOriginsAboveThePlaneFollowTheFormulaOfTheManufacturersLibrary) {
  const std::string more =
      R"(, "beam_to_lidar_transform": [1,0,0,20, 0,1,0,0, 0,0,1,30, 0,0,0,1],
          "lidar_to_sensor_transform": [0,-1,0,0, 1,0,0,0, 0,0,1,36.18, 0,0,0,1])";
  const OusterMetadata read = parse_ouster_metadata(old_metadata("[3, 1]", more), "m.json");
  const Beams beams = make_beams(read.spinning, {0, 100'000'000});
  ASSERT_EQ(beams.size(), 2U * 1024U);
  const double n_m = std::hypot(0.020, 0.030);
  EXPECT_DOUBLE_EQ(beams.range_offset_m, n_m);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    // xyzlut.cpp: a point at the range r, in the lidar's frame, which is turned by 90 degrees here
    const double encoder = kTwoPi * (1.0 - static_cast<double>(i % 1024) / 1024.0);
    const double angle = (i < 1024 ? 3.0 : 1.0) * kDegree;
    const double r = 7.0;
    const Eigen::Vector3d lidar(
        (r - n_m) * std::cos(encoder - angle) * std::cos(angle) + 0.020 * std::cos(encoder),
        (r - n_m) * std::sin(encoder - angle) * std::cos(angle) + 0.020 * std::sin(encoder),
        (r - n_m) * std::sin(angle) + 0.030);
    const Eigen::Vector3d expected(-lidar.y(), lidar.x(), lidar.z());
    const Eigen::Vector3d found = beams.origins_m[i] + (r - n_m) * beams.directions[i];
    ASSERT_NEAR((found - expected).norm(), 0.0, 1e-13) << i;
  }
}

TEST(OusterFile, NumbersWithoutEffectAreNoted) {
  const std::string more = R"(, "prod_line": "OS-1-64", "lidar_origin_to_beam_origin_mm": 15.8,
      "data_format": {"columns_per_frame": 512}, "azimuth_window": [0, 180000],
      "ouster-sdk": {"extrinsic": [1,0,0,2, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  const OusterMetadata read = parse_ouster_metadata(old_metadata("[3, 1]", more), "m.json");
  EXPECT_EQ(read.notes, (std::vector<std::string>{
                            "m.json: columns_per_frame, 512, is not used: lidar_mode states 1024",
                            "m.json: extrinsic is not used: clouds are in the sensor's frame",
                            "m.json: azimuth_window is not used without column_window"}));
}

TEST(OusterFile, MaliciousMetadataIsRejected) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "optics: {type: ouster, file: m.json}\n");
  const std::string rest =
      R"("beam_azimuth_angles": [0], "lidar_origin_to_beam_origin_mm": 1, "lidar_mode": )";
  for (
      const std::string& text :
      {std::string("[[[["), std::string("{}"), std::string(R"({"beam_altitude_angles": 3})"),
       R"({"beam_altitude_angles": [1, 2], )" + rest + R"("1024x10"})",
       R"({"beam_altitude_angles": ["x"], )" + rest + R"("1024x10"})",
       R"({"beam_altitude_angles": [1], )" + rest + R"("99999999999x10"})",
       R"({"beam_altitude_angles": [0], )" + rest + R"("1024x10", "pixels_per_column": 64})",
       std::string(
           R"({"beam_altitude_angles": [0, 0], "beam_azimuth_angles": [0, 0], "lidar_mode": "1024x10"})"),
       R"({"beam_altitude_angles": [1], )" + rest + R"("1024x10", "beam_to_lidar_transform": [1]})",
       R"({"beam_altitude_angles": [1], )" + rest + R"("1024x10", "lidar_to_sensor_transform": )" +
           "[1,0,0,0,0,0,1,0,0,1,0,0,0,0,0,1]}",
       R"({"beam_altitude_angles": [1], )" + rest + R"("1024x10", "data_format": )" +
           R"({"column_window": [0, 4096]}})"}) {
    (void)folder.write("m.json", text);
    EXPECT_NE(error_of(folder, [&] { load_sensor_file(file); }).find("m.json"), std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace glidar
