// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// One datagram of a sensor.
struct UdpPacket {
  std::int64_t stamp_ns = 0;  ///< when it is sent or was captured, since 1970
  std::uint16_t source_port = 0;
  std::uint16_t port = 0;  ///< of the receiver
  std::vector<std::byte> payload;
};

/// Converts the frames of a sensor to its manufacturer's packets. Packets do not align with frames:
/// the firings of an incomplete packet wait for the next frame.
class PacketEncoder {
 public:
  PacketEncoder() = default;
  PacketEncoder(const PacketEncoder&) = delete;
  PacketEncoder& operator=(const PacketEncoder&) = delete;
  virtual ~PacketEncoder() = default;

  /// Appends the packets that this frame completes. `beams` are those that it was measured with.
  /// Throws Error when they do not fit the sensor that the encoder was made for.
  virtual void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) = 0;
  /// Appends the last packet, filled with firings without returns.
  virtual void finish(std::vector<UdpPacket>& packets) = 0;
};

/// What packets contain: a frame without ground truth, and its beams.
struct DecodedFrame {
  Beams beams;
  Frame frame;
};

/// Converts packets to frames, one per revolution.
class PacketDecoder {
 public:
  PacketDecoder() = default;
  PacketDecoder(const PacketDecoder&) = delete;
  PacketDecoder& operator=(const PacketDecoder&) = delete;
  virtual ~PacketDecoder() = default;

  /// Appends the revolutions that this packet completes; ignores packets of other ports. Throws
  /// Error for a malformed packet, which then has no effect.
  virtual void decode(const UdpPacket& packet, std::vector<DecodedFrame>& frames) = 0;
  /// Appends the last revolution, as far as it was received.
  virtual void finish(std::vector<DecodedFrame>& frames) = 0;
};

}  // namespace glidar
