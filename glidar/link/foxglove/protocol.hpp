// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/http_guard.hpp>
#include <glidar/link/payload.hpp>

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Reading of received JSON; every function throws Error for anything but what it returns.
namespace glidar::foxglove {

nlohmann::json parse_object(std::string_view text, const std::string& where);

const nlohmann::json& member(const nlohmann::json& object, const char* name);

/// At most so many bytes.
std::string text_member(const nlohmann::json& object, const char* name, std::size_t max_bytes);

/// A whole number from 0 to `max`.
std::uint64_t whole_number(const nlohmann::json& value, const char* name, std::uint64_t max);

/// One line; invalid UTF-8 is replaced.
std::string compact_text(const nlohmann::json& value);

}  // namespace glidar::foxglove

/// The Foxglove WebSocket protocol, version 1: JSON texts and little-endian binary messages, which
/// Foxglove and Lichtblick understand. Source: the specification in the repository
/// foxglove/ws-protocol on GitHub, and the npm package @foxglove/ws-protocol 0.8.0.
namespace glidar::foxglove {

using ChannelId = std::uint32_t;
using SubscriptionId = std::uint32_t;

/// The subprotocol to answer: the first supported one in a Sec-WebSocket-Protocol header; empty if
/// there is none.
std::string_view choose_subprotocol(std::string_view offered);

/// A topic and the description of its messages.
struct Channel {
  ChannelId id = 0;
  std::string topic;
  std::string encoding;         ///< of messages, e.g. "cdr"
  std::string schema_name;      ///< e.g. "sensor_msgs/msg/PointCloud2"
  std::string schema;           ///< text of the definition
  std::string schema_encoding;  ///< e.g. "ros2msg"
};

/// The first message to a client.
struct ServerInfo {
  std::string name;
  std::string session_id;  ///< differs after a restart
  std::map<std::string, std::string> metadata = {};
};

std::string server_info_text(const ServerInfo& info);
std::string advertise_text(std::span<const Channel> channels);

enum class StatusLevel : std::uint8_t { info = 0, warning = 1, error = 2 };
/// A message that the client shows to its user.
std::string status_text(StatusLevel level, const std::string& message);

struct Subscription {
  SubscriptionId id = 0;  ///< chosen by the client
  ChannelId channel = 0;

  bool operator==(const Subscription&) const = default;
};

struct Subscribe {
  std::vector<Subscription> subscriptions;
};

struct Unsubscribe {
  std::vector<SubscriptionId> subscriptions;
};

/// A valid message of an optional part of the protocol that this server does not offer.
struct Unsupported {
  std::string operation;
};

using ClientMessage = std::variant<Subscribe, Unsubscribe, Unsupported>;

inline constexpr std::size_t kMaxSubscriptions = 1024;  ///< of one client

/// Throws Error unless the text is a JSON object with valid members.
ClientMessage decode_client_message(std::string_view text);

/// The bytes before the payload of a message: opcode 1, subscription, time in ns.
std::array<std::byte, 13> message_head(SubscriptionId subscription, std::uint64_t time_ns);

/// The time of the server: opcode 2, time in ns.
std::array<std::byte, 9> time_message(std::uint64_t time_ns);

}  // namespace glidar::foxglove

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

namespace glidar::foxglove {

/// A message of a channel on its way to clients.
struct ChannelMessage {
  ChannelId channel = 0;
  std::uint64_t time_ns = 0;
  link::Payload payload = {};
};

/// Messages that wait: of each channel the newest ones, as many as its depth. Channels take turns:
/// a newer message takes the place in the queue of the one that is dropped.
class MessageQueue {
 public:
  /// `depth`, from 1, is the number of this channel's messages to keep. Returns the number of
  /// messages that were dropped.
  std::size_t push(ChannelMessage message, std::size_t depth);
  /// The message that has waited longest; empty if there is none.
  std::optional<ChannelMessage> pop();
  void remove(ChannelId channel);
  [[nodiscard]] std::size_t size() const { return messages_.size(); }

 private:
  std::deque<ChannelMessage> messages_;
};

/// A file of the page, which the program contains.
struct PageFile {
  std::string_view target;  ///< e.g. "/main.js"
  std::string_view content_type;
  std::string_view text;
};

/// The file of an HTTP target; nullptr if there is none.
const PageFile* find_page_file(std::string_view target);

/// All files.
std::span<const PageFile> page_files();

/// The text of a file in page/ by its name.
std::string_view page_text(std::string_view file);

/// The parts of an HTTP request that decide the answer.
struct HttpRequest {
  link::HttpHead head;
  std::string_view target;
  std::string_view content_type = {};
  std::string_view body = {};
};

struct HttpReply {
  int status = 200;
  std::string content_type;
  std::string body;
};

/// What the page can request of the caller.
struct PageServices {
  bool has_playback = false;
  bool has_picks = false;
};

/// A reply, or a request that the caller answers.
using HttpAction = std::variant<HttpReply, PlaybackCommand, Pick>;

/// GET of the page's files; POST of /api/playback and /api/pick, which only the page itself may
/// use.
HttpAction route(const HttpRequest& request, link::HttpGuard& guard, const PageServices& services);

/// Sent with every reply: scripts, styles and connections only from and to this server.
inline constexpr std::string_view kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace glidar::foxglove
