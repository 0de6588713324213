// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/ouster_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/config/ray_file.hpp>
#include <glidar/io/files/text_file.hpp>
#include <glidar/math/constants.hpp>

#include <charconv>
#include <cmath>

namespace glidar {
namespace {

const TextFileKind kMetadata = {"a JSON file of an Ouster sensor", 1, ""};
constexpr std::size_t kMaxRows = 4096;
constexpr std::uint32_t kMaxOusterColumns = 65536;

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

/// The value of a key, at the top (old layout) or in the part where new firmware puts it.
const nlohmann::json* find(const nlohmann::json& all, const char* part, const char* key) {
  if (const auto at = all.find(key); at != all.end()) return &*at;
  const auto inner = all.find(part);
  if (inner == all.end() || !inner->is_object()) return nullptr;
  const auto at = inner->find(key);
  return at == inner->end() ? nullptr : &*at;
}

const nlohmann::json& need(const nlohmann::json& all, const char* part, const char* key,
                           const std::string& where) {
  if (const nlohmann::json* value = find(all, part, key)) return *value;
  fail(where, std::string("the key ") + key + " is missing", "");
}

double finite(const nlohmann::json& value, const std::string& where) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (std::isfinite(number)) return number;
  fail(where, shown_json(value), "a number");
}

std::vector<double> angles(const nlohmann::json& all, const char* key, const std::string& file) {
  const std::string where = file + ": " + key;
  const nlohmann::json& list = need(all, "beam_intrinsics", key, file);
  if (!list.is_array() || list.empty() || list.size() > kMaxRows) {
    fail(where, "no list of angles", "1 to 4096 numbers");
  }
  std::vector<double> values;
  for (const nlohmann::json& value : list) values.push_back(finite(value, where));
  return values;
}

/// "1024x10": columns of a turn and turns per second.
std::pair<std::uint32_t, double> mode_of(const nlohmann::json& all, const std::string& file) {
  const nlohmann::json& value = need(all, "config_params", "lidar_mode", file);
  const std::string mode = value.is_string() ? value.get<std::string>() : "";
  const std::size_t x = mode.find('x');
  std::uint32_t columns = 0;
  std::uint32_t rate_hz = 0;
  const char* end = mode.data() + mode.size();
  if (x != std::string::npos) {
    std::from_chars(mode.data(), mode.data() + x, columns);
    std::from_chars(mode.data() + x + 1, end, rate_hz);
  }
  if (columns < 1 || columns > kMaxOusterColumns || rate_hz < 1 || rate_hz > 1000) {
    fail(file + ": lidar_mode", "'" + excerpt(mode) + "'", "COLUMNSxRATE such as 1024x10");
  }
  return {columns, rate_hz};
}

/// The columns that the sensor sends, [first, last], as a sector of the turn.
void apply_column_window(const nlohmann::json& all, const std::string& file, Spinning& s) {
  const nlohmann::json* window = find(all, "data_format", "column_window");
  if (window == nullptr) window = find(all, "lidar_data_format", "column_window");
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

}  // namespace

Spinning load_ouster_metadata(const std::filesystem::path& path) {
  return parse_ouster_metadata(read_text_file(path, kMetadata), path.string());
}

Spinning parse_ouster_metadata(const std::string& text, const std::string& file) {
  const nlohmann::json all = parse(text, file);
  const std::vector<double> altitudes_deg = angles(all, "beam_altitude_angles", file);
  const std::vector<double> azimuths_deg = angles(all, "beam_azimuth_angles", file);
  if (altitudes_deg.size() != azimuths_deg.size()) {
    fail(file, "altitude and azimuth angles of different number", "one of each per row");
  }
  Spinning s;
  std::tie(s.columns_per_turn, s.rotation_hz) = mode_of(all, file);
  // theta_encoder = 2 pi (1 - m / W) in the lidar frame, which is the sensor's turned by pi
  s.start_azimuth_rad = std::numbers::pi;
  const nlohmann::json& origin =
      need(all, "beam_intrinsics", "lidar_origin_to_beam_origin_mm", file);
  s.beam_origin_m = finite(origin, file + ": lidar_origin_to_beam_origin_mm") * 1e-3;
  for (std::size_t row = 0; row < altitudes_deg.size(); ++row) {
    SpinningChannel channel;
    channel.elevation_rad = altitudes_deg[row] * kDegree;
    channel.azimuth_offset_rad = -azimuths_deg[row] * kDegree;  // theta_azimuth = -angle
    channel.ring = static_cast<std::uint16_t>(row);
    s.channels.push_back(channel);
  }
  apply_column_window(all, file, s);
  return s;
}

}  // namespace glidar
