// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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

/// Lets Cyclone DDS choose the network interfaces, by the variable CYCLONEDDS_URI if it is set.
inline constexpr const char* kAnyInterface = "auto";

/// Only programs of this machine.
inline constexpr const char* kLoopbackInterface = "lo";

/// Where a participant looks for others.
struct DomainOptions {
  std::optional<std::uint32_t> id = {};  ///< 0 to 232; empty: ROS_DOMAIN_ID, or 0
  /// Network interface. "lo", the default: programs of this machine only, whichever interface they
  /// use. Packets then leave it neither by multicast nor to addresses of others, and those of other
  /// machines are discarded.
  std::string interface_name = kLoopbackInterface;
};

/// The domain of the options, or of ROS_DOMAIN_ID. Throws Error unless it is from 0 to 232.
std::uint32_t domain_id(const DomainOptions& options);

/// The configuration of Cyclone DDS for these options. Throws Error when there is no such network
/// interface.
std::string domain_config(const DomainOptions& options);

/// Bytes requested for the socket buffers: a cloud of 128 channels fits.
inline constexpr std::size_t kSocketBuffer_bytes = 10'000'000;

/// A warning with the commands that raise the system's limit of socket buffers, in bytes, if it is
/// less than requested; else empty.
std::string socket_buffer_advice(std::size_t limit_bytes);

/// That limit: net.core.rmem_max. Empty if it is unknown.
std::optional<std::size_t> socket_buffer_limit();

}  // namespace glidar::dds
