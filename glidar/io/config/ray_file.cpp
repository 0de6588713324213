// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/ray_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/text_file.hpp>
#include <glidar/math/constants.hpp>

#include <charconv>
#include <cmath>
#include <cstring>
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

/// The header of an .npy file (NumPy's format 1.0 and 2.0).
struct NpyHead {
  std::size_t data_at = 0;
  std::size_t number_bytes = 0;  // 4 or 8
  std::vector<std::size_t> shape;
};

/// The text after 'key': in the head's dictionary; empty when it is not there.
std::string_view value_of(std::string_view head, std::string_view key) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return {};
  const std::size_t colon = head.find(':', at);
  if (colon == std::string_view::npos) return {};
  std::string_view value = head.substr(colon + 1);
  while (value.starts_with(' ')) value.remove_prefix(1);
  return value;
}

std::vector<std::size_t> shape_of(std::string_view head) {
  std::vector<std::size_t> shape;
  std::string_view value = value_of(head, "'shape'");
  value = value.substr(0, value.find(')'));
  while (!value.empty() && shape.size() <= 3) {
    const char c = value.front();
    std::size_t number = 0;
    const auto [stop, problem] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (problem != std::errc{}) {
      if (c != '(' && c != ',' && c != ' ') return {};
      value.remove_prefix(1);
      continue;
    }
    shape.push_back(number);
    value.remove_prefix(static_cast<std::size_t>(stop - value.data()));
  }
  return shape;
}

NpyHead read_npy_head(const std::string& where, const std::string& bytes) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  constexpr std::size_t kShortHead = 10;
  constexpr std::size_t kLongHead = 12;
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(bytes[i])};
  };
  if (!bytes.starts_with(kMagic) || bytes.size() < kLongHead || byte(6) < 1 || byte(6) > 2) {
    fail(where, "no NumPy array", "an .npy file of format 1 or 2");
  }
  const bool is_long = byte(6) == 2;
  std::size_t length = byte(8) + (byte(9) << 8U);
  if (is_long) length += (byte(10) << 16U) + (byte(11) << 24U);
  NpyHead head;
  head.data_at = (is_long ? kLongHead : kShortHead) + length;
  if (head.data_at > bytes.size()) fail(where, "the file ends in its head", "a whole .npy file");
  const std::string_view text = std::string_view(bytes).substr(0, head.data_at);
  const std::string_view type = value_of(text, "'descr'");
  if (type.starts_with("'<f8'")) head.number_bytes = sizeof(double);
  if (type.starts_with("'<f4'")) head.number_bytes = sizeof(float);
  const bool by_rows = value_of(text, "'fortran_order'").starts_with("False");
  if (head.number_bytes == 0 || !by_rows) {
    fail(where, "numbers of another type or order", "float32 or float64, row by row",
         "numpy.save(file, numpy.ascontiguousarray(rays, dtype='<f8'))");
  }
  head.shape = shape_of(text);
  return head;
}

/// rows, cols and numbers per ray from a shape; checked against the bytes that are there.
std::array<std::size_t, 3> ray_shape(const std::string& where, const NpyHead& head,
                                     std::size_t bytes) {
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
  const std::size_t there = (bytes - head.data_at) / (head.number_bytes * shape[2]);
  if (shape[0] > there || shape[1] > there / shape[0]) {
    fail(where, "fewer numbers than its shape requires", "a whole .npy file");
  }
  return shape;
}

double number_at(const char* data, std::size_t bytes) {
  double value = 0.0;
  float small = 0.0F;
  if (bytes == sizeof(double)) std::memcpy(&value, data, bytes);
  if (bytes == sizeof(float)) std::memcpy(&small, data, bytes);
  return bytes == sizeof(float) ? double{small} : value;
}

Eigen::Vector3d vector_at(const char* data, std::size_t bytes) {
  return {number_at(data, bytes), number_at(data + bytes, bytes),
          number_at(data + 2 * bytes, bytes)};
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
  const auto [rows, cols, width] = ray_shape(path.string(), head, bytes.size());
  RayTable table;
  table.rows = static_cast<std::uint32_t>(rows);
  table.cols = static_cast<std::uint32_t>(cols);
  const char* at = bytes.data() + head.data_at;
  for (std::size_t i = 0; i < rows * cols; ++i, at += width * head.number_bytes) {
    const bool with_origin = width == 6;
    const char* direction = with_origin ? at + 3 * head.number_bytes : at;
    table.directions.push_back(vector_at(direction, head.number_bytes));
    if (with_origin) table.origins_m.push_back(vector_at(at, head.number_bytes));
  }
  return table;
}

}  // namespace glidar
