// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/page_messages.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/foxglove/json_members.hpp>

#include <nlohmann/json.hpp>

#include <charconv>
#include <limits>
#include <system_error>

namespace glidar::foxglove {
namespace {

std::uint64_t decimal(const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw Error({.where = "pick, time_ns", .found = "'" + text + "'", .allowed = "decimal digits"});
  }
  return value;
}

}  // namespace

PlaybackCommand decode_playback_command(std::string_view text) {
  const std::string command = text_member(parse_object(text, "playback"), "command", 16);
  if (command == "play") return PlaybackCommand::play;
  if (command == "pause") return PlaybackCommand::pause;
  if (command == "step") return PlaybackCommand::step;
  throw Error({.where = "playback, command", .found = "unknown", .allowed = "play, pause, step"});
}

std::string playback_state_text(const PlaybackState& state) {
  nlohmann::json value = {{"playing", state.is_playing},
                          {"time_ns", std::to_string(state.time_ns)}};
  if (state.first_ns) value["first_ns"] = std::to_string(*state.first_ns);
  if (state.last_ns) value["last_ns"] = std::to_string(*state.last_ns);
  return compact_text(value);
}

std::string_view playback_schema() {
  return R"({"type":"object","properties":{"playing":{"type":"boolean"},"time_ns":{"type":"string"},)"
         R"("first_ns":{"type":"string"},"last_ns":{"type":"string"}}})";
}

Pick decode_pick(std::string_view text) {
  constexpr std::size_t kMaxTopic_bytes = 256;
  constexpr std::size_t kMaxDigits = 20;
  const nlohmann::json object = parse_object(text, "pick");
  return {.topic = text_member(object, "topic", kMaxTopic_bytes),
          .time_ns = decimal(text_member(object, "time_ns", kMaxDigits)),
          .index = whole_number(member(object, "index"), "index",
                                std::numeric_limits<std::uint32_t>::max())};
}

std::string answer_text(const char* member, const std::string& text) {
  return compact_text({{member, text}});
}

}  // namespace glidar::foxglove
