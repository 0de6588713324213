// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// JSON of the page that the server offers beside the Foxglove protocol.
namespace glidar::foxglove {

enum class PlaybackCommand : std::uint8_t { play, pause, step };

/// {"command": "play"}, "pause" or "step". Throws Error for anything else.
PlaybackCommand decode_playback_command(std::string_view text);

/// Whether frames follow automatically.
struct PlaybackState {
  bool is_playing = true;
  std::uint64_t time_ns = 0;
  std::optional<std::uint64_t> first_ns = {};  ///< of a replay with known ends
  std::optional<std::uint64_t> last_ns = {};
};

/// Message of kPlaybackTopic. Times are decimal texts, because JSON numbers in JavaScript have 53
/// bits.
std::string playback_state_text(const PlaybackState& state);
/// The JSON Schema of these messages.
std::string_view playback_schema();
inline constexpr std::string_view kPlaybackTopic = "/glidar/playback";

/// A point that the user has selected.
struct Pick {
  std::string topic;
  std::uint64_t time_ns = 0;  ///< stamp of the message's header
  std::uint64_t index = 0;    ///< of the point in the message

  bool operator==(const Pick&) const = default;
};

/// {"topic": "/points", "time_ns": "123", "index": 4}. Throws Error for anything else.
Pick decode_pick(std::string_view text);

/// {"text": "..."} or {"error": "..."}
std::string answer_text(const char* member, const std::string& text);

}  // namespace glidar::foxglove
