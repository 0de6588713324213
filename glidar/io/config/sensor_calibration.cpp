// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_calibration.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/optics/spinning.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar {
namespace {

namespace fs = std::filesystem;

const TextFileKind kCalibrationFile = {"a calibration of a sensor", 8, ""};
constexpr const char* kKinds =
    "metadata JSON of Ouster, calibration YAML of velodyne_pointcloud, angle correction or firing "
    "time CSV of Hesai";

void set_lasers(std::size_t found, const std::string& where, const char* remedy,
                std::vector<SpinningChannel>& channels) {
  if (channels.empty()) {
    channels.resize(found);
    for (std::size_t i = 0; i < found; ++i) channels[i].ring = static_cast<std::uint16_t>(i);
  }
  if (channels.size() == found) return;
  throw Error({where, std::to_string(found) + " channels",
               std::to_string(channels.size()) + ", as the sensor", remedy});
}

constexpr const char* kOtherSensor = "use the calibration of this sensor, or the sensor's preset";

// Ouster

void apply_ouster(const std::string& text, const fs::path& path, Sensor& sensor) {
  OusterMetadata metadata = parse_ouster_metadata(text, path.string());
  auto& spinning = std::get<Spinning>(sensor.optics);
  set_lasers(metadata.spinning.channels.size(), path.string(), kOtherSensor, spinning.channels);
  spinning = std::move(metadata.spinning);
  sensor.rate_hz = spinning.rotation_hz;
  sensor.notes.insert(sensor.notes.end(), metadata.notes.begin(), metadata.notes.end());
}

// Velodyne

/// A laser, with the keys of velodyne_pointcloud's calibration.cpp: radians and metres.
struct VelodyneLaser {
  std::uint32_t laser_id = 0;
  double rot_correction = 0.0;
  double vert_correction = 0.0;
  double dist_correction = 0.0;
  bool has_two_points = false;
  double dist_correction_x = 0.0;
  double dist_correction_y = 0.0;
  double vert_offset_correction = 0.0;
  double horiz_offset_correction = 0.0;
  double focal_distance = 0.0;
  double focal_slope = 0.0;
  double min_intensity = 0.0;
  double max_intensity = 255.0;
};

void describe(VelodyneLaser& laser, FieldVisitor& visitor) {
  constexpr NumberRule kTurn = {-6.2832, 6.2832, false, "radians from -6.2832 to 6.2832"};
  constexpr NumberRule kElevation = {-1.5708, 1.5708, false, "radians from -1.5708 to 1.5708"};
  constexpr NumberRule kMetres = {-10.0, 10.0, false, "metres from -10 to 10"};
  visitor.whole_number({"laser_id", "", kNoUnit, kRequired}, {0, kMaxChannels - 1}, laser.laser_id);
  visitor.number({"rot_correction", "", kNoUnit, kRequired}, kTurn, laser.rot_correction);
  visitor.number({"vert_correction", "", kNoUnit, kRequired}, kElevation, laser.vert_correction);
  visitor.number({"dist_correction", "", kNoUnit, kRequired}, kMetres, laser.dist_correction);
  visitor.boolean({"two_pt_correction_available", ""}, laser.has_two_points);
  visitor.number({"dist_correction_x", ""}, kMetres, laser.dist_correction_x);
  visitor.number({"dist_correction_y", ""}, kMetres, laser.dist_correction_y);
  visitor.number({"vert_offset_correction", ""}, kMetres, laser.vert_offset_correction);
  visitor.number({"horiz_offset_correction", ""}, kMetres, laser.horiz_offset_correction);
  visitor.number({"focal_distance", ""}, kFinite, laser.focal_distance);
  visitor.number({"focal_slope", ""}, kFinite, laser.focal_slope);
  visitor.number({"min_intensity", ""}, kFinite, laser.min_intensity);
  visitor.number({"max_intensity", ""}, kFinite, laser.max_intensity);
}

struct VelodyneCalibration {
  std::uint32_t num_lasers = 0;
  double distance_resolution = 0.0;
  std::vector<VelodyneLaser> lasers;
  std::string resolution_place;  ///< for errors
};

void describe(VelodyneCalibration& file, FieldVisitor& visitor) {
  constexpr NumberRule kMetresPerUnit = {0.0, 1.0, true, "metres above 0, below 1"};
  visitor.whole_number({"num_lasers", "", kNoUnit, kRequired}, {1, kMaxChannels}, file.num_lasers);
  visitor.number({"distance_resolution", ""}, kMetresPerUnit, file.distance_resolution);
  file.resolution_place = visitor.where("distance_resolution");
  visit_list(visitor, {"lasers", "", kNoUnit, kRequired}, {1, kMaxChannels},
             "a list of 1 to 4096 lasers", file.lasers);
  if (file.lasers.size() != file.num_lasers)
    visitor.reject("num_lasers", "{}, but " + std::to_string(file.lasers.size()) + " lasers",
                   "the number of lasers");
  std::vector<bool> is_known(file.lasers.size(), false);
  for (const VelodyneLaser& laser : file.lasers) {
    if (laser.laser_id < is_known.size() && !is_known[laser.laser_id]) {
      is_known[laser.laser_id] = true;
      continue;
    }
    visitor.reject("lasers", "laser_id " + std::to_string(laser.laser_id),
                   "each number from 0 to " + std::to_string(is_known.size() - 1) + " once");
  }
}

/// Numbers without a counterpart in the simulation, each with the number of lasers that have it.
void note_unused(const VelodyneCalibration& calibration, const std::string& file, Sensor& sensor) {
  const auto note = [&](const char* numbers, const char* reason, auto is_unused) {
    const auto& lasers = calibration.lasers;
    const auto count = std::count_if(lasers.begin(), lasers.end(), is_unused);
    if (count == 0) return;
    sensor.notes.push_back(file + ": " + numbers + " of " + std::to_string(count) +
                           (count == 1 ? " laser is" : " lasers are") + " not used: " + reason);
  };
  note("dist_correction_x and dist_correction_y",
       "simulated distances need the same correction near and far; a driver that uses them moves "
       "near points",
       [](const VelodyneLaser& laser) {
         return laser.has_two_points && (laser.dist_correction_x != laser.dist_correction ||
                                         laser.dist_correction_y != laser.dist_correction);
       });
  note("focal_distance and focal_slope", "simulated intensities are calibrated",
       [](const VelodyneLaser& laser) { return laser.focal_slope != 0.0; });
  note("min_intensity and max_intensity", "simulated intensities are from 0 to 255",
       [](const VelodyneLaser& laser) {
         return laser.min_intensity != 0.0 || laser.max_intensity != 255.0;
       });
}

/// The next number that a sensor file in this unit can state.
double in_unit(double value, const FieldUnit& unit) {
  return value / unit.size * unit.size;
}

/// The beam of velodyne_pointcloud's rawdata.cc: a point at a distance d is
/// (d cos v - o sin v) out + h left + (d sin v + o cos v) up, with the vertical angle v, the
/// offsets o (vertical) and h (horizontal), and `out` at the head's azimuth plus rot_correction.
SpinningChannel channel_of(const VelodyneLaser& laser, SpinningChannel channel) {
  const SineCosine v = sincos_turns(laser.vert_correction / kTwoPi);
  const double offset_m = laser.vert_offset_correction;
  channel.elevation_rad = in_unit(laser.vert_correction, kUnitDegree);
  channel.azimuth_offset_rad = in_unit(laser.rot_correction, kUnitDegree);
  channel.origin_m = {in_unit(-offset_m * v.sine, kUnitMillimetre),
                      in_unit(laser.horiz_offset_correction, kUnitMillimetre),
                      in_unit(offset_m * v.cosine, kUnitMillimetre)};
  channel.distance_correction_m = in_unit(laser.dist_correction, kUnitMillimetre);
  return channel;
}

void apply_velodyne(const fs::path& path, Sensor& sensor) {
  VelodyneCalibration calibration;
  read_struct(read_yaml(path), calibration);
  auto& channels = std::get<Spinning>(sensor.optics).channels;
  set_lasers(calibration.lasers.size(), path.string() + ": num_lasers", kOtherSensor, channels);
  const VelodyneModel* model = find_velodyne_model(sensor);
  const double unit_m = calibration.distance_resolution;
  if (model != nullptr && unit_m != 0.0 && std::abs(unit_m - model->unit_m) > 1e-9)
    throw Error({calibration.resolution_place, number_text(unit_m),
                 number_text(model->unit_m) + ", as in packets of a " + std::string(model->name),
                 kOtherSensor});
  const auto order = channel_order_of(channels);
  for (const VelodyneLaser& laser : calibration.lasers)
    channels[laser.laser_id] = channel_of(laser, channels[laser.laser_id]);
  if (order) number_rings(*order, channels);
  note_unused(calibration, path.string(), sensor);
}

// Hesai

struct CsvRow {
  std::string where;  ///< file:line
  std::vector<std::string_view> cells;
};

std::string_view trimmed(std::string_view word) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = word.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return word.substr(first, word.find_last_not_of(kBlank) + 1 - first);
}

std::vector<CsvRow> csv_rows(std::string_view text, const fs::path& path) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<CsvRow> rows;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line = trimmed(line);
    if (line.empty()) continue;
    CsvRow& row = rows.emplace_back(CsvRow{path.string() + ":" + std::to_string(number), {}});
    for (bool is_last = false; !is_last;) {
      const std::size_t comma = line.find(',');
      is_last = comma == std::string_view::npos;
      row.cells.push_back(trimmed(line.substr(0, comma)));
      if (!is_last) line.remove_prefix(comma + 1);
    }
  }
  return rows;
}

double cell_number(const CsvRow& row, std::size_t at, const NumberRule& rule) {
  double value = 0.0;
  const std::string_view cell = at < row.cells.size() ? row.cells[at] : std::string_view();
  const auto [end, problem] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (problem == std::errc{} && end == cell.data() + cell.size() && accepts(rule, value))
    return value;
  throw Error({row.where, cell.empty() ? "no number" : "'" + shown(cell) + "'", rule.allowed});
}

std::string lower(std::string_view word) {
  std::string made(word);
  for (char& letter : made)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return made;
}

/// The columns of a table whose titles contain a word.
std::vector<std::size_t> columns_with(const CsvRow& titles, std::string_view word) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 1; i < titles.cells.size(); ++i)
    if (lower(titles.cells[i]).find(word) != std::string::npos) columns.push_back(i);
  return columns;
}

/// The rows below the titles: one per channel, whose number, from 1, is in the first cell.
struct ChannelTable {
  CsvRow titles;
  std::vector<std::pair<std::size_t, CsvRow>> rows;  ///< by channel, from 0
};

/// A first line "EEFF,..." (version) and a last line of one cell (checksum) are no channels.
ChannelTable channel_table(std::string_view text, const fs::path& path) {
  std::vector<CsvRow> rows = csv_rows(text, path);
  if (!rows.empty() && lower(rows.front().cells.front()) == "eeff") rows.erase(rows.begin());
  if (rows.size() > 2 && rows.back().cells.size() == 1) rows.pop_back();
  if (rows.size() < 2) throw Error({path.string(), "no table of channels", kKinds});
  ChannelTable table{rows.front(), {}};
  const std::size_t count = rows.size() - 1;
  std::vector<bool> is_known(count, false);
  const std::string allowed =
      "each number of a channel from 1 to " + std::to_string(count) + " once";
  const NumberRule rule = {1.0, static_cast<double>(count), false, allowed.c_str()};
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double number = cell_number(rows[i], 0, rule);
    const auto channel = static_cast<std::size_t>(number) - 1;
    if (number != static_cast<double>(channel + 1) || is_known[channel])
      throw Error({rows[i].where, "channel " + number_text(number), allowed});
    is_known[channel] = true;
    table.rows.emplace_back(channel, std::move(rows[i]));
  }
  return table;
}

/// HesaiLidar_SDK_2.0, udp6_1_parser.cc: the azimuth is clockwise and adds to that of the block.
void apply_angles(const ChannelTable& table, Spinning& spinning) {
  constexpr NumberRule kElevation = {-90.0, 90.0, false, "degrees from -90 to 90"};
  constexpr NumberRule kAzimuth = {-360.0, 360.0, false, "degrees from -360 to 360"};
  const std::size_t elevation = columns_with(table.titles, "elevation").front();
  const std::vector<std::size_t> azimuths = columns_with(table.titles, "azimuth");
  if (azimuths.empty())
    throw Error({table.titles.where, "no azimuths", "Channel,Elevation,Azimuth"});
  const auto order = channel_order_of(spinning.channels);
  for (const auto& [channel, row] : table.rows) {
    SpinningChannel& laser = spinning.channels[channel];
    laser.elevation_rad = cell_number(row, elevation, kElevation) * kDegree;
    laser.azimuth_offset_rad = -cell_number(row, azimuths.front(), kAzimuth) * kDegree;
  }
  if (order) number_rings(*order, spinning.channels);
}

/// One column of times, or one for each of the sensor's firing loops; of further loops, a sensor
/// without loops uses the first.
void apply_fire_times(const ChannelTable& table, const fs::path& path, Sensor& sensor) {
  constexpr NumberRule kFireTime = {-1e6, 1e6, false, "microseconds from -1e6 to 1e6"};
  auto& spinning = std::get<Spinning>(sensor.optics);
  const std::vector<std::size_t> columns = columns_with(table.titles, "fire");
  const std::size_t loops = spinning.firing_loops.size();
  if (loops > 0 && columns.size() != loops)
    throw Error({table.titles.where, std::to_string(columns.size()) + " columns of times",
                 std::to_string(loops) + ": one for each firing loop of the sensor", kOtherSensor});
  for (const auto& [channel, row] : table.rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double time_ns = cell_number(row, columns[i], kFireTime) * kMicrosecond_ns;
      if (loops == 0 && i == 0) spinning.channels[channel].fire_time_ns = time_ns;
      if (loops == 0) continue;
      FiringLoop& loop = spinning.firing_loops[i];
      const auto at = std::ranges::find(loop.channels, channel);
      if (at != loop.channels.end())
        loop.fire_times_ns[static_cast<std::size_t>(at - loop.channels.begin())] = time_ns;
    }
  }
  if (loops == 0 && columns.size() > 1)
    sensor.notes.push_back(path.string() + ": " + std::to_string(columns.size() - 1) +
                           " further firing loops are not used: the sensor has one");
}

void apply_hesai(std::string_view text, const fs::path& path, Sensor& sensor) {
  const ChannelTable table = channel_table(text, path);
  const bool has_angles = !columns_with(table.titles, "elevation").empty();
  if (!has_angles && columns_with(table.titles, "fire").empty())
    throw Error({table.titles.where, "a table of other columns", kKinds});
  auto& spinning = std::get<Spinning>(sensor.optics);
  if (!has_angles && spinning.channels.empty())
    throw Error({path.string(), "firing times of channels without elevations",
                 "a sensor with elevations, or with an angle correction CSV",
                 "add 'elevation_deg: ...', or 'calibration_file: ...'"});
  set_lasers(table.rows.size(), path.string(), kOtherSensor, spinning.channels);
  if (has_angles) return apply_angles(table, spinning);
  apply_fire_times(table, path, sensor);
}

// Cameras

std::vector<double> numbers_of(const YamlField& list, const std::vector<std::size_t>& sizes) {
  std::vector<double> numbers;
  for (const YamlField& item : items(list)) numbers.push_back(number(item, kFinite));
  if (std::ranges::find(sizes, numbers.size()) == sizes.end())
    reject(list, std::to_string(numbers.size()) + " numbers",
           fmt::format("{} numbers", fmt::join(sizes, ", ")));
  return numbers;
}

/// In OpenCV's order; coefficients that are left out are 0.
RadialTangential radial_tangential(std::vector<double> d) {
  d.resize(14);
  return {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8], d[9], d[10], d[11], d[12], d[13]};
}

Fisheye fisheye(const std::vector<double>& d) {
  return {d[0], d[1], d[2], d[3]};
}

void note_keys(const YamlField& map, const std::vector<std::string>& used, const std::string& file,
               Sensor& sensor) {
  std::vector<std::string> unused;
  for (const auto& [key, value] : entries(map))
    if (std::ranges::find(used, key) == used.end()) unused.push_back(shown(key));
  if (unused.empty()) return;
  sensor.notes.push_back(fmt::format("{}: not used: {}", file, fmt::join(unused, ", ")));
}

/// The distortion of a camera of Kalibr, and its intrinsics before fu, fv, pu, pv.
Distortion kalibr_distortion(const YamlField& camera, std::vector<double>& intrinsics) {
  static const std::vector<std::string> kModels = {"pinhole", "omni", "ds", "eucm"};
  static const std::vector<std::string> kDistortions = {"none", "radtan", "equidistant", "fov"};
  const std::size_t model = one_of(need(camera, "camera_model"), kModels);
  const auto field = find(camera, "distortion_model");
  const std::size_t kind = field ? one_of(*field, kDistortions) : 0;
  const std::size_t most = model == 0 ? 3U : (model == 1 ? 1U : 0U);
  if (kind > most)
    reject(
        *field, "'" + kDistortions[kind] + "' with the camera model " + kModels[model],
        fmt::format("{}", fmt::join(kDistortions.begin(), kDistortions.begin() + most + 1, ", ")));
  constexpr std::array<std::size_t, 4> kCoefficients = {0, 4, 4, 1};
  std::vector<double> d;
  if (kind > 0) d = numbers_of(need(camera, "distortion_coeffs"), {kCoefficients[kind]});
  constexpr std::array<std::size_t, 4> kExtra = {0, 1, 2, 2};
  const YamlField list = need(camera, "intrinsics");
  intrinsics = numbers_of(list, {4 + kExtra[model]});
  const std::vector<double> first(intrinsics.begin(),
                                  intrinsics.begin() + static_cast<long>(kExtra[model]));
  intrinsics.erase(intrinsics.begin(), intrinsics.begin() + static_cast<long>(kExtra[model]));
  const auto check = [&](bool is_allowed, const char* allowed) {
    if (!is_allowed) reject(list, "a number out of range", allowed);
  };
  if (model == 1) {
    check(first[0] >= 0.0 && first[0] <= 1e3, "xi from 0 to 1000");
    return Omni{first[0], radial_tangential(d)};
  }
  if (model == 2) {
    check(std::abs(first[0]) < 1.0 && first[1] >= 0.0 && first[1] <= 1.0,
          "xi above -1 and below 1, alpha from 0 to 1");
    return DoubleSphere{first[0], first[1]};
  }
  if (model == 3) {
    check(first[0] >= 0.0 && first[0] <= 1.0 && first[1] > 0.0 && first[1] < 1e3,
          "alpha from 0 to 1, beta above 0 and below 1000");
    return ExtendedUnified{first[0], first[1]};
  }
  if (kind == 1) return radial_tangential(d);
  if (kind == 2) return fisheye(d);
  if (kind == 0) return NoDistortion{};
  check(d[0] > 0.0 && d[0] < std::numbers::pi, "w above 0 and below pi");
  return FieldOfView{d[0]};
}

/// Kalibr's camchain.yaml (ethz-asl/kalibr, wiki "Supported models" and "YAML formats").
void apply_kalibr(const YamlField& root, const std::string& name, const std::string& file,
                  Sensor& sensor) {
  const YamlField camera = need(root, name);
  auto& pinhole = std::get<Pinhole>(sensor.optics);
  std::vector<double> k;
  pinhole.distortion = kalibr_distortion(camera, k);
  const std::vector<YamlField> sides = items(need(camera, "resolution"));
  if (sides.size() != 2) reject(need(camera, "resolution"), "no pair", "width and height");
  pinhole.skew_px = 0.0;
  pinhole.intrinsics = {whole_number(sides[0], 1, kMaxImageSide),
                        whole_number(sides[1], 1, kMaxImageSide),
                        k[0],
                        k[1],
                        k[2],
                        k[3],
                        0.0};
  note_keys(camera,
            {"camera_model", "distortion_model", "distortion_coeffs", "intrinsics", "resolution",
             "rostopic", "cam_overlaps"},
            file + ": " + name, sensor);
}

/// Zeros of rectified images are none, so that stereo cameras accept them.
Distortion opencv_distortion(const std::vector<double>& coefficients) {
  const bool is_none = std::ranges::all_of(coefficients, [](double k) { return k == 0.0; });
  return is_none ? Distortion(NoDistortion{}) : Distortion(radial_tangential(coefficients));
}

/// The YAML of ROS' camera_calibration_parsers.
void apply_ros_camera(const YamlField& root, const std::string& file, Sensor& sensor) {
  static const std::vector<std::string> kModels = {"plumb_bob", "rational_polynomial",
                                                   "equidistant"};
  auto& pinhole = std::get<Pinhole>(sensor.optics);
  const std::vector<double> k = numbers_of(need(need(root, "camera_matrix"), "data"), {9});
  const std::size_t model = one_of(need(root, "distortion_model"), kModels);
  const YamlField list = need(need(root, "distortion_coefficients"), "data");
  pinhole.distortion = model == 2 ? Distortion(fisheye(numbers_of(list, {4})))
                                  : opencv_distortion(numbers_of(list, {4, 5, 8, 12, 14}));
  pinhole.skew_px = k[1];
  pinhole.intrinsics = {whole_number(need(root, "image_width"), 1, kMaxImageSide),
                        whole_number(need(root, "image_height"), 1, kMaxImageSide),
                        k[0],
                        k[4],
                        k[2],
                        k[5],
                        0.0};
  note_keys(root,
            {"image_width", "image_height", "camera_name", "camera_matrix", "distortion_model",
             "distortion_coefficients"},
            file, sensor);
}

/// Of a camera: camchain YAML of Kalibr, of which `name` selects a camera (empty: cam0), or camera
/// YAML of ROS.
void apply_camera_calibration(const fs::path& path, const std::string& name, Sensor& sensor) {
  const YamlField root = read_yaml(path);
  if (find(root, "camera_matrix")) return apply_ros_camera(root, path.string(), sensor);
  apply_kalibr(root, name.empty() ? "cam0" : name, path.string(), sensor);
}

/// "FILE#NAME": a camera of a file of several.
std::pair<fs::path, std::string> split_name(const fs::path& path) {
  const std::string text = path.string();
  const std::size_t at = text.rfind('#');
  if (at == std::string::npos || fs::exists(path)) return {path, ""};
  return {text.substr(0, at), text.substr(at + 1)};
}

}  // namespace

void apply_calibration(const fs::path& given, Sensor& sensor) {
  const auto [path, name] = split_name(given);
  const std::string text = read_text_file(path, kCalibrationFile);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (std::holds_alternative<Pinhole>(sensor.optics)) {
    apply_camera_calibration(path, name, sensor);
    check_depth_camera(sensor);
  } else if (!std::holds_alternative<Spinning>(sensor.optics)) {
    throw Error(
        {path.string(),
         std::string("a calibration of a sensor with the optics ") + type_info(sensor.optics).name,
         "a camera or a spinning LiDAR", "leave it out"});
  } else if (first != std::string::npos && text[first] == '{') {
    apply_ouster(text, path, sensor);
  } else if (text.find("lasers:") != std::string::npos) {
    apply_velodyne(path, sensor);
  } else {
    apply_hesai(text, path, sensor);
  }
  const std::string file = path.string();
  if (std::ranges::find(sensor.files, file) == sensor.files.end()) sensor.files.push_back(file);
}

}  // namespace glidar
