// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/verify.hpp>

#include <string>
#include <string_view>

namespace glidar {

/// Why a renderer is known to fail a row's case; empty: it has to pass.
std::string known_failure(std::string_view renderer, const VerifyRow& row);

}  // namespace glidar
