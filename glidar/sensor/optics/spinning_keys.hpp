// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/sensor and glidar/io: parts of describe(Spinning&).

#include <glidar/sensor/optics/spinning.hpp>

#include <optional>

namespace glidar {

inline constexpr std::size_t kMaxChannels = 4096;

/// The lists of one number per channel, from which a reader makes the channels.
void visit_channels(FieldVisitor& visitor, std::vector<SpinningChannel>& channels);

/// How the rings of channels count.
enum class ChannelOrder : std::uint8_t { as_listed, rising_elevation };

/// Empty: in an order of their own.
std::optional<ChannelOrder> channel_order_of(const std::vector<SpinningChannel>& channels);
void number_rings(ChannelOrder order, std::vector<SpinningChannel>& channels);

/// The sector in degrees, or in radians where no two numbers in degrees give the same bits.
void visit_azimuth_range(FieldVisitor& visitor, Spinning& spinning);

}  // namespace glidar
