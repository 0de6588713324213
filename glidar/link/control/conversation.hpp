// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

/// The interfaces by which drivers read a sensor's calibration and choose where it sends packets:
/// HTTP of Ouster, PTC of Hesai, and the commands of Livox SDK 2.
namespace glidar::control {

/// Where a client wants packets to be sent.
struct Destination {
  std::uint16_t packet_port = 0;  ///< of the packets, as their encoder states it
  std::string address;            ///< IPv4
  std::uint16_t port = 0;
};

using DestinationCallback = std::function<void(const Destination&)>;

/// Who may be sent packets, so that nobody can direct them to a third party: the client itself, and
/// the receiver that the user chose.
struct DestinationRule {
  std::string chosen;  ///< IPv4 address; empty: none

  [[nodiscard]] bool allows(std::string_view address, std::string_view client) const {
    return address == client || (!chosen.empty() && address == chosen);
  }
};

/// The text of an IPv4 address in its canonical form; empty if it is none.
std::string canonical_ipv4(const std::string& text);

/// The four bytes of an IPv4 address, as all protocols send them; 0.0.0.0 if the text is none.
std::array<std::byte, 4> ipv4_bytes(const std::string& text);

/// The text of the first four of these bytes, of which there must be as many.
std::string ipv4_text(std::span<const std::byte> bytes);

/// What received bytes lead to.
struct Step {
  std::size_t consumed = 0;  ///< bytes that are not needed any more
  std::string answer = {};   ///< to send; empty: none yet
  bool ends = false;         ///< the connection ends after the answer
  std::string error = {};    ///< what is malformed; empty: nothing
};

/// The protocol of one TCP connection.
class Conversation {
 public:
  Conversation() = default;
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;
  virtual ~Conversation() = default;

  /// Takes bytes that were received and not consumed before. Without an answer and an end, it waits
  /// for more.
  virtual Step receive(std::string_view bytes) = 0;
};

/// A conversation with the client at this IPv4 address.
using ConversationFactory = std::function<std::unique_ptr<Conversation>(const std::string& client)>;

}  // namespace glidar::control
