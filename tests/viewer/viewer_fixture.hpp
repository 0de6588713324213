// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/viewer.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>

namespace glidar::app {

/// A viewer without a window, with a temporary folder.
class ViewerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    flags_.input = "builtin:asteroid";
    flags_.sensor.width = flags_.sensor.height = 32;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Takes results until the condition holds; false after ten minutes, because machines may be
  /// busy.
  template <class Condition>
  bool wait_until(Viewer& viewer, const Condition& holds) {
    for (int i = 0; i < 6000 && !holds(); ++i) {
      std::unique_lock lock(mutex_);
      woken_.wait_for(lock, std::chrono::milliseconds(100), [this] { return is_woken_; });
      is_woken_ = false;
      lock.unlock();
      viewer.take_results();
    }
    return holds();
  }

  /// The snapshot of the latest request.
  const Snapshot& snapshot_of(Viewer& viewer) {
    EXPECT_TRUE(wait_until(viewer, [&] {
      return viewer.snapshot() != nullptr && viewer.snapshot()->request == viewer.request();
    }));
    return *viewer.snapshot();
  }

  std::filesystem::path folder_;
  RenderFlags flags_;
  Console console_{true};
  std::mutex mutex_;
  std::condition_variable woken_;
  bool is_woken_ = false;
  MeasurementThread measurements_{console_, [this] {
                                    const std::lock_guard lock(mutex_);
                                    is_woken_ = true;
                                    woken_.notify_one();
                                  }};
};

}  // namespace glidar::app
