// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/byte_reader.hpp>

#include <glidar/core/error.hpp>

namespace glidar::bags {

void reject_bag(const std::string& place, const std::string& found, const std::string& allowed) {
  throw Error({place, found, allowed, "the bag is damaged or incomplete; record or copy it again"});
}

}  // namespace glidar::bags
