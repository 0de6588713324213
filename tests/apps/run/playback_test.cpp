// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/live_view.hpp>

#include <gtest/gtest.h>

#include <future>

namespace glidar::app {
namespace {

using foxglove::PlaybackCommand;

TEST(Playback, BeginsPausedAfterTheFirstFrame) {
  Playback playback;
  StopRequest stop;
  EXPECT_TRUE(playback.wait(stop));
  EXPECT_FALSE(playback.is_playing());
  stop.request();
  EXPECT_FALSE(playback.wait(stop));
}

TEST(Playback, AStepReleasesOneFrameAndPlayAll) {
  Playback playback;
  StopRequest stop;
  EXPECT_TRUE(playback.wait(stop));
  auto second = std::async(std::launch::async, [&] { return playback.wait(stop); });
  playback.command(PlaybackCommand::step);
  EXPECT_TRUE(second.get());
  EXPECT_FALSE(playback.is_playing());
  playback.command(PlaybackCommand::play);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(playback.wait(stop));
  playback.command(PlaybackCommand::pause);
  stop.request();
  EXPECT_FALSE(playback.wait(stop));
}

TEST(Playback, StepWhilePlayingPausesAfterOneFrame) {
  Playback playback;
  StopRequest stop;
  playback.command(PlaybackCommand::play);
  playback.command(PlaybackCommand::step);
  EXPECT_TRUE(playback.wait(stop));
  EXPECT_FALSE(playback.is_playing());
  stop.request();
  EXPECT_FALSE(playback.wait(stop));
}

}  // namespace
}  // namespace glidar::app
