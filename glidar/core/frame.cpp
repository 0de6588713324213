// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/frame.hpp>

#include <limits>

namespace glidar {

std::string_view name(Status status) {
  switch (status) {
    case Status::hit:
      return "hit";
    case Status::miss:
      return "miss";
    case Status::too_near:
      return "too near";
    case Status::too_far:
      return "too far";
    case Status::no_beam:
      return "no beam";
    case Status::below_threshold:
      return "below threshold";
    case Status::dropped:
      return "dropped";
    case Status::occluded:
      return "occluded";
    case Status::wrapped:
      return "wrapped";
    case Status::saturated:
      return "saturated";
    case Status::weather:
      return "weather";
    case Status::no_echo:
      return "no echo";
  }
  return "unknown";
}

std::string_view name(Cause cause) {
  switch (cause) {
    case Cause::none:
      return "none";
    case Cause::surface:
      return "surface";
    case Cause::mixed:
      return "mixed";
    case Cause::ghost:
      return "ghost";
    case Cause::false_alarm:
      return "false alarm";
    case Cause::fog:
      return "fog";
    case Cause::rain:
      return "rain";
    case Cause::snow:
      return "snow";
    case Cause::crosstalk:
      return "crosstalk";
  }
  return "unknown";
}

void lose(Frame& frame, std::size_t entry, Status why) {
  frame.status[entry] = why;
  frame.range_m[entry] = std::numeric_limits<double>::quiet_NaN();
  frame.intensity[entry] = 0.0F;
  if (!frame.cause.empty()) frame.cause[entry] = Cause::none;
}

Draw draw_of(const Frame& frame, Purpose purpose, std::size_t beam) {
  return {.seed = frame.seed,
          .sensor = frame.sensor_id,
          .frame = frame.number,
          .beam = static_cast<std::uint32_t>(beam),
          .purpose = purpose};
}

void resize(Frame& frame, std::size_t size) {
  frame.range_m.resize(size);
  frame.intensity.resize(size);
  frame.status.resize(size);
}

}  // namespace glidar
