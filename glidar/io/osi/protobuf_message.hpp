// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace glidar {

/// The bytes of a message of Protocol Buffers, field by field (protobuf.dev, "Encoding"). Fields
/// are written even if they have the default value, as proto2 distinguishes both.
class ProtobufMessage {
 public:
  /// int64, uint32, uint64 and enum.
  ProtobufMessage& integer(std::uint32_t field, std::int64_t value);
  ProtobufMessage& integer(std::uint32_t field, std::uint64_t value);
  ProtobufMessage& real(std::uint32_t field, double value);
  /// Bytes that are not UTF-8, which the format does not allow, become '?'.
  ProtobufMessage& text(std::uint32_t field, std::string_view value);
  ProtobufMessage& message(std::uint32_t field, const ProtobufMessage& value);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value);
  ProtobufMessage& bytes(std::uint32_t field, std::string_view value);

  std::string bytes_;
};

}  // namespace glidar
