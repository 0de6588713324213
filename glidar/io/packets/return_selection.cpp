// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/return_selection.hpp>

#include <glidar/core/error.hpp>

#include <utility>
#include <vector>

namespace glidar {
namespace {

[[noreturn]] void fail_of_returns(const std::string& packets) {
  throw Error({packets, "receiver.returns that these packets cannot have",
               "[strongest], [farthest], or both",
               "set receiver.returns in a copy of the sensor file"});
}

}  // namespace

ReturnSelection select_packet_returns(const Sensor& sensor, const std::string& packets) {
  const std::vector<Return>& returns = sensor.receiver.returns;
  if (returns.empty() || returns.size() > 2) fail_of_returns(packets);
  ReturnSelection selection;
  bool has_strongest = false;
  bool has_last = false;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const Return::Order order = returns[i].order;
    if (returns[i].rank != 0 || order == Return::Order::nearest) fail_of_returns(packets);
    bool& is_known = order == Return::Order::strongest ? has_strongest : has_last;
    if (is_known) fail_of_returns(packets);
    is_known = true;
    (order == Return::Order::strongest ? selection.strongest : selection.last) = i;
  }
  if (has_last) selection.mode = has_strongest ? PacketReturnMode::dual : PacketReturnMode::last;
  return selection;
}

LastAndStrongest last_and_strongest(const FiringSequence& sequence, std::size_t lasers,
                                    std::size_t laser) {
  LastAndStrongest found{sequence.returns[laser], sequence.returns[lasers + laser]};
  if (!(found.last.range_m > 0.0)) found.last = found.strongest;
  if (!(found.strongest.range_m > 0.0)) found.strongest = found.last;
  if (found.last.range_m < found.strongest.range_m) std::swap(found.last, found.strongest);
  return found;
}

void store_returns(const LastAndStrongest& found, const ReturnSelection& selection,
                   std::size_t lasers, std::size_t laser, FiringSequence& sequence) {
  if (found.last.range_m == found.strongest.range_m) {
    sequence.returns[laser] = found.strongest;
    return;
  }
  sequence.returns[selection.strongest * lasers + laser] = found.strongest;
  sequence.returns[selection.last * lasers + laser] = found.last;
}

}  // namespace glidar
