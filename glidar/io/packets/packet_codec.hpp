// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

/// One return as packets have it.
struct PacketReturn {
  /// As reported, see Beams::range_offset_m and SpinningChannel::distance_correction_m; 0: none.
  double range_m = 0.0;
  float intensity = 0.0F;
  std::uint8_t reflectivity = 0;  ///< 0 to 100 % diffuse, above: retro-reflective
  std::array<float, 3> colour{};  ///< of the frame's ground truth; 0 without it
};

/// One firing sequence: all lasers once.
struct FiringSequence {
  std::int64_t stamp_ns = 0;  ///< of the time from which fire times count
  double azimuth_rad = 0.0;   ///< of the head at that time, from +x towards +y
  /// Returns x lasers; the lasers are in the order of Spinning::channels.
  std::vector<PacketReturn> returns;
};

/// The spinning optics of a sensor. Throws Error, naming the sensor, for other optics.
const Spinning& spinning_optics(const Sensor& sensor, const char* packets);

/// Rotation of the head, radians per nanosecond; negative for clockwise.
double turn_rate_rad_per_ns(const Spinning& spinning);

/// The firing sequences of a frame, in time order, with ranges in whole units within the limits.
/// Throws Error when frame or beams are not those of the sensor.
std::vector<FiringSequence> firing_sequences(const Sensor& sensor, const Frame& frame,
                                             const Beams& beams, double unit_m);

/// Collects firing sequences and joins those of a revolution to a frame.
class RevolutionAssembler {
 public:
  /// `follow_rotation`: the head turns on between the sequence's start and a laser's firing;
  /// `has_colour`: the frames have the column colour.
  explicit RevolutionAssembler(const Sensor& sensor, bool follow_rotation = true,
                               bool has_colour = false);

  /// Adds the next sequence in time; appends the revolution before it if it begins a new one.
  void add(FiringSequence sequence, std::vector<DecodedFrame>& frames);
  void finish(std::vector<DecodedFrame>& frames);

 private:
  void emit(std::vector<DecodedFrame>& frames);
  [[nodiscard]] double phase(double azimuth_rad) const;
  [[nodiscard]] double turn_rate(std::size_t at) const;
  void fill_column(std::size_t col, DecodedFrame& made) const;

  Sensor sensor_;
  Spinning spinning_;
  std::vector<std::size_t> laser_of_row_;
  bool follow_rotation_;
  HitColumnMask hit_columns_;
  std::size_t max_sequences_;
  std::uint32_t number_ = 0;
  std::vector<FiringSequence> sequences_;
};

/// Return mode of Velodyne's and Hesai's packets (VLP-16 User Manual 63-9243, 9.3.1.6).
enum class PacketReturnMode : std::uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };

/// The returns of a sensor.
struct ReturnSelection {
  PacketReturnMode mode = PacketReturnMode::strongest;
  std::size_t strongest = 0;  ///< index in Receiver::returns
  std::size_t last = 0;

  [[nodiscard]] bool is_dual() const { return mode == PacketReturnMode::dual; }
};

/// Throws Error, with the packets' name, unless the sensor reports the strongest, the last, or
/// both.
ReturnSelection select_packet_returns(const Sensor& sensor, const std::string& packets);

struct LastAndStrongest {
  PacketReturn last;
  PacketReturn strongest;
};

/// The two returns of a laser. The farther is the last; sensors repeat a single one in both places,
/// and give the second strongest if the last is the strongest (VLP-16 User Manual, 6.2.3).
LastAndStrongest last_and_strongest(const FiringSequence& sequence, std::size_t lasers,
                                    std::size_t laser);

/// The inverse: stores the two returns of a laser; a repeated one once.
void store_returns(const LastAndStrongest& found, const ReturnSelection& selection,
                   std::size_t lasers, std::size_t laser, FiringSequence& sequence);

}  // namespace glidar
