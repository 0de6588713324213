// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/ouster_api.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/json_text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

namespace glidar::control {
namespace {

using ApiJson = nlohmann::ordered_json;

constexpr JsonLimits kApiJsonLimits{.max_depth = 8, .max_values = 1000};
constexpr std::string_view kRoot = "/api/v1/";

/// Old commands that return a section of the metadata.
constexpr std::array<std::pair<std::string_view, const char*>, 5> kSectionCommands = {{
    {"get_sensor_info", "sensor_info"},
    {"get_beam_intrinsics", "beam_intrinsics"},
    {"get_imu_intrinsics", "imu_intrinsics"},
    {"get_lidar_intrinsics", "lidar_intrinsics"},
    {"get_lidar_data_format", "lidar_data_format"},
}};

/// Old commands without effect on a simulated sensor.
constexpr std::array<std::string_view, 3> kEmptyCommands = {"reinitialize", "save_config_params",
                                                            "write_config_txt"};

ApiReply json_reply(const ApiJson& value) {
  return {200, value.dump()};
}

ApiReply refusal(int status, const std::string& what) {
  const ApiJson error = {{"error", {{"code", status}, {"detail", what}}}};
  return {status, error.dump(-1, ' ', false, ApiJson::error_handler_t::replace)};
}

/// Replaces escapes such as %41, and +, by the characters they encode (RFC 3986, 2.1; HTML forms).
std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16).ptr ==
            text.data() + i + 3) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += text[i] == '+' ? ' ' : text[i];
    }
  }
  return decoded;
}

/// The value of a parameter of the query; empty if there is none.
std::string query_value(std::string_view query, std::string_view key) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view pair = query.substr(0, end);
    const std::size_t equals = pair.find('=');
    if (pair.substr(0, equals) == key && equals != std::string_view::npos)
      return percent_decoded(pair.substr(equals + 1));
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return {};
}

std::uint16_t port_of(const std::string& key, const ApiJson& value) {
  if (value.is_number_unsigned() && value.get<std::uint64_t>() >= 1 &&
      value.get<std::uint64_t>() <= 65'535)
    return value.get<std::uint16_t>();
  throw Error({key, shown_json(value), "a port from 1 to 65535"});
}

/// Newer clients of old firmware name the address so.
std::string current_key(const std::string& key) {
  return key == "udp_ip" ? "udp_dest" : key;
}

}  // namespace

struct OusterApi::Impl {
  explicit Impl(const OusterApiOptions& given) : options(given) {
    metadata = parse_json<ApiJson>("metadata", options.metadata);
    if (!metadata.is_object() || !metadata.contains("config_params"))
      throw Error({"metadata of the sensor", "no config_params", "the JSON of ouster_metadata()"});
  }

  ApiReply get(std::string_view path, std::string_view query, const ApiRequest& request);
  ApiReply command(std::string_view name, std::string_view query, const ApiRequest& request);
  ApiReply configure(const ApiJson& changes, const ApiRequest& request);
  ApiReply set_parameter(const std::string& arguments, const ApiRequest& request);
  void change(ApiJson& config, const std::string& key, const ApiJson& value,
              const std::string& client) const;
  ApiJson& config() { return metadata["config_params"]; }

  OusterApiOptions options;
  ApiJson metadata;
};

OusterApi::OusterApi(const OusterApiOptions& options) : impl_(std::make_unique<Impl>(options)) {}
OusterApi::~OusterApi() = default;

ApiReply refusal_reply(const link::HttpRefusal& refused) {
  return refusal(refused.status, std::string(refused.text));
}

ApiReply OusterApi::answer(const ApiRequest& request) {
  const std::size_t mark = request.target.find('?');
  std::string_view path = request.target.substr(0, mark);
  const std::string_view query =
      mark == std::string_view::npos ? std::string_view{} : request.target.substr(mark + 1);
  if (!path.starts_with(kRoot)) return refusal(404, "no such resource");
  path.remove_prefix(kRoot.size());
  while (path.ends_with('/')) path.remove_suffix(1);
  try {
    if (request.method == "GET" || request.method == "HEAD")
      return impl_->get(path, query, request);
    if (request.method != "POST") return refusal(405, "GET, HEAD or POST");
    if (path != "sensor/config") return refusal(404, "no such resource");
    const std::string_view body = request.body.empty() ? std::string_view("{}") : request.body;
    return impl_->configure(parse_json<ApiJson>("configuration", body, kApiJsonLimits), request);
  } catch (const ApiJson::exception&) {
    return refusal(400, "the body is not JSON");
  } catch (const Error& error) {
    return refusal(400, error.what());
  }
}

ApiReply OusterApi::Impl::get(std::string_view path, std::string_view query,
                              const ApiRequest& request) {
  constexpr std::string_view kSections = "sensor/metadata/";
  constexpr std::string_view kCommands = "sensor/cmd/";
  if (path == "sensor/metadata") return json_reply(metadata);
  if (path == "sensor/config") return json_reply(config());
  if (path == "user/data") return json_reply(metadata.value("user_data", ""));
  if (path == "system/firmware")
    return json_reply({{"fw", metadata["sensor_info"].value("image_rev", "")}});
  if (path.starts_with(kSections)) {
    const auto section = metadata.find(std::string(path.substr(kSections.size())));
    if (section != metadata.end()) return json_reply(*section);
  }
  if (path.starts_with(kCommands)) return command(path.substr(kCommands.size()), query, request);
  return refusal(404, "no such resource");
}

/// The TCP and HTTP commands of firmware before 2.4.
ApiReply OusterApi::Impl::command(std::string_view name, std::string_view query,
                                  const ApiRequest& request) {
  for (const auto& [known, section] : kSectionCommands)
    if (name == known) return json_reply(metadata[section]);
  if (name == "get_config_param") return json_reply(config());
  if (name == "set_udp_dest_auto") {
    const ApiReply reply = configure({{"udp_dest", "@auto"}}, request);
    return reply.status == 200 ? json_reply(std::string(name)) : reply;
  }
  if (name == "set_config_param") return set_parameter(query_value(query, "args"), request);
  if (std::find(kEmptyCommands.begin(), kEmptyCommands.end(), name) != kEmptyCommands.end())
    return json_reply(std::string(name));
  return refusal(404, "no such command");
}

/// "KEY VALUE", or ". {...}" with several.
ApiReply OusterApi::Impl::set_parameter(const std::string& arguments, const ApiRequest& request) {
  const std::size_t blank = arguments.find(' ');
  if (blank == std::string::npos) return refusal(400, "args: KEY VALUE");
  const std::string key = arguments.substr(0, blank);
  const std::string text = arguments.substr(blank + 1);
  ApiJson value = text;
  try {
    value = parse_json<ApiJson>("configuration", text, kApiJsonLimits);
  } catch (const ApiJson::exception&) {
    value = text;  // words are given without quotation marks
  }
  const ApiReply reply = configure(key == "." ? value : ApiJson{{key, value}}, request);
  return reply.status == 200 ? json_reply("set_config_param") : reply;
}

void OusterApi::Impl::change(ApiJson& config, const std::string& key, const ApiJson& value,
                             const std::string& client) const {
  const auto current = config.find(key);
  if (current == config.end())
    throw Error({"'" + excerpt(key) + "'", "a parameter that is not simulated", ""});
  if (*current == value) return;
  if (key == "udp_dest") {
    const std::string text = value.is_string() ? value.get<std::string>() : "no text";
    const bool is_automatic = text == "@auto" || text == "auto" || text.empty();
    const std::string address = is_automatic ? client : canonical_ipv4(text);
    if (address.empty() || !options.destinations.allows(address, client))
      throw Error({key, shown_json(value), "the address of the client, @auto, or that of --udp"});
    *current = address;
    return;
  }
  if (key == "udp_port_lidar" || key == "udp_port_imu") {
    *current = port_of(key, value);
    return;
  }
  throw Error({key, shown_json(value), shown_json(*current) + ", which is simulated",
               "restart glidar stream with other options"});
}

ApiReply OusterApi::Impl::configure(const ApiJson& changes, const ApiRequest& request) {
  if (request.no_change) return refusal_reply(*request.no_change);
  if (!changes.is_object()) return refusal(400, "the configuration is no JSON object");
  ApiJson changed = config();
  for (const auto& [key, value] : changes.items())
    change(changed, current_key(key), value, request.client);
  const bool moves = changed != config();
  config() = changed;
  if (moves && options.on_destination) {
    const std::string address = changed.value("udp_dest", "");
    options.on_destination({options.lidar_packet_port, address,
                            changed.value("udp_port_lidar", options.lidar_packet_port)});
    options.on_destination(
        {options.imu_packet_port, address, changed.value("udp_port_imu", options.imu_packet_port)});
  }
  return json_reply(ApiJson::object());
}

}  // namespace glidar::control
