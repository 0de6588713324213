// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Cost of publishing clouds of 131,072 points to the live view, for the thread that simulates.
#include "ratio_reporter.hpp"

#include <glidar/link/foxglove/server.hpp>

#include <tests/link/foxglove/web_peers.hpp>

#include <atomic>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace glidar::bench {
namespace {

constexpr std::size_t kPoints = 131'072;
constexpr std::size_t kPointBytes = 34;

link::Payload cloud() {
  constexpr std::size_t kBytes = kPoints * kPointBytes;
  return {.memory = std::make_shared<std::byte[]>(kBytes), .size = kBytes};  // NOLINT
}

/// A server with clients that read everything, or nothing.
class Stage {
 public:
  Stage(int clients, bool read) : errors_({}) {
    foxglove::ServerOptions options;
    options.at.port = 0;
    server_ = std::make_unique<foxglove::FoxgloveServer>(options, errors_);
    channel_ =
        server_->add_channel({.topic = "/points", .schema_name = "sensor_msgs/msg/PointCloud2"});
    for (int i = 0; i < clients; ++i) {
      auto& client =
          clients_.emplace_back(std::make_unique<testing::WebSocketPeer>(server_->port()));
      client->subscribe(1, channel_);
      if (read) threads_.emplace_back([this, &peer = *client] { count(peer); });
    }
    testing::soon([&] { return clients == 0 || server_->is_subscribed(channel_); });
  }
  ~Stage() {
    server_.reset();
    for (std::thread& thread : threads_) thread.join();
  }
  void publish(const link::Payload& message) { server_->publish(channel_, 1, message); }
  [[nodiscard]] std::uint64_t received() const { return received_; }
  void wait_for(std::uint64_t messages) const {
    while (received_ < messages) std::this_thread::yield();
  }

 private:
  void count(testing::WebSocketPeer& peer) {
    try {
      for (;;) {
        if (peer.receive().opcode == 2) ++received_;
      }
    } catch (const std::runtime_error&) {
      return;  // the server has ended
    }
  }

  link::ErrorLog errors_;
  std::unique_ptr<foxglove::FoxgloveServer> server_;
  foxglove::ChannelId channel_ = 0;
  std::vector<std::unique_ptr<testing::WebSocketPeer>> clients_;
  std::atomic<std::uint64_t> received_ = 0;
  std::vector<std::thread> threads_;
};

/// Time of publish() itself. One reader, or 8 clients that never read.
void publish_cost(benchmark::State& state) {
  Stage stage(static_cast<int>(state.range(0)), state.range(1) != 0);
  const link::Payload message = cloud();
  for (auto _ : state) stage.publish(message);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(publish_cost)
    ->ArgNames({"clients", "read"})
    ->Args({0, 0})
    ->Args({1, 1})
    ->Args({8, 0})
    ->Unit(benchmark::kMicrosecond);

/// Clouds per second that one client receives completely, one after the other.
void delivery(benchmark::State& state) {
  Stage stage(1, true);
  const link::Payload message = cloud();
  for (auto _ : state) {
    const std::uint64_t before = stage.received();
    stage.publish(message);
    stage.wait_for(before + 1);
  }
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(message.size));
}
BENCHMARK(delivery)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  return glidar::bench::run(argc, argv, {});
}
