// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Rate of clouds published over a socket, relative to measurements without publishing.
#include "deliver_frames.hpp"
#include "model_view.hpp"
#include "ratio_reporter.hpp"

#include <apps/glidar/run/delivery.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

namespace glidar::bench {
namespace {

constexpr std::uint16_t kPort = 47155;

const std::vector<std::string> kColumns = {"xyz", "intensity"};

void measure_alone(benchmark::State& state, const ModelView& view) {
  Frame frame;
  for (auto _ : state) view.measure(frame);
  state.SetItemsProcessed(state.iterations());
}

/// A subscriber in a separate thread, which receives all messages.
class Reader {
 public:
  Reader()
      : socket_(context_,
                {.kind = link::SocketKind::subscribe, .max_message_bytes = std::int64_t{1} << 30}) {
    socket_.subscribe("c");
    socket_.connect({"127.0.0.1", kPort});
    thread_ = std::thread([this] { run(); });
  }
  ~Reader() {
    is_ending_ = true;
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  void run() {
    constexpr std::chrono::milliseconds kLook{20};
    while (!is_ending_) {
      link::wait_for({&socket_}, -1, kLook);
      while (socket_.receive()) continue;
    }
  }

  link::Context context_;
  link::Socket socket_;
  std::atomic<bool> is_ending_ = false;
  std::thread thread_;
};

void publish(benchmark::State& state, const ModelView& view, bool is_read) {
  link::Context context;
  link::ErrorLog errors({});
  woods2016::CloudPublisher publisher(context, {.endpoint = {"127.0.0.1", kPort}}, errors);
  const std::unique_ptr<Reader> reader = is_read ? std::make_unique<Reader>() : nullptr;
  while (is_read && publisher.counts().subscribers == 0) publisher.serve();
  const auto beams = std::make_shared<const Beams>(view.beams);
  PointCloud cloud;
  app::Delivery delivery(
      [&](const app::MeasuredFrame& slot) {
        make_point_cloud(slot.frame, *slot.beams, view.scene, {}, kColumns, cloud);
        publisher.write(cloud, slot.frame);
      },
      [&] { publisher.serve(); }, [] {});
  deliver_frames(state, view, beams, delivery);
  state.counters["missed"] = static_cast<double>(publisher.counts().missed);
}

void add(const std::string& name, const std::string& model, unsigned threads,
         std::vector<Ratio>& ratios) {
  const auto view = std::make_shared<const ModelView>(model, threads);
  const std::string end = ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  const auto named = [&](const char* what) { return name + what + end; };
  const auto enter = [](const std::string& title, const auto& body) {
    benchmark::RegisterBenchmark(title.c_str(), body)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  enter(named(" measured"), [view](benchmark::State& s) { measure_alone(s, *view); });
  enter(named(" published"), [view](benchmark::State& s) { publish(s, *view, false); });
  enter(named(" published and read"), [view](benchmark::State& s) { publish(s, *view, true); });
  constexpr double kGoal = 0.9;
  ratios.push_back(
      {named(": published / measured"), named(" measured"), named(" published"), kGoal});
  ratios.push_back({named(": read by a subscriber / measured"), named(" measured"),
                    named(" published and read"), kGoal});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
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
