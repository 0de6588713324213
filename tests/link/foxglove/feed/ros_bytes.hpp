// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/link/payload.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace glidar::testing {

/// Writes ROS 2 messages as little-endian CDR, for the feed of the live view: an encapsulation
/// header of 4 bytes, then values aligned to their size.
class CdrWriter {
 public:
  template <class Number>
  CdrWriter& put(Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    while ((bytes_.size() - kHead) % sizeof(Number) != 0) bytes_ += '\0';
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return *this;
  }
  CdrWriter& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value).append(1, '\0');
    return *this;
  }
  CdrWriter& sequence(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
    return *this;
  }
  CdrWriter& header(std::uint64_t time_ns, std::string_view frame) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    put(static_cast<std::int32_t>(time_ns / kSecond));
    put(static_cast<std::uint32_t>(time_ns % kSecond));
    return text(frame);
  }
  CdrWriter& pose(const Pose& pose) {
    const Eigen::Quaterniond q(pose.linear());
    for (int i = 0; i < 3; ++i) put(pose.translation()[i]);
    return put(q.x()).put(q.y()).put(q.z()).put(q.w());
  }
  [[nodiscard]] link::Payload payload() const {
    link::Payload payload{.memory = std::make_shared<std::byte[]>(bytes_.size()),  // NOLINT
                          .size = bytes_.size()};
    std::memcpy(payload.memory.get(), bytes_.data(), bytes_.size());
    return payload;
  }

 private:
  static constexpr std::size_t kHead = 4;
  std::string bytes_ = std::string("\0\1\0\0", kHead);
};

/// A transform of /tf.
inline link::Payload tf_message(std::uint64_t time_ns, std::string_view parent,
                                std::string_view child, const Pose& parent_from_child) {
  CdrWriter writer;
  writer.put(std::uint32_t{1}).header(time_ns, parent).text(child).pose(parent_from_child);
  return writer.payload();
}

/// A field of PointCloud2: name, offset, type.
struct CloudField {
  std::string_view name;
  std::uint32_t offset;
  std::uint8_t type;  ///< a constant of sensor_msgs/msg/PointField
};

/// An unorganised cloud of points that are already bytes.
inline link::Payload cloud_message(std::uint64_t time_ns, std::string_view frame,
                                   std::span<const CloudField> fields, std::uint32_t step,
                                   std::string_view points) {
  CdrWriter writer;
  const auto count = static_cast<std::uint32_t>(points.size() / step);
  writer.header(time_ns, frame).put(std::uint32_t{1}).put(count);
  writer.put(static_cast<std::uint32_t>(fields.size()));
  for (const CloudField& field : fields) {
    writer.text(field.name).put(field.offset).put(field.type).put(std::uint32_t{1});
  }
  writer.put(std::uint8_t{0}).put(step).put(step * count).sequence(points).put(std::uint8_t{1});
  return writer.payload();
}

}  // namespace glidar::testing
