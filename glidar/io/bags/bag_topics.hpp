// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/bags/bag.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::bags {

/// The type of a topic's messages; nullptr if it is none that GLIDAR knows.
const ros::MessageType* type_of(const StoredTopic& topic);

/// The index of the topic of this name, whose type must be one of `types`. With an empty name, the
/// first topic of the first of the types that the bag has. Throws Error listing the topics that
/// fit.
std::size_t find_topic(const BagReader& bag, const std::string& name,
                       std::span<const ros::MessageType* const> types,
                       const std::filesystem::path& path);

}  // namespace glidar::bags
