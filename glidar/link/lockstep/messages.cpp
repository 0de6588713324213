// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep/messages.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace glidar::lockstep {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

constexpr std::array<char, 4> kMagic = {'G', 'L', 'D', 'R'};
constexpr std::uint16_t kDescribe = 0;
constexpr std::uint16_t kMeasure = 1;
constexpr std::uint16_t kClouds = 2;
constexpr std::uint32_t kHitsOnly = 1;
constexpr std::size_t kStart_bytes = 16;         // magic, version, kind, id
constexpr std::size_t kMeasureStart_bytes = 40;  // and counts
constexpr std::size_t kBody_bytes = 13 * sizeof(double);
constexpr std::size_t kMomentStart_bytes = 24;
constexpr std::size_t kFrameId_bytes = 32;
constexpr double kQuaternionTolerance = 1e-3;
constexpr double kMaxRate = 1e9;  // rad/s and m/s

[[noreturn]] void refuse(std::string where, std::string found, std::string allowed) {
  throw Error({"request, " + std::move(where), std::move(found), std::move(allowed)});
}

/// Reads numbers from bytes whose size was checked.
class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}

  template <class Number>
  Number read() {
    Number number{};
    std::memcpy(&number, rest_.data(), sizeof(Number));
    rest_ = rest_.subspan(sizeof(Number));
    return number;
  }
  Eigen::Vector3d read_vector() {
    const auto x = read<double>();
    const auto y = read<double>();
    const auto z = read<double>();
    return {x, y, z};
  }
  std::string read_text(std::size_t size) {
    std::string text(size, '\0');
    std::memcpy(text.data(), rest_.data(), size);
    rest_ = rest_.subspan(size);
    return text;
  }

 private:
  Bytes rest_;
};

class Writer {
 public:
  template <class Number>
  void write(Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    const auto* start = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), start, start + sizeof(Number));
  }
  void write_vector(const Eigen::Vector3d& v) {
    for (const double x : {v.x(), v.y(), v.z()}) write(x);
  }
  /// Truncated to the size or padded with zeros.
  void write_text(std::string_view text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) write(i < text.size() ? text[i] : '\0');
  }
  void write_start(std::uint16_t kind, std::uint64_t id) {
    for (const char letter : kMagic) write(letter);
    write(kVersion);
    write(kind);
    write(id);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Returns the kind of the message after a check of its version.
std::uint16_t read_start(Bytes message, std::uint64_t& id) {
  if (message.size() < kStart_bytes) {
    refuse("size", std::to_string(message.size()) + " bytes", "at least 16");
  }
  Reader from(message);
  for (const char letter : kMagic) {
    if (from.read<char>() != letter) refuse("first bytes", "other bytes", "'GLDR'");
  }
  const auto version = from.read<std::uint16_t>();
  const auto kind = from.read<std::uint16_t>();
  id = from.read<std::uint64_t>();
  if (version != kVersion) {
    refuse("version", std::to_string(version), std::to_string(kVersion));
  }
  return kind;
}

struct Counts {
  std::uint32_t sensor = 0;
  std::uint32_t flags = 0;
  std::uint32_t columns = 0;
  std::uint32_t moments = 0;
  std::uint32_t objects = 0;
  std::uint32_t reserved = 0;
};

void check_count(const char* what, std::uint32_t found, std::uint32_t min, std::uint32_t max) {
  if (found >= min && found <= max) return;
  refuse(what, std::to_string(found), std::to_string(min) + " to " + std::to_string(max));
}

void check(const Counts& counts, std::size_t size) {
  check_count("number of columns", counts.columns, 1, kMaxColumns);
  check_count("number of moments", counts.moments, 1, kMaxMoments);
  check_count("number of objects", counts.objects, 0, kMaxObjects);
  if ((counts.flags & ~kHitsOnly) != 0) {
    refuse("flags", std::to_string(counts.flags), "0, or 1 for hits only");
  }
  if (counts.reserved != 0) refuse("reserved", std::to_string(counts.reserved), "0");
  const std::size_t wanted =
      kMeasureStart_bytes + counts.columns * kNameBytes +
      std::size_t{counts.moments} *
          (kMomentStart_bytes + kBody_bytes * (1 + std::size_t{counts.objects}));
  if (size != wanted) {
    refuse("size", std::to_string(size) + " bytes",
           std::to_string(wanted) + " for its columns, moments and objects");
  }
}

std::string read_name(Reader& from) {
  std::string name = from.read_text(kNameBytes);
  name.resize(name.find_last_not_of('\0') + 1);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), is_letter)) return name;
  refuse("name of a column", "a name that is empty or has other characters", "a to z and _");
}

Body read_body(Reader& from, const std::string& where) {
  const Eigen::Vector3d position_m = from.read_vector();
  const auto w = from.read<double>();
  const Eigen::Vector3d xyz = from.read_vector();
  Body body{.rate_rad_s = from.read_vector(), .velocity_m_s = from.read_vector()};
  if (!is_within_reach(position_m)) {
    refuse(where + ", position", "a number that is not finite or too large", "metres up to 1e15");
  }
  const Eigen::Quaterniond attitude(w, xyz.x(), xyz.y(), xyz.z());
  if (!(std::abs(attitude.norm() - 1.0) <= kQuaternionTolerance)) {
    refuse(where + ", quaternion", "length " + number_text(attitude.norm()),
           "length 1 to within 0.001, in the order w x y z");
  }
  for (const auto& [name, value] :
       {std::pair{"rate", body.rate_rad_s}, std::pair{"velocity", body.velocity_m_s}}) {
    if (value.allFinite() && value.cwiseAbs().maxCoeff() <= kMaxRate) continue;
    refuse(where + ", " + name, "a number that is not finite or too large", "up to 1e9");
  }
  body.world_from_body = make_pose(position_m, attitude);
  return body;
}

Moment read_moment(Reader& from, std::uint32_t index, std::uint32_t objects) {
  const std::string where = "moment " + std::to_string(index);
  Moment moment;
  constexpr std::int64_t kMaxTime_ns =
      9'000'000'000'000'000'000;  // leaves room for the firing times
  moment.t_ns = from.read<std::int64_t>();
  if (moment.t_ns > kMaxTime_ns || moment.t_ns < -kMaxTime_ns) {
    refuse(where + ", time", std::to_string(moment.t_ns) + " ns", "from -9e18 to 9e18");
  }
  moment.seed = from.read<std::uint64_t>();
  moment.number = from.read<std::uint32_t>();
  if (from.read<std::uint32_t>() != 0) refuse(where + ", reserved", "another number", "0");
  moment.sensor = read_body(from, where + ", sensor");
  moment.objects.reserve(objects);
  for (std::uint32_t k = 0; k < objects; ++k) {
    moment.objects.push_back(read_body(from, where + ", object " + std::to_string(k)));
  }
  return moment;
}

void write_body(const Body& body, Writer& to) {
  const PoseVector numbers = to_xyz_wxyz(body.world_from_body);
  for (const double number : numbers) to.write(number);
  to.write_vector(body.rate_rad_s);
  to.write_vector(body.velocity_m_s);
}

std::string_view type_of(const Column& column) {
  constexpr std::array<std::string_view, 6> kTypes = {"f4", "f8", "u1", "u2", "u4", "i8"};
  static_assert(std::variant_size_v<decltype(Column::values)> == kTypes.size());
  return kTypes.at(column.values.index());
}

std::vector<std::byte> encode_one(const Describe& describe) {
  Writer to;
  to.write_start(kDescribe, describe.id);
  return to.take();
}

std::vector<std::byte> encode_one(const Measure& measure) {
  Writer to;
  to.write_start(kMeasure, measure.id);
  to.write(measure.sensor);
  to.write(measure.drop_invalid ? kHitsOnly : 0U);
  to.write(static_cast<std::uint32_t>(measure.columns.size()));
  to.write(static_cast<std::uint32_t>(measure.moments.size()));
  to.write(
      static_cast<std::uint32_t>(measure.moments.empty() ? 0 : measure.moments[0].objects.size()));
  to.write(std::uint32_t{0});
  for (const std::string& name : measure.columns) to.write_text(name, kNameBytes);
  for (const Moment& moment : measure.moments) {
    to.write(moment.t_ns);
    to.write(moment.seed);
    to.write(moment.number);
    to.write(std::uint32_t{0});
    write_body(moment.sensor, to);
    for (const Body& body : moment.objects) write_body(body, to);
  }
  return to.take();
}

}  // namespace

Request decode_request(Bytes message, std::uint64_t& id) {
  const std::uint16_t kind = read_start(message, id);
  if (kind == kDescribe) {
    if (message.size() != kStart_bytes) {
      refuse("size", std::to_string(message.size()) + " bytes", "16 for a description");
    }
    return Describe{id};
  }
  if (kind != kMeasure) {
    refuse("kind", std::to_string(kind), "0 for a description, 1 for a measurement");
  }
  if (message.size() < kMeasureStart_bytes) {
    refuse("size", std::to_string(message.size()) + " bytes", "at least 40 for a measurement");
  }
  Reader from(message.subspan(kStart_bytes));
  Counts counts;
  for (std::uint32_t* count : {&counts.sensor, &counts.flags, &counts.columns, &counts.moments,
                               &counts.objects, &counts.reserved}) {
    *count = from.read<std::uint32_t>();
  }
  check(counts, message.size());
  Measure measure{.id = id,
                  .sensor = counts.sensor,
                  .drop_invalid = (counts.flags & kHitsOnly) != 0,
                  .columns = {},
                  .moments = {}};
  for (std::uint32_t i = 0; i < counts.columns; ++i) measure.columns.push_back(read_name(from));
  measure.moments.reserve(counts.moments);
  for (std::uint32_t i = 0; i < counts.moments; ++i) {
    measure.moments.push_back(read_moment(from, i, counts.objects));
  }
  return measure;
}

std::vector<std::byte> encode(const Request& request) {
  return std::visit([](const auto& kind) { return encode_one(kind); }, request);
}

std::vector<std::byte> encode_head(std::uint64_t id, std::span<const CloudHead> heads,
                                   const PointCloud& like) {
  Writer to;
  to.write_start(kClouds, id);
  to.write(static_cast<std::uint32_t>(heads.size()));
  to.write(static_cast<std::uint32_t>(like.columns.size()));
  for (const Column& column : like.columns) {
    to.write_text(column.name, kNameBytes);
    to.write_text(type_of(column), 2);
    to.write(static_cast<std::uint16_t>(column.components.size()));
    to.write(std::uint32_t{0});
  }
  for (const CloudHead& head : heads) {
    to.write(head.stamp_ns);
    to.write(head.seed);
    to.write(head.number);
    to.write(head.rows);
    to.write(head.cols);
    to.write(std::uint32_t{0});
    to.write_text(head.frame_id, kFrameId_bytes);
    for (const double number : to_xyz_wxyz(head.world_from_cloud)) to.write(number);
  }
  return to.take();
}

Bytes bytes_of(const Column& column) {
  return std::visit([](const auto& values) { return std::as_bytes(std::span(values)); },
                    column.values);
}

std::vector<std::byte> encode_text_head(std::uint64_t id, TextKind kind) {
  Writer to;
  to.write_start(static_cast<std::uint16_t>(kind), id);
  return to.take();
}

}  // namespace glidar::lockstep
