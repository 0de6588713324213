// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/live_view.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/simulate/explain.hpp>

#include "io/ros/memory_sink.hpp"
#include "live_scene.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <future>

namespace glidar::app {
namespace {

using ::testing::HasSubstr;

std::string explained(PointExplainer& explainer, const PublishedPoint& point) {
  std::promise<std::string> reply;
  explainer.explain(point, [&](const std::string& text) { reply.set_value(text); });
  return reply.get_future().get();
}

/// The firing time of a point of a message with the default columns.
std::uint32_t time_of(const ros::PointCloud2& message, std::size_t index) {
  std::uint32_t offset = 0;
  for (const auto& field : message.fields)
    if (field.name == "time") offset = field.offset;
  std::uint32_t time = 0;
  std::memcpy(&time, message.data.bytes().data() + index * message.point_step + offset,
              sizeof time);
  return time;
}

TEST(PointExplainer, ExplainsTheBeamOfTheSelectedPointOfTheMessage) {
  LiveScene scene;
  ros::MemorySink sink;
  const auto publisher = scene.publisher(sink, PoseOrigin::motion, true);
  PointExplainer explainer(scene.flags, scene.prepared, *publisher);
  for (const std::uint32_t number : {0U, 1U}) {
    const MeasuredFrame measured = scene.measure(number);
    explainer.add_frame(measured.view());
    publisher->publish(0, measured.frame, *measured.beams);
  }
  const auto clouds = sink.of<ros::PointCloud2>("/lidar/points");
  ASSERT_EQ(clouds.size(), 2U);
  const ros::PointCloud2& message = clouds[1];
  ASSERT_GT(message.width, 1000U);
  const ActiveSensor& active = scene.prepared.sensors.front();
  const std::shared_ptr<const Beams> beams = active.simulator->beams(1);
  const std::uint32_t first_ns = *std::min_element(beams->times_ns.begin(), beams->times_ns.end());
  for (const std::size_t index :
       {std::size_t{0}, std::size_t{777}, std::size_t{message.width} - 1}) {
    const std::string text = explained(
        explainer,
        {.topic = "/lidar/points", .stamp_ns = ros::to_ns(message.header.stamp), .index = index});
    EXPECT_THAT(text, HasSubstr("fired     " + std::to_string(time_of(message, index) + first_ns) +
                                " ns after the start of frame 1"));
    // a VLP-16 fires its lasers one after the other: the time states the beam, up to the column
    Frame frame;
    set_frame_header(scene.flags, scene.prepared, active, 1, frame);
    const auto find = [&](const Frame& repeated) {
      std::size_t entry = 0;
      while (beams->times_ns[entry] != time_of(message, index) + first_ns ||
             repeated.status[entry] != Status::hit)
        ++entry;
      return entry;
    };
    const PointTrace trace = explain(*active.simulator, active.motion, find, frame);
    EXPECT_EQ(text, format_trace(trace, *active.simulator, frame));
  }
}

TEST(PointExplainer, ReportsPointsAndFramesThatDoNotExist) {
  LiveScene scene;
  ros::MemorySink sink;
  const auto publisher = scene.publisher(sink, PoseOrigin::motion, true);
  PointExplainer explainer(scene.flags, scene.prepared, *publisher);
  const MeasuredFrame measured = scene.measure(0);
  explainer.add_frame(measured.view());
  const std::int64_t stamp_ns =
      ros::cloud_stamp_ns({measured.frame, scene.prepared.sensors.front().sensor, *measured.beams});
  EXPECT_THAT(explained(explainer, {"/lidar/points", stamp_ns, 1'000'000}),
              HasSubstr("point 1000000"));
  EXPECT_THAT(explained(explainer, {"/lidar/points", stamp_ns + 1, 0}), HasSubstr("is not known"));
  EXPECT_THAT(explained(explainer, {"/other", stamp_ns, 0}), HasSubstr("is not known"));
}

TEST(PointExplainer, EndsWithPointsThatWait) {
  LiveScene scene;
  ros::MemorySink sink;
  const auto publisher = scene.publisher(sink, PoseOrigin::motion, true);
  const MeasuredFrame measured = scene.measure(0);
  const std::int64_t stamp_ns =
      ros::cloud_stamp_ns({measured.frame, scene.prepared.sensors.front().sensor, *measured.beams});
  constexpr int kPoints = 200;
  int replies = 0;
  {
    PointExplainer explainer(scene.flags, scene.prepared, *publisher);
    explainer.add_frame(measured.view());
    for (int i = 0; i < kPoints; ++i) {
      explainer.explain({"/lidar/points", stamp_ns, 0}, [&](const std::string&) { ++replies; });
    }
  }
  EXPECT_LT(replies, kPoints);
}

}  // namespace
}  // namespace glidar::app
