// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/live_view.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace glidar::app {

LiveView::LiveView(const link::Endpoint& at, Playback* playback, link::ErrorLog& errors)
    : host_(at.host), playback_(playback) {
  foxglove::ServerOptions options{.at = at};
  if (playback_ != nullptr) {
    options.on_playback = [this](foxglove::PlaybackCommand command) {
      playback_->command(command);
    };
  }
  options.on_pick = [this](const foxglove::Pick& selected, foxglove::PickReply reply) {
    explain(selected, std::move(reply));
  };
  server_ = std::make_unique<foxglove::FoxgloveServer>(options, errors);
}

LiveView::~LiveView() {
  server_.reset();  // its thread passes points to the explainer
}

void LiveView::begin(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin) {
  // viewers of a paused replay may come at any time
  channels_ = std::make_unique<foxglove::RosChannels>(*server_, playback_ != nullptr);
  publisher_ = make_rig_publisher(*channels_, flags, prepared, origin, true);
  const std::lock_guard lock(mutex_);
  explainer_ = std::make_unique<PointExplainer>(flags, prepared, *publisher_);
}

std::string LiveView::url() const {
  const bool is_here = host_ == "*" || host_ == "127.0.0.1";
  return fmt::format("http://{}:{}/", is_here ? "localhost" : host_, server_->port());
}

HitColumnMask LiveView::hit_columns(std::size_t sensor_index) const {
  return publisher_->hit_columns(sensor_index);
}

void LiveView::write(const MeasuredFrame& measured) {
  explainer_->add_frame(measured);
  publisher_->publish(measured.sensor_index, measured.frame, *measured.beams);
  time_ns_ = static_cast<std::uint64_t>(std::max<std::int64_t>(0, measured.frame.stamp_ns));
  if (playback_ != nullptr) show_playback();
}

void LiveView::serve() {
  if (playback_ != nullptr && shows_playing_ != playback_->is_playing()) show_playback();
}

void LiveView::show_playback() {
  shows_playing_ = playback_->is_playing();
  server_->set_playback({.is_playing = *shows_playing_, .time_ns = time_ns_});
}

void LiveView::finish() {
  publisher_->finish();
}

void LiveView::explain(const foxglove::Pick& selected, foxglove::PickReply reply) {
  const std::lock_guard lock(mutex_);
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!explainer_ || selected.time_ns > kMax) return;
  explainer_->explain({.topic = selected.topic,
                       .stamp_ns = static_cast<std::int64_t>(selected.time_ns),
                       .index = selected.index},
                      std::move(reply));
}

}  // namespace glidar::app
