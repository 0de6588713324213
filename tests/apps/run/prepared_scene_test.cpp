// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/prepared_scene.hpp>

#include <gmock/gmock.h>

#include <utility>

namespace glidar::app {
namespace {

using Frames = std::vector<std::pair<std::size_t, std::uint32_t>>;

Frames all_frames(const std::vector<ActiveSensor>& sensors) {
  FrameOrder order(sensors);
  Frames frames;
  while (const auto next = order.next()) frames.emplace_back(next->sensor_index, next->number);
  return frames;
}

ActiveSensor sensor_at(double rate_hz, std::uint32_t frames) {
  ActiveSensor active{.sensor = {}, .frames = frames};
  active.sensor.rate_hz = rate_hz;
  return active;
}

TEST(FrameOrder, IsThatOfTheStartOfFrames) {
  EXPECT_EQ(all_frames({sensor_at(10.0, 2), sensor_at(25.0, 5)}),
            (Frames{{0, 0}, {1, 0}, {1, 1}, {1, 2}, {0, 1}, {1, 3}, {1, 4}}));
}

TEST(FrameOrder, HasTheSensorsInTurnWhenTheirFramesStartTogether) {
  EXPECT_EQ(all_frames({sensor_at(10.0, 2), sensor_at(10.0, 2)}),
            (Frames{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
}

TEST(FrameOrder, EndsWithoutSensors) {
  EXPECT_TRUE(all_frames({}).empty());
}

}  // namespace
}  // namespace glidar::app
