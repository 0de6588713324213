// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/server.hpp>

#include <glidar/link/foxglove/acceptor.hpp>
#include <glidar/link/foxglove/hub.hpp>
#include <glidar/link/foxglove/reply_gate.hpp>

#include <boost/asio/io_context.hpp>

#include <cstring>
#include <exception>
#include <thread>
#include <utility>

namespace glidar::foxglove {
namespace {

link::Payload payload_of(const std::string& text) {
  link::Payload payload{.memory = std::make_shared<std::byte[]>(text.size()),  // NOLINT
                        .size = text.size()};
  std::memcpy(payload.memory.get(), text.data(), text.size());
  return payload;
}

}  // namespace

struct FoxgloveServer::Impl {
  Impl(const ServerOptions& server_options, link::ErrorLog& log)
      : options(server_options),
        hub(io, options, log),
        gate(std::make_shared<ReplyGate>(io)),
        acceptor(hub, gate) {}

  /// An exception of a session ends that session; the others continue.
  void run() {
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& error) {
        hub.errors().report("Foxglove server", error.what());
      }
    }
  }

  ServerOptions options;
  boost::asio::io_context io{1};
  Hub hub;
  std::shared_ptr<ReplyGate> gate;
  Acceptor acceptor;
  ChannelId playback = 0;
  std::thread thread;
};

FoxgloveServer::FoxgloveServer(const ServerOptions& options, link::ErrorLog& errors)
    : impl_(std::make_unique<Impl>(options, errors)) {
  if (options.on_playback) {
    impl_->playback = add_channel({.topic = std::string(kPlaybackTopic),
                                   .schema_name = "glidar.Playback",
                                   .schema = std::string(playback_schema()),
                                   .encoding = "json",
                                   .schema_encoding = "jsonschema"});
    set_playback({});
  }
  impl_->acceptor.start();
  impl_->thread = std::thread([this] { impl_->run(); });
}

FoxgloveServer::~FoxgloveServer() {
  impl_->gate->close();
  impl_->io.stop();
  impl_->thread.join();
}

ChannelId FoxgloveServer::add_channel(const ChannelOptions& options) {
  return impl_->hub.add_channel(options);
}

void FoxgloveServer::publish(ChannelId channel, std::uint64_t time_ns, link::Payload message) {
  if (channel == Hub::kTime) return;
  impl_->hub.publish({.channel = channel, .time_ns = time_ns, .payload = std::move(message)});
}

void FoxgloveServer::publish_time(std::uint64_t time_ns) {
  impl_->hub.publish({.channel = Hub::kTime, .time_ns = time_ns});
}

void FoxgloveServer::set_playback(const PlaybackState& state) {
  if (impl_->playback == 0) return;
  publish(impl_->playback, state.time_ns, payload_of(playback_state_text(state)));
}

bool FoxgloveServer::is_subscribed(ChannelId channel) const {
  return impl_->hub.is_subscribed(channel);
}

std::uint16_t FoxgloveServer::port() const {
  return impl_->acceptor.port();
}

ServerCounts FoxgloveServer::counts() const {
  return impl_->hub.counts();
}

bool has_foxglove_server() {
  return true;
}

}  // namespace glidar::foxglove
