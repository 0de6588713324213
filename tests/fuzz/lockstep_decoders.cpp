// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "lockstep_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/link/lockstep.hpp>

namespace glidar::testing {
namespace {

void check(const lockstep::Body& body) {
  demand(is_rigid(body.world_from_body), "poses are rigid");
  demand(body.rate_rad_s.allFinite() && body.velocity_m_s.allFinite(), "speeds are finite");
}

}  // namespace

bool try_lockstep_decoders(std::span<const std::byte> bytes) {
  try {
    std::uint64_t id = 0;
    const lockstep::Request request = lockstep::decode_request(bytes, id);
    demand(lockstep::encode(request).size() == bytes.size(), "every byte is decoded");
    const auto* measure = std::get_if<lockstep::Measure>(&request);
    if (measure == nullptr) return true;
    demand(!measure->columns.empty() && !measure->moments.empty(), "there is something to do");
    for (const lockstep::Moment& moment : measure->moments) {
      check(moment.sensor);
      for (const lockstep::Body& object : moment.objects) check(object);
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glidar::testing
