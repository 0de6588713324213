// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/ouster_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace glidar {
namespace {

const TextFileKind kMetadata = {"a JSON file of an Ouster sensor", 1, ""};
constexpr std::uint32_t kMaxRows = 4096;
constexpr std::uint32_t kMaxOusterColumns = 65536;
constexpr std::uint32_t kMaxRate_hz = 1000;

[[noreturn]] void fail(const std::string& where, std::string found, std::string allowed) {
  throw Error({where, std::move(found), std::move(allowed), "use the sensor's own metadata JSON"});
}

nlohmann::json parse(const std::string& text, const std::string& file) {
  try {
    nlohmann::json all = parse_json<nlohmann::json>(file, text);
    if (all.is_object()) return all;
  } catch (const nlohmann::json::exception&) {  // as below
  }
  fail(file, "no JSON object", "Ouster metadata");
}

const nlohmann::json& need(const nlohmann::json& all, const char* key, const std::string& where) {
  if (const nlohmann::json* value = find_ouster_value(all, key)) return *value;
  fail(where, std::string("the key ") + key + " is missing", "");
}

double finite(const nlohmann::json& value, const std::string& where) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (std::isfinite(number)) return number;
  fail(where, shown_json(value), "a number");
}

std::vector<double> angles(const nlohmann::json& all, const char* key, const std::string& file) {
  const std::string where = file + ": " + key;
  const nlohmann::json& list = need(all, key, file);
  if (!list.is_array() || list.empty() || list.size() > kMaxRows) {
    fail(where, "no list of angles", "1 to 4096 numbers");
  }
  std::vector<double> values;
  for (const nlohmann::json& value : list) values.push_back(finite(value, where));
  return values;
}

/// Columns of a turn and turns per second.
struct TurnMode {
  std::uint32_t columns = 0;
  double rate_hz = 0.0;
};

/// "1024x10".
TurnMode parse_mode(const nlohmann::json& value, const std::string& file) {
  const std::string mode = value.is_string() ? value.get<std::string>() : "";
  const std::size_t x = mode.find('x');
  std::uint32_t columns = 0;
  std::uint32_t rate_hz = 0;
  const char* end = mode.data() + mode.size();
  if (x != std::string::npos) {
    std::from_chars(mode.data(), mode.data() + x, columns);
    std::from_chars(mode.data() + x + 1, end, rate_hz);
  }
  if (columns < 1 || columns > kMaxOusterColumns || rate_hz < 1 || rate_hz > kMaxRate_hz) {
    fail(file + ": lidar_mode", "'" + excerpt(mode) + "'", "COLUMNSxRATE such as 1024x10");
  }
  return {columns, static_cast<double>(rate_hz)};
}

std::optional<std::uint32_t> whole(const nlohmann::json& all, const char* key, std::uint32_t max,
                                   const std::string& file) {
  const nlohmann::json* value = find_ouster_value(all, key);
  if (value == nullptr) return std::nullopt;
  if (value->is_number_unsigned()) {
    const auto number = value->get<std::uint64_t>();
    if (number >= 1 && number <= max) return static_cast<std::uint32_t>(number);
  }
  fail(file + ": " + key, shown_json(*value), "a whole number from 1 to " + std::to_string(max));
}

/// The mode, or of metadata without it the number of columns and frames per second.
TurnMode mode_of(const nlohmann::json& all, const std::string& file,
                 std::vector<std::string>& notes) {
  const std::optional<std::uint32_t> columns =
      whole(all, "columns_per_frame", kMaxOusterColumns, file);
  if (const nlohmann::json* value = find_ouster_value(all, "lidar_mode")) {
    const TurnMode mode = parse_mode(*value, file);
    if (columns && *columns != mode.columns)
      notes.push_back(file + ": columns_per_frame, " + std::to_string(*columns) +
                      ", is not used: lidar_mode states " + std::to_string(mode.columns));
    return mode;
  }
  if (!columns) fail(file, "the key lidar_mode is missing", "");
  const std::optional<std::uint32_t> rate_hz = whole(all, "fps", kMaxRate_hz, file);
  if (!rate_hz) notes.push_back(file + ": no lidar_mode and no fps: 10 turns per second");
  return {*columns, static_cast<double>(rate_hz.value_or(10))};
}

/// The columns that the sensor sends, [first, last], as a sector of the turn.
void apply_column_window(const nlohmann::json& all, const std::string& file, Spinning& s) {
  const nlohmann::json* window = find_ouster_value(all, "column_window");
  if (window == nullptr) return;
  const std::string where = file + ": column_window";
  if (!window->is_array() || window->size() != 2) fail(where, "no pair", "first and last column");
  const double columns = s.columns_per_turn;
  const double first = finite((*window)[0], where);
  const double last = finite((*window)[1], where);
  if (!(first >= 0.0 && first < columns && last >= 0.0 && last < columns)) {
    fail(where, "a column that the mode does not have", "columns from 0 to below those of a turn");
  }
  const double count = std::fmod(last - first + columns, columns) + 1.0;
  s.azimuth_width_rad = kTwoPi * count / columns;
  // half a column beyond the last one, so that rounding cannot lose a column at either end
  s.azimuth_start_rad = azimuth_at_start_rad(s) - kTwoPi * (first + count - 0.5) / columns;
}

using Matrix4 = std::array<double, 16>;  // row by row, with the translation in mm

std::optional<Matrix4> matrix(const nlohmann::json& all, const char* key, const std::string& file) {
  const nlohmann::json* value = find_ouster_value(all, key);
  if (value == nullptr) return std::nullopt;
  const std::string where = file + ": " + key;
  Matrix4 numbers{};
  if (!value->is_array() || value->size() != numbers.size())
    fail(where, "no list of 16 numbers", "a homogeneous matrix, row by row");
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = finite((*value)[i], where);
  return numbers;
}

/// Of metadata without it, ouster-sdk's default_lidar_origin_to_beam_origin(prod_line).
double default_origin_mm(const nlohmann::json& all) {
  const nlohmann::json* value = find_ouster_value(all, "prod_line");
  const std::string line = value != nullptr && value->is_string() ? value->get<std::string>() : "";
  if (line.starts_with("OS-0-")) return 27.67;
  if (line.starts_with("OS-1-")) return 15.806;
  if (line.starts_with("OS-2-")) return 13.762;
  return 12.163;  // the first generation
}

/// Where beams start (ouster-sdk, xyzlut.cpp): beam_to_lidar_transform, or the distance alone.
void apply_beam_origin(const nlohmann::json& all, const std::string& file, OusterMetadata& made) {
  Spinning& s = made.spinning;
  if (const auto lidar_from_beam = matrix(all, "beam_to_lidar_transform", file)) {
    s.beam_origin_m = (*lidar_from_beam)[3] * kMillimetre_m;
    s.beam_origin_height_m = (*lidar_from_beam)[11] * kMillimetre_m;
    return;
  }
  constexpr const char* kKey = "lidar_origin_to_beam_origin_mm";
  if (const nlohmann::json* value = find_ouster_value(all, kKey)) {
    s.beam_origin_m = finite(*value, file + ": " + kKey) * kMillimetre_m;
    return;
  }
  const double origin_mm = default_origin_mm(all);
  s.beam_origin_m = origin_mm * kMillimetre_m;
  made.notes.push_back(file + ": no " + kKey + ": " + number_text(origin_mm) +
                       " mm, the manufacturer's default for the product line");
}

/// theta_encoder = 2 pi (1 - m / W) in the lidar frame, which is the sensor's turned about z, by pi
/// unless the metadata state another angle.
void apply_start(const nlohmann::json& all, const std::string& file, Spinning& s) {
  constexpr double kLevel = 1e-9;
  s.start_azimuth_rad = std::numbers::pi;
  const auto sensor_from_lidar = matrix(all, "lidar_to_sensor_transform", file);
  if (!sensor_from_lidar) return;
  const Matrix4& m = *sensor_from_lidar;
  if (std::abs(m[10] - 1.0) > kLevel || std::abs(m[0] * m[0] + m[4] * m[4] - 1.0) > 2.0 * kLevel)
    fail(file + ": lidar_to_sensor_transform", "a rotation that is not about z",
         "a rotation about z");
  // in degrees, as sensor files state it
  if (m[0] != -1.0 || m[4] != 0.0) s.start_azimuth_rad = 360.0 * atan2_turns(m[4], m[0]) * kDegree;
}

/// Numbers that have no effect on beams.
void note_unused(const nlohmann::json& all, const std::string& file, OusterMetadata& made) {
  static const Matrix4 kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (const auto extrinsic = matrix(all, "extrinsic", file); extrinsic && *extrinsic != kIdentity)
    made.notes.push_back(file + ": extrinsic is not used: clouds are in the sensor's frame");
  const nlohmann::json* window = find_ouster_value(all, "azimuth_window");
  if (window == nullptr || find_ouster_value(all, "column_window") != nullptr) return;
  const bool is_whole = window->is_array() && window->size() == 2 && (*window)[0] == 0 &&
                        ((*window)[1] == 360000 || (*window)[1] == 36000);
  if (!is_whole) made.notes.push_back(file + ": azimuth_window is not used without column_window");
}

/// One channel per row. Packets of firmware 1 always have 64 rows, of which an OS1-16 uses 16: both
/// angles of the others are 0.
void apply_rows(const nlohmann::json& all, const std::string& file, OusterMetadata& made) {
  const std::vector<double> altitudes_deg = angles(all, "beam_altitude_angles", file);
  const std::vector<double> azimuths_deg = angles(all, "beam_azimuth_angles", file);
  made.slot_count = altitudes_deg.size();
  if (azimuths_deg.size() != made.slot_count) {
    fail(file, "altitude and azimuth angles of different number", "one of each per row");
  }
  const auto pixels = whole(all, "pixels_per_column", kMaxRows, file);
  if (pixels && *pixels != made.slot_count)
    fail(file + ": pixels_per_column", std::to_string(*pixels),
         std::to_string(made.slot_count) + ", the number of beam angles");
  const auto is_zero = [&](std::size_t row) {
    return altitudes_deg[row] == 0.0 && azimuths_deg[row] == 0.0;
  };
  std::size_t zeros = 0;
  for (std::size_t row = 0; row < made.slot_count; ++row) zeros += is_zero(row) ? 1 : 0;
  const bool are_unused = zeros > 1;  // two beams do not have one direction
  if (are_unused && zeros == made.slot_count)
    fail(file + ": beam_altitude_angles", "angles that are all 0", "the angles of the beams");
  for (std::size_t row = 0; row < made.slot_count; ++row) {
    if (are_unused && is_zero(row)) continue;
    SpinningChannel channel;
    channel.elevation_rad = altitudes_deg[row] * kDegree;
    channel.azimuth_offset_rad = -azimuths_deg[row] * kDegree;  // theta_azimuth = -angle
    channel.ring = static_cast<std::uint16_t>(made.slots.size());
    made.slots.push_back(row);
    made.spinning.channels.push_back(channel);
  }
  if (are_unused)
    made.notes.push_back(file + ": " + std::to_string(zeros) + " of " +
                         std::to_string(made.slot_count) +
                         " rows have no beam: both of their angles are 0");
}

}  // namespace

const nlohmann::json* find_ouster_value(const nlohmann::json& all, const char* key) {
  if (const auto at = all.find(key); at != all.end()) return &*at;
  for (const char* section :
       {"beam_intrinsics", "lidar_data_format", "data_format", "lidar_intrinsics", "config_params",
        "config_txt", "sensor_info", "ouster-sdk"}) {
    const auto inner = all.find(section);
    if (inner == all.end() || !inner->is_object()) continue;
    if (const auto at = inner->find(key); at != inner->end()) return &*at;
  }
  return nullptr;
}

OusterMetadata load_ouster_metadata(const std::filesystem::path& path) {
  return parse_ouster_metadata(read_text_file(path, kMetadata), path.string());
}

OusterMetadata parse_ouster_metadata(const std::string& text, const std::string& file) {
  const nlohmann::json all = parse(text, file);
  OusterMetadata made;
  apply_rows(all, file, made);
  const TurnMode mode = mode_of(all, file, made.notes);
  made.spinning.columns_per_turn = mode.columns;
  made.spinning.rotation_hz = mode.rate_hz;
  apply_start(all, file, made.spinning);
  apply_beam_origin(all, file, made);
  apply_column_window(all, file, made.spinning);
  note_unused(all, file, made);
  return made;
}

}  // namespace glidar
