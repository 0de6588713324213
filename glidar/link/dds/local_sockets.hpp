// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::dds {

/// A network interface with an IPv4 address.
struct LocalAddress {
  std::string interface_name;
  std::uint32_t address = 0;  ///< in the byte order of the machine
  bool is_loopback = false;
  bool has_multicast = false;
};

/// Those that are up.
std::vector<LocalAddress> local_addresses();

/// The UDP sockets of this process at the ports of a domain.
std::vector<int> domain_sockets(std::uint32_t domain);

/// Lets the sockets of a domain receive packets from these addresses and 127.0.0.0/8 only: Cyclone
/// DDS listens at all addresses, whatever its interfaces. False when the system refuses.
bool accept_only(const std::vector<LocalAddress>& addresses, std::uint32_t domain);

}  // namespace glidar::dds
