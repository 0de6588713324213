// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace glidar::dds {

/// The UDP sockets of this process at the ports of a domain.
std::vector<int> domain_sockets(std::uint32_t domain);

/// Lets the sockets of a domain receive from the loopback interface only: Cyclone DDS listens at
/// all addresses, whatever its interface. False when the system refuses.
bool restrict_to_loopback(std::uint32_t domain);

}  // namespace glidar::dds
