// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace glidar::ros {

/// The large uint8[] of a message. Either its bytes, or a function that writes them into the
/// serialized message, so that a cloud is copied only once.
class Payload {
 public:
  using Writer = std::function<void(std::span<std::byte>)>;

  Payload() = default;
  explicit Payload(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  /// `write` fills exactly `size` bytes; it may be called several times.
  Payload(std::size_t size, Writer write) : size_(size), write_(std::move(write)) {}

  [[nodiscard]] std::size_t size() const { return write_ ? size_ : bytes_.size(); }
  /// The bytes that it holds; empty when a function writes them.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  /// Writes size() bytes.
  void write_to(std::span<std::byte> to) const;
  /// A copy of the bytes.
  [[nodiscard]] std::vector<std::byte> to_vector() const;

 private:
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;
  Writer write_;
};

}  // namespace glidar::ros
