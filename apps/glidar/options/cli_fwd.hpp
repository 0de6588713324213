// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Of CLI11, for headers that only name it.
namespace CLI {  // NOLINT(readability-identifier-naming): not our name
class App;
}  // namespace CLI
