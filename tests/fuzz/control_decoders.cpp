// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "control_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/link/control/control_server.hpp>
#include <glidar/link/control/livox_commands.hpp>
#include <glidar/link/control/tcp_service.hpp>

#include <array>
#include <string_view>

namespace glidar::testing {
namespace {

constexpr const char* kClient = "127.0.0.1";
constexpr const char* kChosen = "10.0.0.9";

void check_destination(const control::Destination& to) {
  demand(to.address == kClient || to.address == kChosen, "packets go to nobody else");
  demand(to.port != 0 && to.packet_port != 0, "ports are valid");
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Gives the bytes in two parts, as a network does; the last answer.
std::string converse(control::Conversation& conversation, std::string_view bytes) {
  std::string answer;
  std::string pending(bytes.substr(0, bytes.size() / 2));
  for (const std::string_view rest : {bytes.substr(bytes.size() / 2), std::string_view()}) {
    while (!pending.empty()) {
      const control::Step step = conversation.receive(pending);
      demand(step.consumed <= pending.size(), "only received bytes are consumed");
      pending.erase(0, step.consumed);
      if (!step.answer.empty()) answer = step.answer;
      if (step.ends) return answer;
      if (step.consumed == 0) break;
    }
    pending += rest;
  }
  return answer;
}

bool try_http(std::span<const std::byte> bytes) {
  static const std::string kMetadata =
      R"({"sensor_info":{"image_rev":"v3"},"beam_intrinsics":{"a":[1,2]},"imu_intrinsics":{},)"
      R"("lidar_intrinsics":{},"lidar_data_format":{},"config_params":{"udp_dest":"10.0.0.9",)"
      R"("udp_port_lidar":7502,"udp_port_imu":7503,"lidar_mode":"1024x10"},"user_data":""})";
  control::OusterApi api(
      {.metadata = kMetadata, .destinations = {kChosen}, .on_destination = check_destination});
  link::HttpGuard guard({}, link::HttpClients::programs, control::sensor_http_limits());
  const auto conversation = control::make_http_conversation(api, guard, kClient);
  const std::string answer = converse(*conversation, text_of(bytes));
  demand(answer.empty() || answer.starts_with("HTTP/1.1 "), "answers are HTTP");
  return answer.starts_with("HTTP/1.1 200");
}

bool try_ptc(std::span<const std::byte> bytes) {
  control::PtcSensor sensor;
  sensor.calibration = "Channel,Elevation,Azimuth\n1,0,0\n";
  sensor.destinations = {kChosen};
  sensor.on_destination = check_destination;
  control::PtcCommands commands(sensor);
  const auto conversation = control::make_ptc_conversation(commands, kClient);
  const std::string answer = converse(*conversation, text_of(bytes));
  demand(answer.empty() || answer.starts_with("\x47\x74"), "answers are PTC");
  return answer.size() >= 8 && answer[3] == 0;
}

bool try_livox_commands(std::span<const std::byte> bytes) {
  control::LivoxSensor sensor;
  sensor.destination = kChosen;
  sensor.destinations = {kChosen};
  sensor.on_destination = check_destination;
  control::LivoxCommands commands(sensor);
  const control::LivoxCommand command = control::decode_livox_command(bytes);
  demand(control::encode(command).size() == bytes.size(), "every byte is decoded");
  const auto found = commands.answer_search(bytes);
  const auto answer = commands.answer(bytes, kClient);
  for (const auto& one : {found, answer}) {
    if (!one) continue;
    demand(control::decode_livox_command(*one).is_answer, "answers are valid");
    demand(one->size() <= control::kMaxLivoxCommand, "answers fit a packet");
  }
  return answer.has_value();
}

/// The checksums are right, so that a fuzzer reaches what they guard.
bool try_livox_parameters(std::span<const std::byte> bytes) {
  if (bytes.size() < 2 || bytes.size() > 1300) return false;
  const auto id = get<std::uint16_t>(bytes, 0);
  const std::span<const std::byte> data = bytes.subspan(2);
  return try_livox_commands(
      control::encode(control::LivoxCommand{1, id, false, false, {data.begin(), data.end()}}));
}

bool try_livox_packet(std::span<const std::byte> bytes) {
  constexpr std::size_t kChecksum = 24;
  std::vector<std::byte> payload(bytes.begin(), bytes.end());
  if (payload.size() >= kChecksum + 4) {
    const std::uint32_t sum = livox_crc32(std::span(payload).subspan(kChecksum + 4));
    for (std::size_t i = 0; i < 4; ++i)
      payload[kChecksum + i] = static_cast<std::byte>(sum >> (8 * i));
  }
  Sensor sensor;
  sensor.name = "Livox";
  sensor.optics = Prism{.prisms = {}, .incidence_rad = {-0.05, 0.05}};
  sensor.receiver.returns = {Return{}};
  sensor.rate_hz = 10.0;
  const auto decoder = make_livox_decoder(sensor);
  std::vector<DecodedFrame> frames;
  decoder->decode({0, kLivoxPointSourcePort, kLivoxPointPort, payload}, frames);
  decoder->decode({0, kLivoxPointSourcePort, kLivoxPointPort, payload}, frames);
  decoder->finish(frames);
  for (const DecodedFrame& made : frames) {
    demand(made.frame.range_m.size() == made.beams.size(), "frames fit their beams");
    validate(made.beams);
  }
  return encode(decode_livox_packet(payload)).size() == payload.size();
}

}  // namespace

bool try_control_decoders(std::span<const std::byte> bytes) {
  using Try = bool (*)(std::span<const std::byte>);
  constexpr std::array<Try, 5> kTries = {try_http, try_ptc, try_livox_commands,
                                         try_livox_parameters, try_livox_packet};
  if (bytes.empty()) return false;
  try {
    return kTries[std::to_integer<std::size_t>(bytes[0]) % kTries.size()](bytes.subspan(1));
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glidar::testing
