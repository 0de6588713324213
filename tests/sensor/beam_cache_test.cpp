// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

/// A scanner whose frames are no multiple of its firing period, so that each has beams of its own.
Sensor scanner() {
  Sensor sensor;
  sensor.rate_hz = 10.0;
  Spinning& spinning = sensor.optics.emplace<Spinning>();
  spinning.channels = {{.elevation_rad = 0.1}, {.elevation_rad = -0.1, .ring = 1}};
  spinning.firing_period_ns = 700'000.0;
  return sensor;
}

TEST(BeamCache, HasTheBeamsOfEveryFrame) {
  const Sensor sensor = scanner();
  const BeamCache cache(sensor);
  EXPECT_EQ(cache.beams()->directions, make_beams(sensor).directions);
  const Beams third = make_beams(sensor, frame_interval(sensor, 3));
  EXPECT_EQ(cache.beams(3)->directions, third.directions);
  EXPECT_NE(cache.beams(3)->directions, cache.beams()->directions);
}

TEST(BeamCache, SharesTheBeamsOfTheLatestFrameAndThoseInUse) {
  const BeamCache cache(scanner());
  const std::shared_ptr<const Beams> first = cache.beams(1);
  EXPECT_EQ(cache.beams(1), first);
  const Beams* const second = cache.beams(2).get();
  EXPECT_EQ(cache.beams(2).get(), second);
  EXPECT_EQ(cache.beams(1), first);
}

TEST(BeamCache, SharesOneSetOfBeamsAmongAllFramesOfACamera) {
  Sensor camera;
  camera.optics = pinhole_from_fov(4, 3, 0.5);
  const BeamCache cache(camera);
  EXPECT_EQ(cache.beams(17), cache.beams());
}

TEST(BeamCache, TakesTheBeamsOfFrame0WhereTheyAreKnown) {
  Beams first = make_beams(scanner());
  first.frame_id = "known";
  EXPECT_EQ(BeamCache(scanner(), first).beams()->frame_id, "known");
}

}  // namespace
}  // namespace glidar
