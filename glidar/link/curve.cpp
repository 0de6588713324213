// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/curve.hpp>

#include <zmq.hpp>

#include <array>

namespace glidar::link {

CurveKeys make_curve_keys() {
  constexpr std::size_t kLetters = 40;
  std::array<char, kLetters + 1> public_key{};
  std::array<char, kLetters + 1> secret_key{};
  if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) throw zmq::error_t();
  return {public_key.data(), secret_key.data()};
}

}  // namespace glidar::link
