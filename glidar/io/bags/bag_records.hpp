// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io and glidar-import: both ends of the stream of a bag.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/decoder/decoder_process.hpp>

namespace glidar::bags {

/// Opens a bag in this process: only in the sandboxed one, and for tests. Throws Error like
/// open_bag().
std::unique_ptr<BagReader> open_bag_unconfined(const std::filesystem::path& path);

/// Sends the topics, receives from descriptor `control` which of them are wanted, a byte for each,
/// and sends their messages. Throws Error when the bag is damaged.
void send_bag(BagReader& bag, RecordWriter& to, int control);

/// The bag that the other end sends. Counts what it receives in the budget of the input, because a
/// malicious bag may have compromised that process.
std::unique_ptr<BagReader> receive_bag(DecoderRun run);

}  // namespace glidar::bags
