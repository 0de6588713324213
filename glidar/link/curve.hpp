// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::link {

/// Keys of CURVE (https://rfc.zeromq.org/spec/26), 40 characters of Z85 each.
struct CurveKeys {
  std::string public_key;
  std::string secret_key;
};
CurveKeys make_curve_keys();

}  // namespace glidar::link
