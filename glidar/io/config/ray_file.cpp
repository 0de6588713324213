// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/ray_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/npy_head.hpp>
#include <glidar/math/constants.hpp>

#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace glidar {
namespace {

namespace fs = std::filesystem;

const TextFileKind kTable = {"a CSV table of beams", 64, ""};  // some million shots
const TextFileKind kRays = {"an NPY array of rays", 512, ""};
constexpr double kMaxTime_s = 100.0 * 24.0 * 3600.0;  // a double holds each nanosecond

[[noreturn]] void fail(const std::string& where, std::string found, std::string allowed,
                       std::string remedy = "") {
  throw Error({where, std::move(found), std::move(allowed), std::move(remedy)});
}

/// Three finite numbers with commas between; nothing when the line has other things.
std::optional<Eigen::Vector3d> three_numbers(std::string_view line) {
  Eigen::Vector3d values;
  const char* at = line.data();
  const char* end = line.data() + line.size();
  for (int i = 0; i < 3; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [stop, problem] = std::from_chars(at, end, values[i]);
    if (problem != std::errc{} || !std::isfinite(values[i])) return std::nullopt;
    at = stop;
    if (i < 2 && (at == end || *at++ != ',')) return std::nullopt;
  }
  return at == end ? std::optional(values) : std::nullopt;
}

/// Calls visit(line without its end, number from 1) for every line that is not empty.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
    if (!line.empty()) visit(line, number);
  }
}

/// rows, cols and numbers per ray from a shape.
std::array<std::size_t, 3> ray_shape(const std::string& where, const NpyHead& head) {
  const std::vector<std::size_t>& s = head.shape;
  const bool flat = s.size() == 2;
  const std::array<std::size_t, 3> shape =
      flat ? std::array{std::size_t{1}, s[0], s[1]}
           : (s.size() == 3 ? std::array{s[0], s[1], s[2]} : std::array<std::size_t, 3>{});
  const bool width_fits = shape[2] == 3 || shape[2] == 6;
  if (!width_fits || shape[0] < 1 || shape[1] < 1) {
    fail(where, "an array of another shape",
         "N x 3 (directions), N x 6 (origins, directions), or rows x cols x 3 or 6");
  }
  return shape;
}

Eigen::Vector3d vector_at(const char* data, const NpyHead& head) {
  return {head.number_at(data), head.number_at(data + head.number_bytes),
          head.number_at(data + 2 * head.number_bytes)};
}

}  // namespace

RayTable load_scan_csv(const fs::path& path) {
  const std::string text = read_text_file(path, kTable);
  RayTable table;
  each_line(text, [&](std::string_view line, std::size_t number) {
    const std::optional<Eigen::Vector3d> values = three_numbers(line);
    if (!values) {
      if (number == 1) return;  // the heading
      fail(path.string() + ":" + std::to_string(number), "no three numbers",
           "Time/s,Azimuth/deg,Zenith/deg");
    }
    if (std::abs(values->x()) > kMaxTime_s) {
      fail(path.string() + ":" + std::to_string(number),
           "a time of " + number_text(values->x()) + " s", "times within 100 days of zero",
           "give times in seconds");
    }
    table.times_ns.push_back(values->x() * kSecond_ns);
    table.directions.push_back(direction_at(values->y() * kDegree, (90.0 - values->z()) * kDegree));
  });
  const std::size_t size = table.directions.size();
  if (size < 2) fail(path.string(), "fewer than two shots", "Time/s,Azimuth/deg,Zenith/deg");
  const double first_ns = table.times_ns.front();
  for (double& time_ns : table.times_ns) time_ns -= first_ns;
  for (std::size_t i = 1; i < size; ++i) {
    if (table.times_ns[i] >= table.times_ns[i - 1]) continue;
    fail(path.string(), "the times fall at shot " + std::to_string(i + 1), "times that rise",
         "give 'point_us', the time from shot to shot, to ignore the file's");
  }
  table.rows = 1;
  table.cols = static_cast<std::uint32_t>(size);
  const double last_ns = table.times_ns.back();
  table.period_ns = last_ns + last_ns / static_cast<double>(size - 1);
  if (table.period_ns > kMaxTime_s * kSecond_ns)
    fail(path.string(), "shots over more than 100 days", "100 days in all");
  return table;
}

RayTable load_ray_npy(const fs::path& path) {
  const std::string bytes = read_input_file(path, kRays);
  const NpyHead head = read_npy_head(path.string(), bytes);
  const auto [rows, cols, width] = ray_shape(path.string(), head);
  require_npy_numbers(path.string(), head, bytes);
  RayTable table;
  table.rows = static_cast<std::uint32_t>(rows);
  table.cols = static_cast<std::uint32_t>(cols);
  const char* at = bytes.data() + head.data_at;
  for (std::size_t i = 0; i < rows * cols; ++i, at += width * head.number_bytes) {
    const bool with_origin = width == 6;
    const char* direction = with_origin ? at + 3 * head.number_bytes : at;
    table.directions.push_back(vector_at(direction, head));
    if (with_origin) table.origins_m.push_back(vector_at(at, head));
  }
  return table;
}

}  // namespace glidar
