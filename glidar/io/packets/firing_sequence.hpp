// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the firings of a spinning sensor between frames and packets.

#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// One return as packets have it.
struct PacketReturn {
  /// As reported, see Beams::range_offset_m and SpinningChannel::distance_correction_m; 0: none.
  double range_m = 0.0;
  float intensity = 0.0F;
  std::uint8_t reflectivity = 0;  ///< 0 to 100 % diffuse, above: retro-reflective
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
  /// `follow_rotation`: the head turns on between the sequence's start and a laser's firing.
  explicit RevolutionAssembler(const Sensor& sensor, bool follow_rotation = true);

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
  std::size_t max_sequences_;
  std::uint32_t number_ = 0;
  std::vector<FiringSequence> sequences_;
};

}  // namespace glidar
