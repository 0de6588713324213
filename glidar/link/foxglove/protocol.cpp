// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/protocol.hpp>

#include <glidar/core/error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace glidar::foxglove {

nlohmann::json parse_object(std::string_view text, const std::string& where) {
  nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
  if (!value.is_object()) {
    throw Error({.where = where,
                 .found = value.is_discarded() ? "invalid JSON" : "JSON that is not an object",
                 .allowed = "a JSON object"});
  }
  return value;
}

const nlohmann::json& member(const nlohmann::json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (found == object.end()) {
    throw Error({.where = "received JSON", .found = std::string("no member '") + name + "'"});
  }
  return *found;
}

std::string text_member(const nlohmann::json& object, const char* name, std::size_t max_bytes) {
  const nlohmann::json& value = member(object, name);
  const auto* text = value.get_ptr<const std::string*>();
  if (text == nullptr || text->size() > max_bytes) {
    throw Error({.where = std::string("received JSON, ") + name,
                 .found = text == nullptr ? "no text" : std::to_string(text->size()) + " bytes",
                 .allowed = "a text of at most " + std::to_string(max_bytes) + " bytes"});
  }
  return *text;
}

std::uint64_t whole_number(const nlohmann::json& value, const char* name, std::uint64_t max) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > max) {
    throw Error({.where = std::string("received JSON, ") + name,
                 .found = "no whole number in range",
                 .allowed = "0 to " + std::to_string(max)});
  }
  return value.get<std::uint64_t>();
}

std::string compact_text(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.sdk.v1",
                                                           "foxglove.websocket.v1"};

bool is_offered(std::string_view offered, std::string_view name) {
  while (!offered.empty()) {
    const std::size_t comma = std::min(offered.find(','), offered.size());
    std::string_view word = offered.substr(0, comma);
    while (word.starts_with(' ') || word.starts_with('\t')) word.remove_prefix(1);
    while (word.ends_with(' ') || word.ends_with('\t')) word.remove_suffix(1);
    if (word == name) return true;
    offered.remove_prefix(std::min(comma + 1, offered.size()));
  }
  return false;
}

const Json& list_member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array()) {
    throw Error({.where = std::string("client message, ") + name,
                 .found = "no list",
                 .allowed = "a list of subscriptions"});
  }
  if (found->size() > kMaxSubscriptions) {
    throw Error({.where = std::string("client message, ") + name,
                 .found = std::to_string(found->size()) + " entries",
                 .allowed = "at most " + std::to_string(kMaxSubscriptions)});
  }
  return *found;
}

std::uint32_t id_of(const Json& value, const char* name) {
  return static_cast<std::uint32_t>(
      whole_number(value, name, std::numeric_limits<std::uint32_t>::max()));
}

Subscribe decode_subscribe(const Json& object) {
  Subscribe result;
  for (const Json& entry : list_member(object, "subscriptions")) {
    result.subscriptions.push_back(
        {id_of(member(entry, "id"), "id"), id_of(member(entry, "channelId"), "channelId")});
  }
  return result;
}

Unsubscribe decode_unsubscribe(const Json& object) {
  Unsubscribe result;
  for (const Json& entry : list_member(object, "subscriptionIds")) {
    result.subscriptions.push_back(id_of(entry, "subscriptionIds"));
  }
  return result;
}

template <std::size_t Size>
void put(std::array<std::byte, Size>& bytes, std::size_t at, std::uint64_t value,
         std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
}

}  // namespace

std::string_view choose_subprotocol(std::string_view offered) {
  for (const std::string_view name : kSubprotocols) {
    if (is_offered(offered, name)) return name;
  }
  return {};
}

std::string server_info_text(const ServerInfo& info) {
  return compact_text({{"op", "serverInfo"},
                       {"name", info.name},
                       {"capabilities", {"time"}},
                       {"supportedEncodings", {"cdr"}},
                       {"metadata", info.metadata},
                       {"sessionId", info.session_id}});
}

std::string advertise_text(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return compact_text({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string status_text(StatusLevel level, const std::string& message) {
  return compact_text({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

ClientMessage decode_client_message(std::string_view text) {
  const Json object = parse_object(text, "client message");
  const std::string operation = text_member(object, "op", 64);
  if (operation == "subscribe") return decode_subscribe(object);
  if (operation == "unsubscribe") return decode_unsubscribe(object);
  return Unsupported{operation};
}

std::array<std::byte, 13> message_head(SubscriptionId subscription, std::uint64_t time_ns) {
  std::array<std::byte, 13> bytes{std::byte{1}};
  put(bytes, 1, subscription, 4);
  put(bytes, 5, time_ns, 8);
  return bytes;
}

std::array<std::byte, 9> time_message(std::uint64_t time_ns) {
  std::array<std::byte, 9> bytes{std::byte{2}};
  put(bytes, 1, time_ns, 8);
  return bytes;
}

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

std::size_t MessageQueue::push(ChannelMessage message, std::size_t depth) {
  const auto is_same = [channel = message.channel](const ChannelMessage& other) {
    return other.channel == channel;
  };
  const auto waiting =
      static_cast<std::size_t>(std::count_if(messages_.begin(), messages_.end(), is_same));
  if (waiting < depth) {
    messages_.push_back(std::move(message));
    return 0;
  }
  // each message of the channel takes the place of the one before it
  auto place = std::find_if(messages_.begin(), messages_.end(), is_same);
  for (auto next = place;
       (next = std::find_if(std::next(place), messages_.end(), is_same)) != messages_.end();
       place = next) {
    *place = std::move(*next);
  }
  *place = std::move(message);
  return 1;
}

std::optional<ChannelMessage> MessageQueue::pop() {
  if (messages_.empty()) return std::nullopt;
  ChannelMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

void MessageQueue::remove(ChannelId channel) {
  std::erase_if(messages_, [&](const ChannelMessage& one) { return one.channel == channel; });
}

namespace {

std::vector<PageFile> list_page_files() {
  constexpr std::string_view kHtml = "text/html; charset=utf-8";
  constexpr std::string_view kScript = "text/javascript; charset=utf-8";
  std::vector<PageFile> files = {{"/", kHtml, page_text("index.html")},
                                 {"/style.css", "text/css; charset=utf-8", page_text("style.css")},
                                 {"/icon.svg", "image/svg+xml", page_text("icon.svg")}};
  for (const std::string_view target :
       {"/main.js", "/connection.js", "/cdr.js", "/ros_messages.js", "/cloud.js", "/colours.js",
        "/transforms.js", "/vectors.js", "/scene.js", "/shaders.js", "/view.js", "/controls.js",
        "/images.js", "/panels.js", "/picking.js", "/playback.js"}) {
    files.push_back({target, kScript, page_text(target.substr(1))});
  }
  return files;
}

}  // namespace

std::span<const PageFile> page_files() {
  static const std::vector<PageFile> files = list_page_files();
  return files;
}

const PageFile* find_page_file(std::string_view target) {
  const auto files = page_files();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const PageFile& file) { return file.target == target; });
  return found == files.end() ? nullptr : &*found;
}

namespace {

HttpReply plain(int status, const std::string& text) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = text + "\n"};
}

HttpReply plain(const link::HttpRefusal& refusal) {
  return plain(refusal.status, std::string(refusal.text));
}

HttpReply get(std::string_view target) {
  const PageFile* file = find_page_file(target.substr(0, target.find('?')));
  if (file == nullptr) return plain(404, "not found");
  return {.status = 200,
          .content_type = std::string(file->content_type),
          .body = std::string(file->text)};
}

HttpAction post(const HttpRequest& request, const link::HttpGuard& guard,
                const PageServices& services) {
  const bool is_playback = request.target == "/api/playback";
  const bool is_pick = request.target == "/api/pick";
  if (!(is_playback && services.has_playback) && !(is_pick && services.has_picks)) {
    return plain(404, "not found");
  }
  if (const auto refusal = guard.refuse_change(request.head)) return plain(*refusal);
  if (request.content_type != "application/json") return plain(415, "not application/json");
  try {
    if (is_playback) return decode_playback_command(request.body);
    return decode_pick(request.body);
  } catch (const Error& error) {
    return plain(400, error.what());
  }
}

}  // namespace

HttpAction route(const HttpRequest& request, link::HttpGuard& guard, const PageServices& services) {
  if (const auto refusal = guard.refuse(request.head)) return plain(*refusal);
  return request.head.method == "POST" ? post(request, guard, services) : get(request.target);
}

}  // namespace glidar::foxglove
