// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "message_peers.hpp"

#include "../network/participants.hpp"
#include "program.hpp"

#include <fmt/format.h>

#include <charconv>
#include <iostream>
#include <stdexcept>

namespace glidar::testing {
namespace {

const ros::MessageType& known_type(const std::string& name) {
  const ros::MessageType* type = ros::find_message_type(name);
  if (type == nullptr) throw std::runtime_error("unknown type " + name);
  return *type;
}

link::Payload from_hexadecimal(const std::string& text) {
  constexpr int kBase = 16;
  const std::size_t size = text.size() / 2;
  link::Payload payload{.memory = std::make_shared<std::byte[]>(size), .size = size};  // NOLINT
  for (std::size_t i = 0; i < size; ++i) {
    unsigned value = 0;
    std::from_chars(text.data() + 2 * i, text.data() + 2 * i + 2, value, kBase);
    payload.memory[static_cast<std::ptrdiff_t>(i)] = static_cast<std::byte>(value);
  }
  return payload;
}

}  // namespace

int read_messages(const std::string& topic, const std::string& type_name, std::size_t count) {
  const Program program;
  const dds::WakeUp wake_up;
  const ros::MessageType& type = known_type(type_name);
  ros::Qos qos = type.qos;
  qos.transient_local = topic == "/tf_static";
  constexpr std::size_t kMax_bytes = std::size_t{1} << 26;
  dds::TopicReader reader(program.participant, {topic, type, qos, kMax_bytes}, wake_up);
  print_line("ready");
  for (std::size_t i = 0; i < count; ++i) {
    const auto message = wait_for(wake_up.descriptor(), [&] {
      wake_up.clear();
      return reader.take();
    });
    if (!message) return 1;
    std::string text;
    for (const std::byte byte : message->bytes())
      text += fmt::format("{:02x}", std::to_integer<int>(byte));
    print_line(text);
  }
  return 0;
}

int write_messages(const std::string& topic, const std::string& type_name) {
  const Program program;
  const ros::MessageType& type = known_type(type_name);
  dds::TopicWriter writer(program.participant, topic, type, type.qos);
  if (!is_matched(writer)) return 1;
  print_line("matched");
  for (std::string line; std::getline(std::cin, line);) {
    if (!writer.write(from_hexadecimal(line))) return 1;
    (void)writer.wait_for_acknowledgements(kMaxWait);
    print_line("written");
  }
  return 0;
}

}  // namespace glidar::testing
