// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Rate of clouds published as a topic of ROS 2, relative to measurements without publishing. The
// reader is a process of its own, which shares the processor.
#include "deliver_frames.hpp"
#include "model_view.hpp"
#include "ratio_reporter.hpp"

#include <apps/glidar/run/delivery.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/link/dds/message_sink.hpp>
#include <glidar/link/dds/topics.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace glidar::bench {
namespace {

constexpr const char* kReadOption = "--read";
constexpr const char* kTopic = "/points";
const std::vector<std::string> kColumns = {"xyz", "intensity"};

/// Reads clouds until the input ends.
int read_clouds() {
  link::ErrorLog errors({});
  const dds::Participant participant({}, errors);
  const dds::WakeUp wake_up;
  const ros::MessageType& type = ros::message_type<ros::PointCloud2>();
  dds::TopicReader reader(participant, {kTopic, type, type.qos, std::size_t{1} << 28}, wake_up);
  std::array<pollfd, 2> entries = {
      pollfd{.fd = wake_up.descriptor(), .events = POLLIN, .revents = 0},
      pollfd{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0}};
  do {
    poll(entries.data(), entries.size(), -1);
    wake_up.clear();
    while (reader.take()) continue;
  } while (entries[1].revents == 0);
  return 0;
}

/// This program as the reader.
class ReaderProcess {
 public:
  ReaderProcess() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
    process_ = fork();
    if (process_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      execl("/proc/self/exe", "ros2_bench", kReadOption, nullptr);
      _exit(1);
    }
    close(ends[0]);
    input_ = ends[1];
  }
  ~ReaderProcess() {
    close(input_);
    waitpid(process_, nullptr, 0);
  }
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

 private:
  pid_t process_ = 0;
  int input_ = -1;
};

void measure_only(benchmark::State& state, const ModelView& view) {
  Frame frame;
  for (auto _ : state) view.measure(frame);
  state.SetItemsProcessed(state.iterations());
}

void publish_topic(benchmark::State& state, const ModelView& view) {
  const ReaderProcess reader;
  link::ErrorLog errors({});
  const dds::Participant participant({}, errors);
  dds::MessageSink sink(participant, {});
  const std::size_t topic = sink.add_topic(ros::make_topic<ros::PointCloud2>(kTopic));
  while (!sink.is_wanted(topic)) std::this_thread::yield();
  const auto beams = std::make_shared<const Beams>(view.beams);
  PointCloud cloud;
  std::vector<std::byte> bytes;
  app::Delivery delivery(
      [&](const app::MeasuredFrame& slot) {
        make_point_cloud(slot.frame, *slot.beams, view.scene, {}, kColumns, cloud);
        ros::serialize_to(ros::to_point_cloud2(cloud, {slot.frame, view.sensor, *slot.beams}),
                          bytes);
        sink.take(topic, slot.frame.stamp_ns, bytes);
      },
      [] {}, [] {});
  deliver_frames(state, view, beams, delivery);
  state.SetItemsProcessed(state.iterations());
}

void add(const std::string& name, const std::string& model, unsigned threads,
         std::vector<Ratio>& ratios) {
  const auto view = std::make_shared<const ModelView>(model, threads);
  const std::string end = ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  const auto enter = [](const std::string& title, const auto& body) {
    benchmark::RegisterBenchmark(title.c_str(), body)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  const std::string measured = name + " measured" + end;
  const std::string published = name + " published and read" + end;
  enter(measured, [view](benchmark::State& state) { measure_only(state, *view); });
  enter(published, [view](benchmark::State& state) { publish_topic(state, *view); });
  constexpr double kGoal = 0.9;
  ratios.push_back({name + ": published and read / measured" + end, measured, published, kGoal});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  setenv("ROS_DOMAIN_ID", "77", 0);
  if (argc == 2 && std::string_view(argv[1]) == glidar::bench::kReadOption)
    return glidar::bench::read_clouds();
  std::vector<glidar::bench::Ratio> ratios;
  for (const unsigned threads : {1U, 2U}) {
    glidar::bench::add("asteroid", GLIDAR_MODELS "/asteroid/asteroid.glb", threads, ratios);
    if (const char* data = std::getenv("GLIDAR_DATA")) {
      glidar::bench::add("bunny", std::string(data) + "/models/stanford/bun_zipper.ply", threads,
                         ratios);
    }
  }
  return glidar::bench::run(argc, argv, ratios);
}
